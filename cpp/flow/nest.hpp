#pragma once

#include "flow/sides.hpp"

namespace firetwin::flow {

/// Where a lattice lies: its lowest corner, m.
using Corner = std::array<double, 2>;

/// One flow as a finer lattice inside it sees it: linear between its points, over x, y and the
/// height above ground. What differs from the ambient air is carried over, so that rest stays rest
/// over a ground of more detail.
class Window {
public:
  Window(const Lattice& from, const Corner& from_corner, const Ambient& from_ambient,
         const Lattice& to, const Corner& to_corner, const Ambient& to_ambient);

  /// Fills `to`, ghost cells too, in columns nearer to a side than `reach` cells.
  void look(const State& from, State& to, Index reach) const;

private:
  struct Knot {
    Index low;
    float part; ///< of the way to low + 1
  };
  struct Axes {
    std::vector<Knot> x, y, z;
  };

  /// A field, and what it differs from here and there: a constant more, or the fields of rest.
  struct Part {
    const Field* from;
    Field* to;
    float constant = 0.0F;
    const Field* from_rest = nullptr;
    const Field* to_rest = nullptr;
  };

  Axes axes(Place place) const;
  void level(const Axes& axes, const Part& part, Index k, Index reach) const;
  float wind_change(Index k, std::size_t axis) const;

  const Lattice& from_;
  const Lattice& to_;
  Corner offset_; ///< of the finer box's corner in the coarser one, m
  const Ambient& from_ambient_;
  const Ambient& to_ambient_;
  Axes middle_, u_, v_, w_;
};

} // namespace firetwin::flow
