#include "flow/sweep.hpp"

#include "flow/rows.hpp"

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <algorithm>
#include <array>
#include <vector>

namespace firetwin::flow {
namespace {

/// Scratch rows of a sweep, padded to full lanes; their number does not depend on the number of
/// levels.
class RowScratch {
public:
  explicit RowScratch(Index length)
      : length_(length + lanes),
        memory_(static_cast<std::size_t>(length_ * (9 + 8 * static_cast<Index>(max_fields)))) {}
  float* flux(Index f) { return slot(f & 3); }
  float* inverse(Index p) { return slot(4 + (p & 3)); }
  float* zeros() { return slot(8); }
  float* value(std::size_t field, Index f) {
    return slot(9 + 8 * static_cast<Index>(field) + (f & 3));
  }
  float* mixed(std::size_t field, Index f) {
    return slot(13 + 8 * static_cast<Index>(field) + (f & 3));
  }

private:
  float* slot(Index i) { return memory_.data() + i * length_; }

  Index length_;
  std::vector<float, tbb::cache_aligned_allocator<float>> memory_;
};

void add(BoundaryFlux& crossed, double inwards) {
  (inwards > 0.0 ? crossed.in : crossed.out) += inwards > 0.0 ? inwards : -inwards;
}

/// Returns whether row j of level k has numbers other than 0, ghost cells excepted.
bool has_content(const Sweep& s, Field& field, Index k, Index j) {
  if (j < 0 || j >= s.lattice.ny) {
    return has_nonzero_row(s.lattice.nx, field.row(k, j));
  }
  if (!field.empty(k, j)) {
    field.empty(k, j) = !has_nonzero_row(s.lattice.nx, field.row(k, j));
  }
  return !field.empty(k, j);
}

/// Returns the rows whose mean is a row of a cell or face field at the sweep's position on the
/// staggered grid.
Pair pair_at_place(const Sweep& s, const Field& field, Index k, Index j, Index first) {
  const float* here = field.row(k, j) + first;
  return {s.place == Place::x   ? here - 1
          : s.place == Place::y ? field.row(k, j - 1) + first
          : s.place == Place::z ? field.row(k - 1, j) + first
                                : here,
          here};
}

/// Returns the flux of a pair: its one row, or `mean`.
const float* flux_of(const Pair& pair, const float* mean) {
  return pair.a == pair.b ? pair.a : mean;
}

void along_x(const Sweep& s, Index k, Index j, RowScratch& scratch,
             std::span<BoundaryFlux> crossed) {
  const Index first = s.place == Place::x ? 1 : 0, n = s.lattice.nx - first;
  const auto [flux_a, flux_b] = pair_at_place(s, s.flux, k, j, first);
  const auto [mass_a, mass_b] = pair_at_place(s, s.mass, k, j, first);
  const Pair exchange = pair_at_place(s, s.exchange, k, j, first);
  const AirRows air{
      {flux_a - 1, flux_b - 1}, {flux_a, flux_b}, {mass_a - 1, mass_b - 1}, {mass_a, mass_b}};
  const float* flux = flux_of(air.flux, scratch.flux(0));
  for (std::size_t m = 0; m < s.fields.size(); ++m) {
    float* q = s.fields[m]->row(k, j) + first;
    if (m < s.sparse && q[-2] == 0.0F && q[-1] == 0.0F && q[n] == 0.0F && q[n + 1] == 0.0F &&
        !has_content(s, *s.fields[m], k, j)) {
      continue;
    }
    const FaceRows faces{scratch.flux(0), scratch.inverse(0), scratch.value(m, 0),
                         scratch.mixed(m, 0)};
    face_row(n + 1, air, exchange, s.mixing, {q - 2, q - 1, q, q + 1}, faces);
    update_row(n,
               {flux, flux + 1, faces.value, faces.value + 1, faces.mixed, faces.mixed + 1,
                faces.inverse + 1, m < s.rescaled ? mass_b : nullptr, s.rest[k]},
               q);
    s.fields[m]->empty(k, j) = 0;
    if (!crossed.empty()) {
      add(crossed[m], static_cast<double>(flux[0]) * static_cast<double>(faces.value[0]));
      add(crossed[m], -static_cast<double>(flux[n]) * static_cast<double>(faces.value[n]));
    }
  }
}

/// Sweeps rows along y or z. A row is updated in place as soon as no face needs its old values:
/// face f reads rows f - 2 to f + 1.
class RollingSweep {
public:
  RollingSweep(const Sweep& sweep, Index across, RowScratch& scratch)
      : s_(sweep), across_(across), scratch_(scratch), n_(sweep.lattice.nx),
        end_(sweep.axis == Axis::y ? sweep.lattice.ny : sweep.lattice.nz),
        begin_((sweep.axis == Axis::y && sweep.place == Place::y) ||
                       (sweep.axis == Axis::z && sweep.place == Place::z)
                   ? 1
                   : 0) {}

  void run(std::span<BoundaryFlux> crossed) {
    for (Index p = begin_ - 2; p <= begin_; ++p) {
      check_nonzero(p);
    }
    for (Index f = begin_; f <= end_; ++f) {
      open_face(f);
      if (!crossed.empty() && (f == begin_ || f == end_)) {
        count(f, crossed);
      }
      if (f - 2 >= begin_) {
        close_row(f - 2);
      }
    }
    close_row(end_ - 1);
  }

private:
  /// Level and row of the p-th row along the axis. Levels end at the ground and at the top.
  Index level(Index p, Index levels) const {
    return s_.axis == Axis::y ? across_ : std::clamp(p, Index{0}, levels - 1);
  }
  Index line(Index p) const { return s_.axis == Axis::y ? p : across_; }

