#include "flow/pressure.hpp"

#include "base/clones.hpp"
#include "flow/parallel.hpp"
#include "flow/rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firetwin::flow {
namespace {

constexpr Index chunk = 512; // modes solved together, so that their columns stay in the cache

/// Returns the eigenvalue of the second difference for cosine mode m of n, 1/m2.
double eigenvalue(Index m, Index n, double spacing) {
  const double s =
      std::sin(0.5 * std::numbers::pi * static_cast<double>(m) / static_cast<double>(n));
  return 4.0 * s * s / (spacing * spacing);
}

FIRETWIN_CLONES("avx512f", "avx2")
void eliminate(Index n, const float* __restrict lower, float below, const float* __restrict pivot,
               float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] = (q[i] - below * lower[i]) * pivot[i];
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void substitute(Index n, const float* __restrict upper, float above, const float* __restrict pivot,
                float* __restrict q) {
  for (Index i = 0; i < n; ++i) {
    q[i] -= above * pivot[i] * upper[i];
  }
}

/// Transposes a matrix of `rows` rows of n numbers, block by block; place(i) is the offset of row i
/// of the result.
template <class Place>
void turn(Index rows, Index n, const float* from, Index stride, float* to, const Place& place) {
  constexpr Index block = 16;
  for (Index low = 0; low < rows; low += block) {
    const Index high = std::min(low + block, rows);
    for (Index i = 0; i < n; ++i) {
      float* out = to + place(i);
      for (Index j = low; j < high; ++j) {
        out[j] = from[j * stride + i];
      }
    }
  }
}

} // namespace

Pressure::Pressure(const Lattice& lattice, const Air& air)
    : lattice_(lattice), air_(air), size_((lattice.nx * lattice.ny + 15) / 16 * 16),
      modes_(static_cast<std::size_t>(size_ * lattice.nz)), pivot_(modes_.size()),
      below_(lattice.depth.size()), above_(lattice.depth.size()), along_x_(lattice.nx, lattice.ny),
      along_y_(lattice.ny, lattice.nx), x_room_([this] { return along_x_.make_matrix(); }),
      y_room_([this] { return along_y_.make_matrix(); }) {
  const Index nx = lattice.nx, ny = lattice.ny, nz = lattice.nz;
  for (Index k = 0; k < nz; ++k) {
    const auto at = static_cast<std::size_t>(k);
    below_[at] = k > 0 ? air.face[at] / static_cast<float>(lattice.gap(k)) : 0.0F;
    above_[at] = k + 1 < nz ? air.face[at + 1] / static_cast<float>(lattice.gap(k + 1)) : 0.0F;
  }
  each(nx, [&](Index i) {
    for (Index j = 0; j < ny; ++j) {
      const double wave = eigenvalue(i, nx, lattice.spacing) + eigenvalue(j, ny, lattice.spacing);
      double before = 0.0;
      for (Index k = 0; k < nz; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const double low = static_cast<double>(below_[at]), up = static_cast<double>(above_[at]);
        const double across = static_cast<double>(air.cell[at]) * wave;
        const bool free = i == 0 && j == 0 &&
                          k == nz - 1; // the constant mode is undetermined: set to 0 at the top
        const double under = k > 0 ? static_cast<double>(above_[at - 1]) : 0.0;
        before = free ? 0.0 : 1.0 / (-(low + up + across) - low * under * before);
        pivot_[static_cast<std::size_t>(k * size_ + i * ny + j)] = static_cast<float>(before);
      }
    }
  });
}

/// Computes the net outflow of mass from the cells of level k, kg/m2/s; place(j) is its row j.
template <class Place> void Pressure::diverge(const Wind& wind, Index k, const Place& place) const {
  const auto at = static_cast<std::size_t>(k);
  const float across = air_.cell[at] / static_cast<float>(lattice_.spacing);
  for (Index j = 0; j < lattice_.ny; ++j) {
    const float* u = wind.u.row(k, j);
    const Faces faces{
        u, u + 1, wind.v.row(k, j), wind.v.row(k, j + 1), wind.w.row(k, j), wind.w.row(k + 1, j)};
    divergence_row(lattice_.nx, faces, across, air_.face[at + 1], air_.face[at], place(j));
  }
}

