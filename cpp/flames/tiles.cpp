#include "flames/tiles.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace firetwin::flames {
namespace {

constexpr std::int64_t patch_nodes = patch_side + 1;
constexpr std::array<double, 2> squares{1024.0, 128.0}; // m, that are skipped at once if empty
constexpr double most_squares = 1.0e7;
constexpr float past_edge = 0.05F;      // tiles by which steps may enter one with flames
constexpr float few_cells = 4.0F;       // over which the ground is as good as straight
constexpr float beside_patches = 16.0F; // m, step where only crowns may burn
constexpr float below_front = 50.0F;    // m, depth to which ground is searched below a tile's
constexpr float no_end = std::numeric_limits<float>::max();

std::int64_t square_number(double at, double span) {
  return static_cast<std::int64_t>(std::floor(at / span));
}

/// Length of the flames that may stand in a tile, m, by the nodes around its cells.
struct TileFlames {
  float front = 0.0F, scale = 0.0F, low = 0.0F, nearest = no_end, farthest = -no_end;
  float ground = FlameTiles::none, lowest = no_end;

  void add(const Node& node) {
    front = std::max(front, node[length_channel]);
    scale = std::max(scale, node[scale_channel]);
    low = std::max(low, node[low_channel]);
    nearest = std::min(nearest, node[distance_channel]);
    farthest = std::max(farthest, node[distance_channel]);
    ground = std::max(ground, node[ground_channel]);
    lowest = std::min(lowest, node[ground_channel]);
  }
  /// @param least drawn length of the shortest flames, m
  float longest(const FlameReach& reach, float least) const {
    const float drawn = front > 0.0F ? std::max(front, least) : 0.0F, wide = std::max(scale, drawn);
    const bool burns = nearest < reach.behind * wide && farthest > -reach.ahead * wide;
    return std::max(burns ? drawn : 0.0F, low > 0.0F ? std::max(low, least) : 0.0F);
  }
};

/// Distance of the farthest corner of a rectangle from the origin, m.
float farthest_corner(const std::array<float, 4>& box, float height) {
  const float x = std::max(std::abs(box[0]), std::abs(box[1])),
              y = std::max(std::abs(box[2]), std::abs(box[3]));
  return std::sqrt(x * x + y * y + height * height);
}

} // namespace

bool FlameTiles::Patch::contains(float east, float north) const {
  const float wide = static_cast<float>(patch_side) * spacing;
  return east >= x && north >= y && east < x + wide && north < y + wide;
}

__attribute__((always_inline)) inline void FlameTiles::Patch::interpolate(float east, float north,
                                                                          Lanes& out) const {
  constexpr float last = static_cast<float>(patch_side) - 0.001F;
  const float column = std::clamp((east - x) * inverse, 0.0F, last),
              row = std::clamp((north - y) * inverse, 0.0F, last);
  const auto i = static_cast<std::size_t>(row), j = static_cast<std::size_t>(column);
  const float up = row - static_cast<float>(i), right = column - static_cast<float>(j);
  const Node* low = nodes.data() + i * patch_nodes + j;
  const Node* high = low + patch_nodes;
  Lanes a, b, c, d;
  load(low[0].data(), a);
  load(low[1].data(), b);
  load(high[0].data(), c);
  load(high[1].data(), d);
  a += (b - a) * right;
  c += (d - c) * right;
  out = a + (c - a) * up;
}

std::size_t FlameTiles::Patch::tile_at(float east, float north, float& right, float& up) const {
  constexpr float last = static_cast<float>(tiles_along) - 0.001F;
  const float scale = inverse / static_cast<float>(side);
  right = std::clamp((east - x) * scale, 0.0F, last);
  up = std::clamp((north - y) * scale, 0.0F, last);
  const auto i = static_cast<std::size_t>(up), j = static_cast<std::size_t>(right);
  right -= static_cast<float>(j);
  up -= static_cast<float>(i);
  return i * tiles_along + j;
}

FlameTiles::Tile FlameTiles::Patch::tile(std::size_t number) const {
  const float span = spacing * static_cast<float>(side);
  const float left = x + static_cast<float>(number % tiles_along) * span,
              low = y + static_cast<float>(number / tiles_along) * span;
  return {top[number], longest[number], {left, left + span, low, low + span}};
}