  static std::size_t at(Index p) { return static_cast<std::size_t>(p & 3); }

  Pair pair(const Field& field, Index f) const {
    return pair_at_place(s_, field, level(f, s_.flux.levels()), line(f), 0);
  }

  Pair mass(Index p) const {
    const Index lowest = s_.place == Place::z ? 1 : 0;
    return pair_at_place(s_, s_.mass, std::max(level(p, s_.lattice.nz), lowest), line(p), 0);
  }

  /// Records whether a row has nonzero values before its update.
  void check_nonzero(Index p) {
    for (std::size_t m = 0; m < s_.sparse; ++m) {
      Field& field = *s_.fields[m];
      nonzero_[m][at(p)] = has_content(s_, field, level(p, field.levels()), line(p));
    }
  }

  bool nothing_beside(std::size_t m) const {
    const auto& rows = nonzero_[m];
    return m < s_.sparse && !(rows[0] || rows[1] || rows[2] || rows[3]);
  }

  void open_face(Index f) {
    check_nonzero(f + 1);
    const AirRows air{pair(s_.flux, std::max(f - 1, begin_)), pair(s_.flux, f), mass(f - 1),
                      mass(f)};
    const Pair exchange = pair(s_.exchange, f);
    flux_[at(f)] = flux_of(air.flux, scratch_.flux(f));
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      carries_[m][at(f)] = !nothing_beside(m);
      if (carries_[m][at(f)]) {
        face_row(n_, air, exchange, s_.mixing,
                 {row(m, f - 2), row(m, f - 1), row(m, f), row(m, f + 1)},
                 {scratch_.flux(f), scratch_.inverse(f - 1), scratch_.value(m, f),
                  scratch_.mixed(m, f)});
      }
    }
  }

  void close_row(Index p) {
    const Index k = level(p, s_.lattice.nz);
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      if (!carries_[m][at(p)] && !carries_[m][at(p + 1)]) {
        continue;
      }
      const auto faces = [&](Index f, float* row) {
        return carries_[m][at(f)] ? row : scratch_.zeros();
      };
      float* q = row(m, p);
      const float first = q[0];
      update_row(n_,
                 {flux_[at(p)], flux_[at(p + 1)], faces(p, scratch_.value(m, p)),
                  faces(p + 1, scratch_.value(m, p + 1)), faces(p, scratch_.mixed(m, p)),
                  faces(p + 1, scratch_.mixed(m, p + 1)), scratch_.inverse(p),
                  m < s_.rescaled ? mass(p).b : nullptr, s_.rest[k]},
                 q);
      if (s_.place == Place::x) {
        q[0] = first; // a face of the domain
      }
      s_.fields[m]->empty(level(p, s_.fields[m]->levels()), line(p)) = 0;
    }
  }

  void count(Index f, std::span<BoundaryFlux> crossed) {
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      if (!carries_[m][at(f)]) {
        continue;
      }
      const float *flux = flux_[at(f)], *value = scratch_.value(m, f);
      for (Index i = 0; i < n_; ++i) {
        const double out = static_cast<double>(flux[i]) * static_cast<double>(value[i]);
        add(crossed[m], f == begin_ ? out : -out);
      }
    }
  }

  float* row(std::size_t m, Index p) {
    Field& field = *s_.fields[m];
    return field.row(level(p, field.levels()), line(p));
  }

  const Sweep& s_;
  Index across_;
  RowScratch& scratch_;
  Index n_;                                               ///< columns
  Index end_;                                             ///< end of the updated rows
  Index begin_;                                           ///< first updated row
  std::array<const float*, 4> flux_{};                    ///< of the last four faces
  std::array<std::array<bool, 4>, max_fields> nonzero_{}; ///< in the last four rows
  std::array<std::array<bool, 4>, max_fields> carries_{}; ///< last four faces: nonzero flux
};

} // namespace

void sweep_level(std::span<const Sweep> sweeps, Index k, std::span<BoundaryFlux> crossed) {
  RowScratch scratch(sweeps[0].lattice.stride);
  const auto counted = [&](const Sweep& sweep) {
    return sweep.place == Place::middle ? crossed : std::span<BoundaryFlux>();
  };
  if (k == 0) {
    sweeps = sweeps.first(sweeps.size() - 1); // w is 0 there
  }
  if (sweeps[0].axis == Axis::y) {
    for (const Sweep& sweep : sweeps) {
      RollingSweep(sweep, k, scratch).run(counted(sweep));
    }
    return;
  }
  for (Index j = 0; j < sweeps[0].lattice.ny; ++j) {
    for (const Sweep& sweep : sweeps) {
      if (j > 0 || sweep.place != Place::y) {
        along_x(sweep, k, j, scratch, counted(sweep));
      }
    }
  }
}

void sweep_columns(std::span<const Sweep> sweeps, Index j) {
  RowScratch scratch(sweeps[0].lattice.stride);
  for (const Sweep& sweep : sweeps) {
    if (j > 0 || sweep.place != Place::y) {
      RollingSweep(sweep, j, scratch).run({});
    }
  }
}

} // namespace firetwin::flow
