#include "lod/visible_mask.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace firetwin::lod {
namespace {

constexpr double tile_side = 300.0; // m
/// Views that displace a tile by less than this fraction of its radius are tested together.
constexpr double same_place = 1.0;

void check(std::span<const double> radius, const CullOptions& options) {
  if (std::any_of(radius.begin(), radius.end(), [](double r) { return r < 0.0; }) ||
      !(options.margin >= 0.0)) {
    throw std::invalid_argument("radius and margin must be 0 or more");
  }
  if (!(options.max_distance >= 0.0)) {
    throw std::invalid_argument("max_distance must be 0 or more");
  }
}

/// Bounding box of spheres.
struct Box {
  Vector low, high;
  double radius = 0.0;

  explicit Box(const Vector& at) : low(at), high(at) {}
  void add(const BoundingSphere& sphere) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], sphere.centre[i]);
      high[i] = std::max(high[i], sphere.centre[i]);
    }
    radius = std::max(radius, sphere.radius);
  }
  BoundingSphere sphere() const {
    const Vector size = minus(high, low);
    return {{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])},
            0.5 * std::sqrt(dot(size, size)) + radius};
  }
};

} // namespace

/// Spheres binned by square tiles of terrain.
class Tiles {
public:
  Tiles(std::span<const double> centre, std::span<const double> radius, const ViewSet& view_set,
        const CullOptions& options)
      : centre_(centre), radius_(radius), view_set_(view_set), options_(options) {
    sort();
  }

  void ask(std::span<bool> out) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start_.size() - 1, 8),
                      [&](const auto& range) {
                        std::vector<std::size_t> branches;
                        for (std::size_t tile = range.begin(); tile < range.end(); ++tile) {
                          if (start_[tile] < start_[tile + 1]) {
                            branches.clear();
                            const BoundingSphere box = bounds(tile);
                            find(0, box, branches);
                            ask(tile, box, branches, out);
                          }
                        }
                      });
  }

private:
  BoundingSphere sphere(std::size_t i) const {
    return {{centre_[3 * i], centre_[3 * i + 1], centre_[3 * i + 2]}, radius_[i]};
  }
  bool whole(std::size_t i) const {
    return std::isfinite(centre_[3 * i] + centre_[3 * i + 1] + centre_[3 * i + 2] + radius_[i]);
  }

  void sort() {
    std::vector<std::uint32_t> finite;
    for (std::size_t i = 0; i < radius_.size(); ++i) {
      if (whole(i)) {
        finite.push_back(static_cast<std::uint32_t>(i));
      }
    }
    start_.assign(2, 0);
    if (finite.empty()) {
      return;
    }
    Box all(sphere(finite[0]).centre);
    for (const std::size_t i : finite) {
      all.add(sphere(i));
    }
    const double width = all.high[0] - all.low[0], depth = all.high[1] - all.low[1];
    // At most about as many tiles as spheres.
    const double most = 2.0 * static_cast<double>(finite.size()) + 64.0;
    const double side =
        std::max({tile_side, std::sqrt(width * depth / most), width / most, depth / most});
    const auto columns = static_cast<std::size_t>(width / side) + 1;
    const auto rows = static_cast<std::size_t>(depth / side) + 1;
    std::vector<std::uint32_t> tile(finite.size());
    start_.assign(rows * columns + 1, 0);
    for (std::size_t k = 0; k < finite.size(); ++k) {
      const auto x = static_cast<std::size_t>((centre_[3 * finite[k]] - all.low[0]) / side);
      const auto y = static_cast<std::size_t>((centre_[3 * finite[k] + 1] - all.low[1]) / side);
      tile[k] =
          static_cast<std::uint32_t>(std::min(y, rows - 1) * columns + std::min(x, columns - 1));
      ++start_[tile[k] + 1];
    }
    for (std::size_t t = 1; t < start_.size(); ++t) {
      start_[t] += start_[t - 1];
    }
    member_.resize(finite.size());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t k = 0; k < finite.size(); ++k) {
      member_[next[tile[k]]++] = finite[k];
    }
  }

  BoundingSphere bounds(std::size_t tile) const {
    Box box(sphere(member_[start_[tile]]).centre);
    for (std::size_t k = start_[tile]; k < start_[tile + 1]; ++k) {
      box.add(sphere(member_[k]));
    }
    return box.sphere();
  }

  /// Branches that may see a tile, down to branches whose views are close together.
  void find(std::size_t number, const BoundingSphere& tile, std::vector<std::size_t>& found) const {
    const auto& branch = view_set_.branches_[number];
    double nowhere = 0.0;
    if (!view_set_.may_be_visible(branch, tile, options_, nullptr, nowhere)) {
      return;
    }
    if (branch.left == 0 || view_set_.shift(branch, tile.centre) <= same_place * tile.radius) {
      found.push_back(number);
      return;
    }
    find(branch.left, tile, found);
    find(branch.right, tile, found);
  }

  /// Tests the spheres of a tile. The view that saw the previous sphere is tested first. The
  /// occlusion of the complete tile from a branch is tested once, on first use.
  void ask(std::size_t tile, const BoundingSphere& bounds, const std::vector<std::size_t>& branches,
           std::span<bool> out) const {
    std::vector<std::optional<bool>> open(branches.size());
    std::size_t leaf = 0;
    double ridge = 0.0;
    for (std::size_t k = start_[tile]; k < start_[tile + 1]; ++k) {
      const BoundingSphere target = sphere(member_[k]);
      bool visible = leaf != 0 && view_set_.is_visible(leaf, target, options_, leaf, ridge);
      for (std::size_t i = 0; i < branches.size() && !visible; ++i) {
        if (!open[i]) {
          const auto& branch = view_set_.branches_[branches[i]];
          open[i] =
              view_set_.may_be_visible(branch, bounds, options_, view_set_.occluder_.get(), ridge);
        }
        visible = *open[i] && view_set_.is_visible(branches[i], target, options_, leaf, ridge);
      }
      out[member_[k]] = visible;
    }
  }

  std::span<const double> centre_, radius_;
  const ViewSet& view_set_;
  CullOptions options_;
  std::vector<std::size_t> start_; ///< first member of each tile in member_, and the end
  std::vector<std::uint32_t> member_;
};

void visible_mask(std::span<const double> centre, std::span<const double> radius,
                  const ViewSet& view_set, const CullOptions& options, std::span<bool> out) {
  check(radius, options);
  std::fill(out.begin(), out.end(), false);
  if (view_set.size() == 0) {
    return;
  }
  Tiles(centre, radius, view_set, options).ask(out);
}

void distance(std::span<const double> place, const ViewSet& view_set, std::span<double> out) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      out[i] = view_set.distance({place[3 * i], place[3 * i + 1], place[3 * i + 2]});
    }
  });
}

} // namespace firetwin::lod