void FlameTiles::Level::cover(const std::array<std::int64_t, 2>& low,
                              const std::array<std::int64_t, 2>& high) {
  first = low;
  size = {high[0] - low[0] + 1, high[1] - low[1] + 1};
  if (static_cast<double>(size[0]) * static_cast<double>(size[1]) > most_squares) {
    throw std::invalid_argument("patches of flames are too far apart");
  }
  index.assign(static_cast<std::size_t>(size[0] * size[1]), -1);
}

void FlameTiles::Level::set(std::int64_t i, std::int64_t j, std::int32_t number) {
  index[static_cast<std::size_t>((j - first[1]) * size[0] + i - first[0])] = number;
}

std::int32_t FlameTiles::Level::at(std::int64_t i, std::int64_t j) const {
  i -= first[0];
  j -= first[1];
  return i < 0 || j < 0 || i >= size[0] || j >= size[1]
             ? -1
             : index[static_cast<std::size_t>(j * size[0] + i)];
}

FlameTiles::FlameTiles(const FlamePatches& patches, const FlameShape& shape,
                       const FlameReach& reach, const FlameCrowns& crowns, const Vector& origin)
    : origin_(origin), bounds_{no_end, -no_end, no_end, -no_end}, heights_{no_end, -no_end} {
  add_patches(patches, origin);
  list_levels(patches);
  bound_patches(shape, reach);
  bound_crowns(crowns);
  if (any_) {
    list_occupied(crowns);
  }
}

/// Marks the squares that are not skipped.
void FlameTiles::list_occupied(const FlameCrowns& crowns) {
  for (std::size_t n = 0; n < squares.size(); ++n) {
    Level& grid = occupied_[n];
    grid.span = squares[n];
    grid.cover(place(bounds_[0], bounds_[2], grid.span), place(bounds_[1], bounds_[3], grid.span));
    const auto mark = [&](const std::array<float, 4>& box) {
      const auto low = place(box[0], box[2], grid.span), high = place(box[1], box[3], grid.span);
      for (auto j = low[1]; j <= high[1]; ++j) {
        for (auto i = low[0]; i <= high[0]; ++i) {
          grid.set(i, j, 0);
        }
      }
    };
    for (const Patch& each : patches_) {
      for (std::size_t tile = 0; tile < tile_count; ++tile) {
        if (each.top[tile] > none) {
          const auto box = each.tile(tile).bounds;
          mark({std::max(box[0], bounds_[0]), std::min(box[1], bounds_[1]),
                std::max(box[2], bounds_[2]), std::min(box[3], bounds_[3])});
        }
      }
    }
    for (std::size_t crown = 0; crown < crowns.all().size(); ++crown) {
      mark(crowns.box(crown));
    }
  }
}

void FlameTiles::add_patches(const FlamePatches& patches, const Vector& origin) {
  const std::size_t count = patches.spacing.size(),
                    each = static_cast<std::size_t>(patch_nodes * patch_nodes);
  if (patches.corner.size() != 2 * count || patches.nodes.size() != count * each * channel_count) {
    throw std::invalid_argument("nodes must be (n, 33, 33, 8), corners (n, 2), and spacings (n)");
  }
  if (!std::all_of(patches.nodes.begin(), patches.nodes.end(),
                   [](float value) { return std::isfinite(value); })) {
    throw std::invalid_argument("nodes must be finite");
  }
  patches_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double spacing = patches.spacing[n];
    if (!(spacing > 0.0)) {
      throw std::invalid_argument("spacings of patches must be positive");
    }
    Patch& made = patches_[n];
    made.nodes.resize(each);
    std::memcpy(made.nodes.data(), patches.nodes.data() + n * each * channel_count,
                each * sizeof(Node));
    for (Node& node : made.nodes) {
      node[ground_channel] -= static_cast<float>(origin[2]);
      node[length_channel] *= burning_over_seen;
      node[low_channel] *= burning_over_seen;
      node[scale_channel] = std::max(node[scale_channel] * burning_over_seen, node[length_channel]);
    }
    made.x = static_cast<float>(patches.corner[2 * n] - origin[0]);
    made.y = static_cast<float>(patches.corner[2 * n + 1] - origin[1]);
    made.spacing = static_cast<float>(spacing);
    made.inverse = static_cast<float>(1.0 / spacing);
    made.top.fill(none);
    made.longest.fill(0.0F);
    made.rooted.fill(0.0F);
  }
}

