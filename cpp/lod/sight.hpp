#pragma once

#include "lod/frustum.hpp"
#include "lod/occluder.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace firetwin::lod {

/// What counts as seen.
struct Demand {
  double reach = std::numeric_limits<double>::infinity(); ///< m from a camera in perspective
  double margin = 0.0; ///< m that every view is wider and higher, for what only sheds light into it
  bool shadows = false; ///< also what throws its shadow on a place (air or ground) that is seen
};

/// What some views see, usually all that a shot films. The one visibility: nothing that is visible
/// is left out.
///
/// The views are the leaves of a tree. A branch stands for all views below it by the one in the
/// middle and by how far the others are moved and turned from it: seen from the middle, a ball is
/// so much larger that no motion between them loses it. Where a branch does not see, no view of it
/// is asked.
class Sight {
public:
  /// @param views neighbours in a path are neighbours here
  /// @param ground hides what is behind it; may be null
  /// @param floor m, where shadows end at the latest: no ground is lower
  /// @throws std::invalid_argument unless places are finite, rotations are rotations and the views'
  ///         sizes positive.
  Sight(std::vector<View> views, std::shared_ptr<const Occluder> ground, double floor);

  /// Whether any of a ball is seen; never with a NaN in it.
  bool counts(const Ball& ball, const Demand& demand) const;

  /// Least distance of a place from the cameras in perspective, m; infinite without any.
  double distance(const Vector& place) const;

  std::size_t size() const { return views_.size(); }

private:
  friend class Tiles;

  /// Views first to last - 1.
  struct Branch {
    std::size_t first, last;
    std::size_t left, right; ///< branches; 0 for leaves
    std::size_t middle;      ///< view that stands for all
    Frustum frustum;         ///< of the middle, as wide as any
    double moved;            ///< farthest camera from the middle's, m
    double turned;           ///< largest change of a direction by the rotation from the middle's
    bool perspective;        ///< any of them
    bool parallel;           ///< any of them
    bool clear;              ///< all of them
    Vector sun;              ///< of a view with shadows
    double sun_moved;        ///< largest difference of another's from it
    double sun_height;       ///< least sine of those with shadows; 0 where none has
  };

  std::size_t grow(std::size_t first, std::size_t last);
  Branch branch(std::size_t first, std::size_t last) const;
  /// How far a place may lie elsewhere, seen by another view than the middle's.
  double shift(const Branch& branch, const Vector& place) const;
  /// Whether a ball may count for a view of this branch; exact for leaves.
  /// @param ground what hides; null asks the views alone, which is quick
  /// @param ridge where on the way it last did (see `Occluder::hides`)
  bool may_count(const Branch& branch, const Ball& ball, const Demand& demand,
                 const Occluder* ground, double& ridge) const;
  bool may_see(const Branch& branch, const Ball& ball, const Demand& demand, const Occluder* ground,
               double& ridge) const;
  bool may_shadow(const Branch& branch, const Ball& ball, const Demand& demand,
                  const Occluder* ground, double& ridge) const;
  /// A ball round its shadow between two distances (m) from its middle, whichever view's sun throws
  /// it.
  static Ball piece(const Branch& branch, const Ball& ball, double from, double to);
  /// `leaf` becomes the branch for whose view it counts.
  bool counts(std::size_t branch, const Ball& ball, const Demand& demand, std::size_t& leaf,
              double& ridge) const;
  void distance(std::size_t branch, const Vector& place, double& least) const;

  std::vector<View> views_;
  std::vector<Branch> branches_; ///< [0] is the root
  std::shared_ptr<const Occluder> ground_;
  double floor_;
};

} // namespace firetwin::lod
