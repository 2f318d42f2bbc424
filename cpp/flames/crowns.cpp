#include "flames/crowns.hpp"

#include "base/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace firetwin::flames {
namespace {

constexpr float cell = 8.0F;             // m
constexpr float places_in_metre = 16.0F; // that have their own eddies
constexpr float overshoot = 0.05F;       // cells by which steps may enter one with flames
constexpr float wide_radius = 0.2F;      // radius of the solved crown, in its height
constexpr float least_size = 0.45F;      // of a block across, in the height of the flames

} // namespace

float FlameShape::flight_to(float height) const {
  const auto speed = static_cast<float>(launch), lift = static_cast<float>(acceleration);
  return (std::sqrt(speed * speed + 2.0F * lift * std::max(height, 0.0F)) - speed) / lift;
}

float FlameCrowns::size(const Spindle& crown) {
  return std::max(crown.radius / wide_radius, least_size * crown.top);
}

FlameCrowns::FlameCrowns(std::span<const Spindle> crowns, const FlameShape& shape, float tall,
                         float wide, const Vector& origin)
    : crowns_(crowns.begin(), crowns.end()), tall_(tall) {
  if (crowns_.empty()) {
    return;
  }
  constexpr float far = std::numeric_limits<float>::max();
  std::array<float, 4> all{far, -far, far, -far};
  for (Spindle& each : crowns_) {
    hashes_.push_back(lattice_hash(std::lround(places_in_metre * each.x),
                                   std::lround(places_in_metre * each.y), 0));
    each.x -= static_cast<float>(origin[0]);
    each.y -= static_cast<float>(origin[1]);
    each.z -= static_cast<float>(origin[2]);
    each.top *= burning_over_seen;
    const float flight = lean * shape.flight_to((tall - upright) * each.top);
    const float dx = static_cast<float>(shape.wind[0]) * flight,
                dy = static_cast<float>(shape.wind[1]) * flight, half = wide * size(each);
    const std::array<float, 4> box{
        each.x + std::min(dx, 0.0F) - half, each.x + std::max(dx, 0.0F) + half,
        each.y + std::min(dy, 0.0F) - half, each.y + std::max(dy, 0.0F) + half};
    all = {std::min(all[0], box[0]), std::max(all[1], box[1]), std::min(all[2], box[2]),
           std::max(all[3], box[3])};
    boxes_.push_back(box);
  }
  corner_ = {all[0], all[2]};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    cells_[axis] = static_cast<std::int64_t>((all[2 * axis + 1] - all[2 * axis]) / cell) + 1;
  }
  const auto visit = [&](const auto& use) {
    for (std::uint32_t n = 0; n < boxes_.size(); ++n) {
      const auto number = [&](float at, std::size_t axis) {
        return static_cast<std::int64_t>((at - corner_[axis]) / cell);
      };
      for (auto j = number(boxes_[n][2], 1); j <= number(boxes_[n][3], 1); ++j) {
        for (auto i = number(boxes_[n][0], 0); i <= number(boxes_[n][1], 0); ++i) {
          use(static_cast<std::size_t>(j * cells_[0] + i), n);
        }
      }
    }
  };
  starts_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]) + 1, 0);
  visit([&](std::size_t at, std::uint32_t) { ++starts_[at + 1]; });
  for (std::size_t at = 0; at + 1 < starts_.size(); ++at) {
    starts_[at + 1] += starts_[at];
  }
  numbers_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  visit([&](std::size_t at, std::uint32_t n) { numbers_[next[at]++] = n; });
}

std::span<const std::uint32_t> FlameCrowns::at(float x, float y) const {
  if (crowns_.empty()) {
    return {};
  }
  const float i = (x - corner_[0]) / cell, j = (y - corner_[1]) / cell;
  if (!(i >= 0.0F && j >= 0.0F && i < static_cast<float>(cells_[0]) &&
        j < static_cast<float>(cells_[1]))) {
    return {};
  }
  const auto number = static_cast<std::size_t>(static_cast<std::int64_t>(j) * cells_[0] +
                                               static_cast<std::int64_t>(i));
  return std::span(numbers_).subspan(starts_[number], starts_[number + 1] - starts_[number]);
}

float FlameCrowns::free_distance(float x, float y, float z, float across) const {
  constexpr float far = std::numeric_limits<float>::max();
  if (crowns_.empty()) {
    return far;
  }
  const float i = (x - corner_[0]) / cell, j = (y - corner_[1]) / cell;
  const float wide = static_cast<float>(cells_[0]), deep = static_cast<float>(cells_[1]);
  float edge = std::max(std::max(-i, i - wide), std::max(-j, j - deep));
  float over = far;
  if (edge < 0.0F) {
    const float right = i - std::floor(i), up = j - std::floor(j);
    edge = std::min(std::min(up, 1.0F - up), std::min(right, 1.0F - right));
    for (const std::uint32_t number : at(x, y)) {
      over = std::min(over, z - top(crowns_[number]));
    }
  }
  if (over <= 0.0F) {
    return 0.0F;
  }
  return std::min(over, (edge + overshoot) * cell / std::max(across, 0.01F));
}

} // namespace firetwin::flames