void FlameTiles::list_levels(const FlamePatches& patches) {
  std::vector<double> spacings(patches.spacing.begin(), patches.spacing.end());
  std::sort(spacings.begin(), spacings.end());
  spacings.erase(std::unique(spacings.begin(), spacings.end()), spacings.end());
  for (const double spacing : spacings) {
    Level made{spacing * static_cast<double>(patch_side), {}, {}, {}};
    std::vector<std::pair<std::array<std::int64_t, 2>, std::int32_t>> members;
    for (std::size_t n = 0; n < patches.spacing.size(); ++n) {
      if (patches.spacing[n] == spacing) {
        const double half = 0.5 * spacing;
        members.push_back({{square_number(patches.corner[2 * n] + half, made.span),
                            square_number(patches.corner[2 * n + 1] + half, made.span)},
                           static_cast<std::int32_t>(n)});
      }
    }
    std::array<std::int64_t, 2> first = members.front().first, last = first;
    for (const auto& [at, number] : members) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        first[axis] = std::min(first[axis], at[axis]);
        last[axis] = std::max(last[axis], at[axis]);
      }
    }
    made.cover(first, last);
    for (const auto& [at, number] : members) {
      made.set(at[0], at[1], number);
    }
    levels_.push_back(std::move(made));
  }
  finest_ = spacings.empty() ? 0.0F : static_cast<float>(spacings.front());
}

std::array<std::int64_t, 2> FlameTiles::place(float x, float y, double span) const {
  return {square_number(static_cast<double>(x) + origin_[0], span),
          square_number(static_cast<double>(y) + origin_[1], span)};
}

std::array<float, 4> FlameTiles::square(const std::array<std::int64_t, 2>& at, double span) const {
  const auto edge = [&](std::size_t axis, std::int64_t more) {
    return static_cast<float>(static_cast<double>(at[axis] + more) * span - origin_[axis]);
  };
  return {edge(0, 0), edge(0, 1), edge(1, 0), edge(1, 1)};
}

/// Returns the finest patch at a place; null outside of all.
const FlameTiles::Patch* FlameTiles::patch(float x, float y) const {
  for (const Level& level : levels_) {
    const auto [i, j] = place(x, y, level.span);
    if (const std::int32_t number = level.at(i, j); number >= 0) {
      return &patches_[static_cast<std::size_t>(number)];
    }
  }
  return nullptr;
}

/// Eight places within a few cells are interpolated between the first and the last.
FIRETWIN_CLONES("avx2")
void FlameTiles::ends(const Lanes& x, const Lanes& y, NodeLanes& out) const {
  constexpr std::size_t last = lane_count - 1;
  const Patch* near = patch(x[0], y[0]);
  const float away = std::abs(x[last] - x[0]) + std::abs(y[last] - y[0]);
  if (near == nullptr || away > few_cells * near->spacing || !near->contains(x[last], y[last])) {
    nodes(x, y, out);
    return;
  }
  Lanes first, second;
  near->interpolate(x[0], y[0], first);
  near->interpolate(x[last], y[last], second);
  const Lanes part = Lanes{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F} * (1.0F / 7.0F);
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    out[channel] = first[channel] + (second[channel] - first[channel]) * part;
  }
}

FIRETWIN_CLONES("avx2")
void FlameTiles::nodes(const Lanes& x, const Lanes& y, NodeLanes& out) const {
  const Patch* last = nullptr;
  std::array<Lanes, lane_count> rows;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    // Finer patches may cover a part of a coarse one.
    if (last == nullptr || last->spacing > finest_ || !last->contains(x[lane], y[lane])) {
      last = patch(x[lane], y[lane]);
    }
    if (last == nullptr) {
      rows[lane] = Lanes{};
      rows[lane][ground_channel] = none;
    } else {
      last->interpolate(x[lane], y[lane], rows[lane]);
    }
  }
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      out[channel][lane] = rows[lane][channel];
    }
  }
}

float FlameTiles::ground_at(float x, float y) const {
  const Patch* at = patch(x, y);
  if (at == nullptr) {
    return none;
  }
  Lanes node;
  at->interpolate(x, y, node);
  return node[ground_channel];
}

FlameTiles::Roots FlameTiles::rooted(float x, float y) const {
  const Patch* at = patch(x, y);
  if (at == nullptr) {
    return {0.0F, beside_patches};
  }
  float right, up;
  const std::size_t number = at->tile_at(x, y, right, up);
  const float edge = std::min(std::min(up, 1.0F - up), std::min(right, 1.0F - right));
  return {at->rooted[number], (edge + past_edge) * static_cast<float>(side) * at->spacing};
}

