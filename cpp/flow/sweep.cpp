#include "flow/sweep.hpp"

#include "flow/rows.hpp"

#include <algorithm>
#include <array>

namespace firetwin::flow {
namespace {

/// Rows that a sweep works with; its size does not depend on the number of levels.
class Desk {
public:
  explicit Desk(Index length)
      : length_(length),
        memory_(static_cast<std::size_t>(length * (11 + 8 * static_cast<Index>(most_fields)))) {}
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
  float* slot(Index i) { return memory_.data() + i * length_ + halo; }

  Index length_;
  std::vector<float> memory_;
};

void add(Crossed& crossed, double inwards) {
  (inwards > 0.0 ? crossed.in : crossed.out) += inwards > 0.0 ? inwards : -inwards;
}

/// A row of what cells or their faces have, meant to the sweep's places.
void placed(const Sweep& s, const Field& field, Index k, Index j, Index first, Index n,
            float* out) {
  const float* here = field.row(k, j) + first;
  if (s.place == Place::middle) {
    std::copy_n(here, n, out);
    return;
  }
  const float* before = s.place == Place::x   ? here - 1
                        : s.place == Place::y ? field.row(k, j - 1) + first
                                              : field.row(k - 1, j) + first;
  mean_row(n, before, here, out);
}

void along_x(const Sweep& s, Index k, Index j, Desk& desk, std::span<Crossed> crossed) {
  const Index first = s.place == Place::x ? 1 : 0;
  const Index n = s.lattice.nx - first;
  float* flux = desk.flux(0);
  float* mass = desk.mass(0);
  placed(s, s.flux, k, j, first, n + 1, flux);
  placed(s, s.mass, k, j, first - 1, n + 2, mass - 1);
  courant_row(n + 1, flux, mass - 1, mass, desk.courant());
  inverse_row(n, mass, flux, flux + 1, desk.inverse());
  if (s.exchange) {
    placed(s, *s.exchange, k, j, first, n + 1, desk.exchange());
  }
  for (std::size_t m = 0; m < s.fields.size(); ++m) {
    float* q = s.fields[m]->row(k, j) + first;
    float* value = desk.value(m, 0);
    float* mixed = desk.mixed(m, 0);
    face_row(n + 1, flux, desk.courant(), {q - 2, q - 1, q, q + 1}, value);
    if (s.exchange) {
      mixed_row(n + 1, desk.exchange(), s.mixing, q - 1, q, mixed);
    }
    carry_row(n, flux, flux + 1, value, value + 1, desk.inverse(), q);
    if (s.exchange) {
      stir_row(n, mixed, mixed + 1, desk.inverse(), q);
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

/// A sweep along y or z of whole rows along x. Rows are changed in place as soon as no face needs
/// what they were: face f reads rows f - 2 to f + 1.
class Rolling {
public:
  Rolling(const Sweep& sweep, Index across, Desk& desk)
      : s_(sweep), across_(across), desk_(desk), first_(sweep.place == Place::x ? 1 : 0),
        n_(sweep.lattice.nx - first_),
        end_(sweep.axis == Axis::y ? sweep.lattice.ny : sweep.lattice.nz),
        begin_((sweep.axis == Axis::y && sweep.place == Place::y) ||
                       (sweep.axis == Axis::z && sweep.place == Place::z)
                   ? 1
                   : 0) {}

  void run(std::span<Crossed> crossed) {
    take_mass(begin_ - 1);
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

  void take_mass(Index p) {
    const Index lowest = s_.place == Place::z ? 1 : 0;
    const Index k = std::max(level(p, s_.lattice.nz), lowest);
    placed(s_, s_.mass, k, line(p), first_, n_, desk_.mass(p));
  }

  void open_face(Index f) {
    take_mass(f);
    float* flux = desk_.flux(f);
    placed(s_, s_.flux, level(f, s_.flux.levels()), line(f), first_, n_, flux);
    courant_row(n_, flux, desk_.mass(f - 1), desk_.mass(f), desk_.courant());
    if (s_.exchange) {
      placed(s_, *s_.exchange, level(f, s_.flux.levels()), line(f), first_, n_, desk_.exchange());
    }
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      const float *low = row(m, f - 1), *high = row(m, f);
      face_row(n_, flux, desk_.courant(), {row(m, f - 2), low, high, row(m, f + 1)},
               desk_.value(m, f));
      if (s_.exchange) {
        mixed_row(n_, desk_.exchange(), s_.mixing, low, high, desk_.mixed(m, f));
      }
    }
  }

  void close_row(Index p) {
    const float *in = desk_.flux(p), *out = desk_.flux(p + 1), *mass = desk_.mass(p);
    inverse_row(n_, mass, in, out, desk_.inverse());
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      float* q = row(m, p);
      carry_row(n_, in, out, desk_.value(m, p), desk_.value(m, p + 1), desk_.inverse(), q);
      if (s_.exchange) {
        stir_row(n_, desk_.mixed(m, p), desk_.mixed(m, p + 1), desk_.inverse(), q);
      }
      if (m < s_.rescaled && !s_.rest.empty()) {
        const auto k = static_cast<std::size_t>(level(p, s_.lattice.nz));
        rescale_row(n_, mass, in, out, s_.rest[k], q);
      }
    }
  }

  void count(Index f, std::span<Crossed> crossed) {
    for (std::size_t m = 0; m < s_.fields.size(); ++m) {
      const float *flux = desk_.flux(f), *value = desk_.value(m, f);
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
  Desk& desk_;
  Index first_; ///< column
  Index n_;     ///< columns
  Index end_;   ///< after the last row that changes
  Index begin_; ///< the first row that changes
};

} // namespace

void sweep_level(const Sweep& sweep, Index k, std::span<Crossed> crossed) {
  Desk desk(sweep.lattice.stride);
  if (sweep.axis == Axis::y) {
    Rolling(sweep, k, desk).run(crossed);
    return;
  }
  for (Index j = sweep.place == Place::y ? 1 : 0; j < sweep.lattice.ny; ++j) {
    along_x(sweep, k, j, desk, crossed);
  }
}

void sweep_columns(const Sweep& sweep, Index j) {
  Desk desk(sweep.lattice.stride);
  Rolling(sweep, j, desk).run({});
}

} // namespace firetwin::flow
