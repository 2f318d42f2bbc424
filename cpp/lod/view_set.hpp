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

/// Options of a visibility query.
struct CullOptions {
  double max_distance = std::numeric_limits<double>::infinity(); ///< from perspective cameras, m
  double margin = 0.0;  ///< m by which each frustum is enlarged, for indirect light
  bool shadows = false; ///< keep shadow casters: spheres whose shadow falls on a visible point
};

/// Views of a shot as a tree, for frustum and occlusion culling. Culling is conservative: it never
/// removes a visible object.
///
/// The views are the leaves of a binary tree. A branch represents all views below it by the frustum
/// of its middle view and the largest translation and rotation of the other views. A sphere is
/// enlarged by this motion before the test. If the test of a branch fails, its views are skipped.
class ViewSet {
public:
  /// @param views in order along the camera path, so that neighbours share a branch
  /// @param occluder terrain; null disables occlusion culling
  /// @param lowest_terrain lower bound of all terrain, m; shadow rays end there
  /// @throws std::invalid_argument unless positions are finite, rotations are orthonormal and
  ///         half_width and half_height are positive.
  ViewSet(std::vector<View> views, std::shared_ptr<const Occluder> occluder, double lowest_terrain);

  /// Returns true if any view sees any part of a bounding sphere. Spheres with NaN are never
  /// visible.
  bool is_visible(const BoundingSphere& sphere, const CullOptions& options) const;

  /// Distance of a point from the nearest perspective camera, m; infinite without one.
  double distance(const Vector& place) const;

  /// Largest value over the views that see a sphere; -1 if none does.
  ///
  /// Branch and bound: a branch is skipped if its bound is not above the largest value so far. The
  /// bound must be the exact value for views with one camera.
  /// @param bound bound(branch, camera, moved) >= 0: upper bound of the values of a branch, whose
  /// cameras are
  ///        within `moved` m of `camera`
  template <class Bound>
  double largest(const BoundingSphere& sphere, const CullOptions& options,
                 const Bound& bound) const {
    double most = -1.0, ridge = 0.0;
    if (!branches_.empty()) {
      largest(0, sphere, options, bound, most, ridge);
    }
    return most;
  }

  /// Maximum of a number per view, for each branch, in the numbering of `largest`.
  std::vector<double> largest_of_branches(std::span<const double> of_view) const;

  /// Number of views.
  std::size_t size() const { return views_.size(); }
  const View& view(std::size_t number) const { return views_[number]; }

private:
  friend class Tiles;

  /// Views first to last - 1.
  struct Branch {
    std::size_t first, last;
    std::size_t left, right; ///< branches; 0 for leaves
    std::size_t middle;      ///< view that represents the branch
    Frustum frustum;         ///< of the middle view, as wide as the widest view
    double moved;            ///< largest translation from the middle view, m
    double turned;           ///< largest change of a unit vector by rotation from the middle view
    bool perspective;        ///< any view is perspective
    bool orthographic;       ///< any view is orthographic
    bool above_terrain;      ///< all cameras are above the terrain
    Vector sun;              ///< sun direction of a view with shadows
    double sun_moved;        ///< largest difference from the sun directions of other views
    double sun_height;       ///< lowest sine of the sun's elevation; 0 without shadows
  };

  std::size_t grow(std::size_t first, std::size_t last);
  Branch branch(std::size_t first, std::size_t last) const;
  /// Upper bound of a point's displacement between the middle view's frame and another view's, m.
  double shift(const Branch& branch, const Vector& place) const;
  /// Returns true if a sphere may be visible in a view of this branch; exact for leaves.
  /// @param occluder null tests only the frusta, which is fast
  /// @param ridge fraction of the last occlusion (see `Occluder::occludes`)
  bool may_be_visible(const Branch& branch, const BoundingSphere& sphere,
                      const CullOptions& options, const Occluder* occluder, double& ridge) const;
  bool may_be_in_view(const Branch& branch, const BoundingSphere& sphere,
                      const CullOptions& options, const Occluder* occluder, double& ridge) const;
  bool may_cast_shadow(const Branch& branch, const BoundingSphere& sphere,
                       const CullOptions& options, const Occluder* occluder, double& ridge) const;
  /// Bounding sphere of a shadow between two distances (m) from the caster, for all sun directions
  /// of the branch.
  static BoundingSphere shadow_sphere(const Branch& branch, const BoundingSphere& sphere,
                                      double from, double to);
  /// @param leaf receives the leaf whose view sees the sphere
  bool is_visible(std::size_t branch, const BoundingSphere& sphere, const CullOptions& options,
                  std::size_t& leaf, double& ridge) const;
  void distance(std::size_t branch, const Vector& place, double& least) const;
  template <class Bound>
  void largest(std::size_t number, const BoundingSphere& sphere, const CullOptions& options,
               const Bound& bound, double& most, double& ridge) const {
    const Branch& b = branches_[number];
    const auto bound_of = [&](std::size_t n) {
      return bound(n, views_[branches_[n].middle].position, branches_[n].moved);
    };
    const double value = bound_of(number);
    if (!(value > most) || !may_be_visible(b, sphere, options, occluder_.get(), ridge)) {
      return;
    }
    if (b.left == 0) {
      most = value;
      return;
    }
    const bool swap = bound_of(b.right) > bound_of(b.left);
    largest(swap ? b.right : b.left, sphere, options, bound, most, ridge);
    largest(swap ? b.left : b.right, sphere, options, bound, most, ridge);
  }

  std::vector<View> views_;
  std::vector<Branch> branches_; ///< [0] is the root
  std::shared_ptr<const Occluder> occluder_;
  double lowest_terrain_;
};

} // namespace firetwin::lod
