#include "flow/sweep.hpp"

#include "flow/rows.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace firetwin::flow {
namespace {

/// Scratch rows of a sweep, padded to full lanes; their number does not depend on the number of
/// levels.
class RowScratch {
public:
  explicit RowScratch(Index length)
      : length_(whole_lanes(length + 2)),
        memory_(std::make_unique_for_overwrite<float[]>(
            static_cast<std::size_t>(length_ * (11 + 8 * static_cast<Index>(max_fields)) + 2))) {}
  float* flux(Index f) { return slot(f & 3); }
  float* mass(Index p) { return slot(4 + (p & 3)); }
  float* value(std::size_t field, Index f) {
    return slot(11 + 8 * static_cast<Index>(field) + (f & 3));
  }
  float* mixed(std::size_t field, Index f) {
    return slot(15 + 8 * static_cast<Index>(field) + (f & 3));
  }
  float* exchange() { return slot(10); }
  float* courant() { return slot(8); }
  float* inverse() { return slot(9); }

private:
  /// Each row has room for one number before it: the mass of the cell before the first.
  float* slot(Index i) { return memory_.get() + i * length_ + 1; }

  Index length_;
  std::unique_ptr<float[]> memory_;
};

void add(BoundaryFlux& crossed, double inwards) {
  (inwards > 0.0 ? crossed.in : crossed.out) += inwards > 0.0 ? inwards : -inwards;
}

/// Returns a row of a cell or face field at the sweep's position on the staggered grid: the row
/// itself, or the mean of neighbours in `room`, in full lanes.
const float* row_at_place(const Sweep& s, const Field& field, Index k, Index j, Index first,
                          Index n, float* room) {
  const float* here = field.row(k, j) + first;
  if (s.place == Place::middle) {
    return here;
  }
  const float* before = s.place == Place::x   ? here - 1
                        : s.place == Place::y ? field.row(k, j - 1) + first
                                              : field.row(k - 1, j) + first;
  mean_row(whole_lanes(n), before, here, room);
  return room;
}

void along_x(const Sweep& s, Index k, Index j, RowScratch& scratch,
             std::span<BoundaryFlux> crossed) {
  const Index first = s.place == Place::x ? 1 : 0;
  const Index n = s.lattice.nx - first, faces = whole_lanes(n + 1);
  const float* flux = row_at_place(s, s.flux, k, j, first, n + 1, scratch.flux(0));
  const float* mass = row_at_place(s, s.mass, k, j, first - 1, n + 2, scratch.mass(0) - 1) + 1;
  courant_row(faces, flux, mass - 1, mass, scratch.courant());
  inverse_row(faces, mass, flux, flux + 1, scratch.inverse());
  const float* exchange =
      s.exchange ? row_at_place(s, *s.exchange, k, j, first, n + 1, scratch.exchange()) : nullptr;
  for (std::size_t m = 0; m < s.fields.size(); ++m) {
    float* q = s.fields[m]->row(k, j) + first;
    float* value = scratch.value(m, 0);
    float* mixed = scratch.mixed(m, 0);
    if (m < s.sparse && !has_nonzero_row(n + 2 * halo, q - halo)) {
      continue;
    }
    face_row(faces, flux, scratch.courant(), {q - 2, q - 1, q, q + 1}, value);
    if (exchange) {
      mixing_flux_row(faces, exchange, s.mixing, q - 1, q, mixed);
    }
    advect_row(n, flux, flux + 1, value, value + 1, scratch.inverse(), q);
    if (exchange) {
      mix_row(n, mixed, mixed + 1, scratch.inverse(), q);
    }
    if (m < s.rescaled && !s.rest.empty()) {
      rescale_row(n, mass, flux, flux + 1, s.rest[static_cast<std::size_t>(k)], q);
    }
    if (!crossed.empty()) {
      add(crossed[m], static_cast<double>(flux[0]) * static_cast<double>(value[0]));
      add(crossed[m], -static_cast<double>(flux[n]) * static_cast<double>(value[n]));
    }
  }
}

/// Sweeps rows along y or z. A row is updated in place as soon as no face needs its old values:
/// face f reads rows f - 2 to f + 1.
class RollingSweep {
public:
  RollingSweep(const Sweep& sweep, Index across, RowScratch& scratch)
      : s_(sweep), across_(across), scratch_(scratch), first_(sweep.place == Place::x ? 1 : 0),
        n_(sweep.lattice.nx - first_), lanes_(whole_lanes(n_)),
        end_(sweep.axis == Axis::y ? sweep.lattice.ny : sweep.lattice.nz),
        begin_((sweep.axis == Axis::y && sweep.place == Place::y) ||
                       (sweep.axis == Axis::z && sweep.place == Place::z)
                   ? 1
                   : 0) {}