double Pressure::divergence(const Wind& wind) const {
  return max_each(lattice_.nz, [&](Index k) {
    std::vector<float> out(static_cast<std::size_t>(size_));
    diverge(wind, k, [&](Index j) { return out.data() + j * lattice_.nx; });
    return static_cast<double>(max_abs_row(lattice_.nx * lattice_.ny, out.data())) /
           static_cast<double>(air_.cell[static_cast<std::size_t>(k)]);
  });
}

/// Transforms the divergence of level k to modes [nx][ny].
void Pressure::transform(const Wind& wind, Index k) {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  auto &y = y_room_.local(), &x = x_room_.local();
  const auto row = [&](Index j) { return y.data() + along_y_.row_offset(j); };
  diverge(wind, k, row);
  for (Index j = 0; j < ny; ++j) {
    along_y_.clear_rest(row(j));
  }
  along_y_.forward(y);
  turn(ny, nx, y.data(), along_y_.stride(), x.data(),
       [&](Index i) { return along_x_.row_offset(i); });
  for (Index i = 0; i < nx; ++i) {
    along_x_.clear_rest(x.data() + i * along_x_.stride());
  }
  along_x_.forward(x);
  for (Index i = 0; i < nx; ++i) {
    std::copy_n(x.data() + i * along_x_.stride(), ny, level(k) + i * ny);
  }
}

void Pressure::transform_back(Index k) {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  auto &y = y_room_.local(), &x = x_room_.local();
  for (Index i = 0; i < nx; ++i) {
    along_x_.copy_row(level(k) + i * ny, x.data() + i * along_x_.stride());
  }
  along_x_.backward(x);
  for (Index i = 0; i < nx; ++i) {
    std::copy_n(x.data() + along_x_.row_offset(i), ny, level(k) + i * ny);
  }
  turn(nx, ny, level(k), ny, y.data(), [&](Index j) { return j * along_y_.stride(); });
  for (Index j = 0; j < ny; ++j) {
    along_y_.clear_rest(y.data() + j * along_y_.stride());
  }
  along_y_.backward(y);
  for (Index j = 0; j < ny; ++j) {
    std::copy_n(y.data() + along_y_.row_offset(j), nx, level(k) + j * nx);
  }
}

void Pressure::solve_modes(Index begin, Index end) {
  const Index n = end - begin, nz = lattice_.nz;
  for (Index k = 0; k < nz; ++k) {
    float* q = level(k) + begin;
    const float* lower = k > 0 ? q - size_ : q;
    const float* pivot = pivot_.data() + k * size_ + begin;
    if (k == 0) {
      for (Index i = 0; i < n; ++i) {
        q[i] *= pivot[i];
      }
    } else {
      eliminate(n, lower, below_[static_cast<std::size_t>(k)], pivot, q);
    }
  }
  for (Index k = nz - 2; k >= 0; --k) {
    float* q = level(k) + begin;
    substitute(n, q + size_, above_[static_cast<std::size_t>(k)], pivot_.data() + k * size_ + begin,
               q);
  }
}

void Pressure::solve() {
  const Index modes = lattice_.nx * lattice_.ny;
  each((modes + chunk - 1) / chunk,
       [&](Index c) { solve_modes(c * chunk, std::min(modes, (c + 1) * chunk)); });
}

void Pressure::descend(Wind& wind) const {
  const Index nx = lattice_.nx, ny = lattice_.ny;
  const double whole =
      4.0 * static_cast<double>(nx) * static_cast<double>(ny); // scale of the transforms
  const auto across = static_cast<float>(1.0 / (lattice_.spacing * whole));
  each(lattice_.nz, [&](Index k) {
    const float* p = level(k);
    const float up = k > 0 ? static_cast<float>(1.0 / (lattice_.gap(k) * whole)) : 0.0F;
    for (Index j = 0; j < ny; ++j, p += nx) {
      subtract_gradient_row(nx - 1, p + 1, p, across, wind.u.row(k, j) + 1);
      if (j > 0) {
        subtract_gradient_row(nx, p, p - nx, across, wind.v.row(k, j));
      }
      if (k > 0) {
        subtract_gradient_row(nx, p, p - size_, up, wind.w.row(k, j));
      }
    }
  });
}

void Pressure::project(Wind& wind) {
  each(lattice_.nz, [&](Index k) { transform(wind, k); });
  solve();
  each(lattice_.nz, [&](Index k) { transform_back(k); });
  descend(wind);
}

} // namespace firetwin::flow