bool FlameTiles::find(float x, float y, Tile& tile) const {
  if (!any_ || x < bounds_[0] || x > bounds_[1] || y < bounds_[2] || y > bounds_[3]) {
    return false;
  }
  for (const Level& grid : occupied_) {
    const auto at = place(x, y, grid.span);
    if (grid.at(at[0], at[1]) < 0) {
      tile = {none, 0.0F, square(at, grid.span)};
      return true;
    }
  }
  if (const Patch* at = patch(x, y)) {
    float right, up;
    tile = at->tile(at->tile_at(x, y, right, up));
    return true;
  }
  const double span = static_cast<double>(beside_patches);
  tile = {heights_[1], 0.0F, square(place(x, y, span), span)};
  return true;
}

/// Calls a function with each tile in a rectangle.
template <class Function>
void FlameTiles::visit(const std::array<float, 4>& box, const Function& function) {
  for (const Level& level : levels_) {
    const auto low = place(box[0], box[2], level.span), high = place(box[1], box[3], level.span);
    const auto last = [&](std::size_t axis) { return level.first[axis] + level.size[axis] - 1; };
    for (auto j = std::max(low[1], level.first[1]); j <= std::min(high[1], last(1)); ++j) {
      for (auto i = std::max(low[0], level.first[0]); i <= std::min(high[0], last(0)); ++i) {
        const std::int32_t number = level.at(i, j);
        if (number < 0) {
          continue;
        }
        Patch& each = patches_[static_cast<std::size_t>(number)];
        for (std::size_t tile = 0; tile < tile_count; ++tile) {
          const auto bounds = each.tile(tile).bounds;
          if (bounds[0] <= box[1] && bounds[1] >= box[0] && bounds[2] <= box[3] &&
              bounds[3] >= box[2]) {
            function(each, tile);
          }
        }
      }
    }
  }
}

/// Raises the bounds of all tiles in a rectangle.
void FlameTiles::raise(const std::array<float, 4>& box, float top, float length) {
  any_ = true;
  bounds_ = {std::min(bounds_[0], box[0]), std::max(bounds_[1], box[1]),
             std::min(bounds_[2], box[2]), std::max(bounds_[3], box[3])};
  heights_[1] = std::max(heights_[1], top);
  visit(box, [top, length](Patch& each, std::size_t tile) {
    each.top[tile] = std::max(each.top[tile], top);
    each.longest[tile] = std::max(each.longest[tile], length);
  });
}

void FlameTiles::bound_patches(const FlameShape& shape, const FlameReach& reach) {
  for (Patch& each : patches_) {
    for (std::size_t tile = 0; tile < tile_count; ++tile) {
      const std::size_t i0 = tile / tiles_along * side, j0 = tile % tiles_along * side;
      TileFlames flames;
      for (std::size_t i = i0; i <= i0 + side; ++i) {
        for (std::size_t j = j0; j <= j0 + side; ++j) {
          flames.add(each.nodes[i * patch_nodes + j]);
        }
      }
      const auto box = each.tile(tile).bounds;
      const float longest =
          flames.longest(reach, reach.least * farthest_corner(box, flames.lowest));
      if (longest <= 0.0F) {
        continue;
      }
      each.rooted[tile] = longest;
      heights_[0] = std::min(heights_[0], flames.lowest - below_front);
      const float high = reach.top * longest, flight = shape.flight_to(high);
      const float dx = static_cast<float>(shape.wind[0]) * flight,
                  dy = static_cast<float>(shape.wind[1]) * flight;
      raise({box[0] + std::min(dx, 0.0F), box[1] + std::max(dx, 0.0F), box[2] + std::min(dy, 0.0F),
             box[3] + std::max(dy, 0.0F)},
            flames.ground + high, longest);
    }
  }
}

void FlameTiles::bound_crowns(const FlameCrowns& crowns) {
  for (std::size_t n = 0; n < crowns.all().size(); ++n) {
    const Spindle& crown = crowns.all()[n];
    raise(crowns.box(n), crowns.top(crown), crown.top);
    heights_[0] = std::min(heights_[0], crown.z);
  }
}

} // namespace firetwin::flames