  void run(std::span<BoundaryFlux> crossed) {
    take_mass(begin_ - 1);
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

  void take_mass(Index p) {
    const Index lowest = s_.place == Place::z ? 1 : 0;
    const Index k = std::max(level(p, s_.lattice.nz), lowest);
    mass_[at(p)] = row_at_place(s_, s_.mass, k, line(p), first_, n_, scratch_.mass(p));
  }

  /// Records whether a row has nonzero values before its update.
  void check_nonzero(Index p) {
    for (std::size_t m = 0; m < s_.sparse; ++m) {
      nonzero_[m][at(p)] = has_nonzero_row(n_, row(m, p));
    }
  }

  bool nothing_beside(std::size_t m) const {
    const auto& rows = nonzero_[m];
    return m < s_.sparse && !(rows[0] || rows[1] || rows[2] || rows[3]);
  }

  void open_face(Index f) {
    take_mass(f);
    check_nonzero(f + 1);
    const float* flux = row_at_place(s_, s_.flux, level(f, s_.flux.levels()), line(f), first_, n_,
                                     scratch_.flux(f));
    flux_[at(f)] = flux;
    courant_row(lanes_, flux, mass_[at(f - 1)], mass_[at(f)], scratch_.courant());
    const float* exchange = nullptr;
    if (s_.exchange) {
      exchange = row_at_place(s_, *s_.exchange, level(f, s_.flux.levels()), line(f), first_, n_,
                              scratch_.exchange());
    }
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      const float *low = row(m, f - 1), *high = row(m, f);
      carries_[m][at(f)] = !nothing_beside(m);
      if (!carries_[m][at(f)]) {
        std::fill_n(scratch_.value(m, f), lanes_, 0.0F);
        std::fill_n(scratch_.mixed(m, f), lanes_, 0.0F);
        continue;
      }
      face_row(lanes_, flux, scratch_.courant(), {row(m, f - 2), low, high, row(m, f + 1)},
               scratch_.value(m, f));
      if (exchange) {
        mixing_flux_row(lanes_, exchange, s_.mixing, low, high, scratch_.mixed(m, f));
      }
    }
  }

  void close_row(Index p) {
    const float *in = flux_[at(p)], *out = flux_[at(p + 1)], *mass = mass_[at(p)];
    inverse_row(lanes_, mass, in, out, scratch_.inverse());
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      if (!carries_[m][at(p)] && !carries_[m][at(p + 1)]) {
        continue;
      }
      float* q = row(m, p);
      advect_row(n_, in, out, scratch_.value(m, p), scratch_.value(m, p + 1), scratch_.inverse(),
                 q);
      if (s_.exchange) {
        mix_row(n_, scratch_.mixed(m, p), scratch_.mixed(m, p + 1), scratch_.inverse(), q);
      }
      if (m < s_.rescaled && !s_.rest.empty()) {
        const auto k = static_cast<std::size_t>(level(p, s_.lattice.nz));
        rescale_row(n_, mass, in, out, s_.rest[k], q);
      }
    }
  }

  void count(Index f, std::span<BoundaryFlux> crossed) {
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      const float *flux = flux_[at(f)], *value = scratch_.value(m, f);
      for (Index i = 0; i < n_; ++i) {
        const double out = static_cast<double>(flux[i]) * static_cast<double>(value[i]);
        add(crossed[m], f == begin_ ? out : -out);
      }
    }
  }

  float* row(std::size_t m, Index p) {
    Field& field = *s_.fields[m];
    return field.row(level(p, field.levels()), line(p)) + first_;
  }

  const Sweep& s_;
  Index across_;
  RowScratch& scratch_;
  Index first_;                                           ///< column
  Index n_;                                               ///< columns
  Index lanes_;                                           ///< n_ rounded up to full lanes
  Index end_;                                             ///< end of the updated rows
  Index begin_;                                           ///< first updated row
  std::array<const float*, 4> flux_{}, mass_{};           ///< last four faces and rows
  std::array<std::array<bool, 4>, max_fields> nonzero_{}; ///< in the last four rows
  std::array<std::array<bool, 4>, max_fields> carries_{}; ///< last four faces: nonzero flux
};

} // namespace

void sweep_level(const Sweep& sweep, Index k, std::span<BoundaryFlux> crossed) {
  RowScratch scratch(sweep.lattice.stride);
  if (sweep.axis == Axis::y) {
    RollingSweep(sweep, k, scratch).run(crossed);
    return;
  }
  for (Index j = sweep.place == Place::y ? 1 : 0; j < sweep.lattice.ny; ++j) {
    along_x(sweep, k, j, scratch, crossed);
  }
}

void sweep_columns(const Sweep& sweep, Index j) {
  RowScratch scratch(sweep.lattice.stride);
  RollingSweep(sweep, j, scratch).run({});
}

} // namespace firetwin::flow
