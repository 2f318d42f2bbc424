#include "flames/field.hpp"

#include "base/clones.hpp"
#include "base/constants.hpp"
#include "base/noise.hpp"
#include "base/smoothstep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace firetwin::flames {
namespace {

constexpr float most_shear =
    0.5F;                         // m/m by wind: thin sheets show the block's cells beyond (by eye)
constexpr float slow = 2.0F;      // m, height below which gas may be as slow as at the ground
constexpr float shortest = 0.05F; // m, length of flames that are drawn
constexpr float overlap = 0.8F;   // part of a segment from which the next one fades in
constexpr std::array<float, 2> octave_blend{0.4F, 0.6F}; // octaves between rounded lengths
constexpr std::array<float, 2> turned{0.8725F, 0.9625F}; // cosines of 29 and 16 degrees
constexpr float row_spacing = 1.1F;                      // of low flames, in their lengths
constexpr float row_front = 0.25F;   // distance behind which a row burns, in lengths
constexpr float row_length = 1.4F;   // scale of their eddies over their height
constexpr double burning_rows = 0.5; // share of the segments of rows that burn
constexpr float row_warp = 0.45F;    // displacement of rows, in lengths
constexpr std::array<float, 2> warp_waves{0.7F, 1.7F}; // waves in a length
constexpr std::array<std::array<float, 2>, 2> uneven{{{1.7F, 0.12F}, {4.3F, 0.05F}}};
///< waves in a length and their height, in lengths, of a front's edge (by eye)
constexpr float crown_blend = 0.02F; // code over which a crown counts
constexpr int directions = 4;
constexpr float diagonal = std::numbers::sqrt2_v<float> / 2.0F;
constexpr std::array<std::array<float, 2>, directions> axes{
    {{1.0F, 0.0F}, {diagonal, diagonal}, {0.0F, 1.0F}, {-diagonal, diagonal}}};
constexpr auto g = static_cast<float>(constants::gravity);

__attribute__((always_inline)) inline void clamp_lanes(const Lanes& value, float low, float high,
                                                       Lanes& out) {
  const Lanes a = Lanes{} + low, b = Lanes{} + high;
  out = value < a ? a : value;
  out = out > b ? b : out;
}

__attribute__((always_inline)) inline void smooth_lanes(const Lanes& value, float low, float high,
                                                        Lanes& out) {
  clamp_lanes((value - low) * (1.0F / (high - low)), 0.0F, 1.0F, out);
  out = out * out * (3.0F - 2.0F * out);
}

__attribute__((always_inline)) inline void roots(const Lanes& value, Lanes& out) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    out[lane] = std::sqrt(value[lane]);
  }
}

float greatest(const Lanes& value) {
  float out = value[0];
  for (std::size_t lane = 1; lane < lane_count; ++lane) {
    out = std::max(out, value[lane]);
  }
  return out;
}

float least(const Lanes& value) {
  return -greatest(-value);
}

/// Returns the lowest of the lengths that are seen, which are more than 0.
float lowest(const Lanes& length, const Lanes& seen) {
  return least(seen > 0.0F ? length : Lanes{} + greatest(length));
}

/// Number, 0 to 1, of a hash.
double unit(std::uint32_t hash) {
  return static_cast<double>(hash >> 8U) * 0x1.0p-24;
}

/// Value noise, about -1 to 1, of wavelength 1.
float wave(float x, float y, std::int64_t seed) {
  const float i = std::floor(x), j = std::floor(y);
  const auto rise = [&](int row, int column) {
    const auto hash = lattice_hash(static_cast<std::int64_t>(i) + column,
                                   static_cast<std::int64_t>(j) + row, seed);
    return static_cast<float>(2.0 * unit(hash) - 1.0);
  };
  return gradient_noise(rise, y - j, x - i);
}

/// Bends a front's edge, which is uneven as fuel is.
void bend_edge(const Lanes& along, std::uint32_t seed, Lanes& across) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (const auto& [waves, height] : uneven) {
      across[lane] += height * wave(waves * along[lane], 0.5F, seed);
    }
  }
}

/// Adds a block's gas with a weight. Codes add as fourth powers, with weights to the power of 1.5:
/// a mean of two patterns has half of the gas of each, which is dark, and their sum is too rich.
void add_block(const FlameBlock& block, const BlockPlaces& places, float time,
               const BlockLevels& levels, const Lanes& weight, GasLanes& out) {
  const auto add = [&](int number, float share) {
    if (share <= 0.0F) {
      return;
    }
    if (number == 0) {
      Lanes code;
      block.codes(places, time, levels.detail, code);
      Lanes kept;
      roots(weight, kept);
      const Lanes square = code * code;
      out.code += weight * kept * square * square;
    } else {
      CoarseFlame flame;
      block.coarse(number, places, time, flame);
      out.coarse.extinction += weight * flame.extinction * share;
      out.coarse.hot += weight * flame.hot * share;
    }
  };
  add(levels.number, 1.0F - levels.part);
  add(levels.number + 1, levels.part);
}

/// Lengths at which flames are drawn where pixels have this size, m.
__attribute__((always_inline)) inline void drawn_lengths(const Lanes& length, float size,
                                                         Lanes& out) {
  const float at_least = std::max(FlameField::wide_pixels * size, shortest);
  out = length < at_least ? Lanes{} + at_least : length;
}

/// Returns codes from the sums of `add_block`.
void finish_codes(GasLanes& gas) {
  Lanes square;
  roots(gas.code, square);
  roots(square, gas.code);
}

/// A moment of a block that repeats in other places: each loop fades in over the end of the one
/// before.
struct Moment {
  std::int64_t loop;
  float time; ///< since the loop began, over sqrt(L / g)
  float part; ///< share of this loop; the rest is of the one before
};

Moment moment(const FlameBlock& block, double time, float length, double phase) {
  const double period = block.period();
  const double at =
      time / std::sqrt(static_cast<double>(length) / constants::gravity) + phase * period;
  const double loop = std::floor(at / period);
  const auto since = static_cast<float>(at - period * loop);
  const float part = block.fading() > 0.0F ? std::min(since / block.fading(), 1.0F) : 1.0F;
  return {static_cast<std::int64_t>(loop), since, part};
}

/// Returns a number from 0 to 1 for a loop; successive loops get distant numbers (golden ratio).
double spread(double first, std::int64_t loop) {
  const double at = first + static_cast<double>(loop) / std::numbers::phi;
  return at - std::floor(at);
}

/// Calls a function with the loops of a moment, their times and their shares.
template <class Function>
void each_loop(const FlameBlock& block, const Moment& now, const Function& function) {
  if (now.part > 0.0F) {
    function(now.loop, now.time, now.part);
  }
  if (now.part < 1.0F) {
    function(now.loop - 1, now.time + static_cast<float>(block.period()), 1.0F - now.part);
  }
}

} // namespace

/// Places from which the gas at eight points rose, with their nodes.
struct FlameField::Foot {
  Lanes x, y; ///< m
  NodeLanes node;
  std::array<Lanes, 2> along;                         ///< unit vector along the front
  std::array<Lanes, FlameLibrary::most_kinds> shares; ///< of the kinds of lines
};

/// Flames along a line at eight points.
struct FlameField::Line {
  const Foot& foot;
  const Lanes& across; ///< distance behind the front over the drawn length
  const Lanes& height; ///< over the ground, in drawn lengths
  BlockLevels levels;
  std::size_t kind;
  std::uint32_t salt;
};

/// Lengths at eight points that are rounded to one power of 2, and the weights of that.
struct FlameField::Octave {
  int number;
  Lanes weight;
};

/// Powers of 2 near the lengths of eight points with their weights, which add up to those given.
class FlameField::Octaves {
public:
  Octaves(const Lanes& length, const Lanes& weight) {
    Lanes exact;
    int first = 99, last = -99;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      exact[lane] = std::log2(std::max(length[lane], shortest));
      if (weight[lane] > 0.0F) {
        first = std::min(first, static_cast<int>(std::floor(exact[lane] + octave_blend[0])));
        last = std::max(last, static_cast<int>(std::ceil(exact[lane] - octave_blend[0])));
      }
    }
    for (int number = first; number <= last && count_ < octaves_.size(); ++number) {
      Lanes away = exact - static_cast<float>(number), far;
      away = away < 0.0F ? -away : away;
      smooth_lanes(away, octave_blend[0], octave_blend[1], far);
      const Lanes near = weight * (1.0F - far);
      if (greatest(near) > 0.0F) {
        octaves_[count_++] = {number, near};
      }
    }
  }
  const Octave* begin() const { return octaves_.data(); }
  const Octave* end() const { return octaves_.data() + count_; }

private:
  std::array<Octave, 12> octaves_;
  std::size_t count_ = 0;
};

/// Eight points in one segment along a front.
struct FlameField::Segment {
  const Line& line;
  int octave, direction;
  std::int64_t number;
  const Lanes& along; ///< place in the segment, in rounded lengths
  const Lanes& weight;
};

FlameField::FlameField(const FlameTiles& tiles, const FlameCrowns& crowns,
                       const FlameLibrary& library, const FlameShape& shape, const Vector& origin,
                       double time)
    : tiles_(tiles), crowns_(crowns), library_(library), shape_(shape), origin_(origin),
      time_(time) {
  shape_.launch =
      std::max(shape_.launch, lean * std::hypot(shape.wind[0], shape.wind[1]) / most_shear);
}

float FlameField::foot_speed(float height, const std::array<float, 3>& direction) const {
  const float across = std::hypot(direction[0], direction[1]), along = std::abs(direction[2]);
  // The foot moves no faster than this within half the height, and leans anything from nothing to
  // all of the wind.
  const auto launch = static_cast<float>(shape_.launch),
             lift = static_cast<float>(shape_.acceleration);
  const float wind = lean * static_cast<float>(std::hypot(shape_.wind[0], shape_.wind[1]));
  const float speed_up = height > slow ? std::sqrt(launch * launch + lift * height) : launch;
  return across + wind / speed_up * (along + 0.5F * across);
}

float FlameField::free_distance(const std::array<float, 3>& place, float height,
                                const std::array<float, 3>& direction) const {
  const auto [x, y, z] = place;
  const float across = std::hypot(direction[0], direction[1]), along = std::abs(direction[2]);
  const auto wind_x = lean * static_cast<float>(shape_.wind[0]),
             wind_y = lean * static_cast<float>(shape_.wind[1]);
  const float wind = std::hypot(wind_x, wind_y), speed = foot_speed(height, direction);
  const float away = shape_.flight_to(height);
  float longest = 0.0F, edge = std::numeric_limits<float>::max();
  constexpr int parts = 2; // places between the foot of upright and of leaning flames
  for (int n = 0; n <= parts; ++n) {
    const float part = away * static_cast<float>(n) / static_cast<float>(parts);
    const auto roots = tiles_.rooted(x - wind_x * part, y - wind_y * part);
    longest = std::max(longest, roots.longest);
    edge = std::min(edge, roots.edge);
    if (wind * away < 0.1F) {
      break;
    }
  }
  float free = edge / std::max(speed, 0.01F);
  const float climb = std::max(along + 0.5F * across, 0.01F);
  if (longest > 0.0F) {
    const float over = height - library_.top() * longest;
    free = over > 0.0F ? std::min(free, 0.5F * over / climb) : 0.0F;
  } else if (height > slow) {
    free = std::min(free, 0.5F * height / climb);
  }
  return free > 0.0F ? std::min(free, crowns_.free_distance(x, y, z, across)) : 0.0F;
}

FIRETWIN_CLONES("avx2")
void FlameField::evaluate(const Lanes& x, const Lanes& y, const Lanes& z, float size,
                          FlameSamples& out) const {
  out = {};
  NodeLanes node;
  tiles_.ends(x, y, node);
  Lanes height = z - node[ground_channel];
  const auto buried = height < -below_ground || height > 1.0e6F;
  height = height < 0.0F ? Lanes{} : height;
  height = buried ? Lanes{} + 1.0e6F : height;
  Foot foot;
  find_foot(x, y, height, node, foot);
  add_front(foot, height, size, out.gas[0]);
  add_low(foot, height, size, out.gas[1]);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    if (out.gas[kind].any) {
      finish_codes(out.gas[kind]);
    }
  }
  if (!crowns_.empty()) {
    add_crowns(x, y, z, size, out.gas[2]);
  }
}

/// Finds the foot: flames lean where the wind is stronger than in the solved fire.
FIRETWIN_CLONES("avx2")
void FlameField::find_foot(const Lanes& x, const Lanes& y, const Lanes& height,
                           const NodeLanes& node, Foot& out) const {
  const auto wind_x = static_cast<float>(shape_.wind[0]),
             wind_y = static_cast<float>(shape_.wind[1]);
  const auto launch = static_cast<float>(shape_.launch),
             lift = static_cast<float>(shape_.acceleration);
  const Lanes east = node[east_channel], north = node[north_channel];
  Lanes across = wind_x * east + wind_y * north, speed, flight;
  across = across < 0.0F ? Lanes{} : across;
  Lanes scale = node[scale_channel];
  scale = scale < shortest ? Lanes{} + shortest : scale;
  roots(g * scale, speed);
  const Lanes froude = across / speed;
  const auto lines = library_.lines();
  out.shares = {};
  out.shares[0] += 1.0F;
  Lanes held{};
  for (std::size_t kind = 0; kind + 1 < lines.size(); ++kind) {
    const float low = lines[kind].front()->scale().wind,
                high = lines[kind + 1].front()->scale().wind;
    Lanes part;
    smooth_lanes((froude - low) * (1.0F / (high - low)), FlameLibrary::change[0],
                 FlameLibrary::change[1], part);
    out.shares[kind + 1] = out.shares[kind] * part;
    out.shares[kind] -= out.shares[kind + 1];
    held += out.shares[kind] * low;
    if (kind + 2 == lines.size()) {
      held += out.shares[kind + 1] * high;
    }
  }
  held *= speed;
  held = held > across ? across : held;
  const Lanes tall = height > 1.0e4F ? Lanes{} : height;
  roots(launch * launch + 2.0F * lift * tall, flight);
  flight = (flight - launch) * (lean / lift);
  out.x = x - (wind_x - held * east) * flight;
  out.y = y - (wind_y - held * north) * flight;
  tiles_.nodes(out.x, out.y, out.node);
  Lanes norm;
  roots(east * east + north * north + 1.0e-12F, norm);
  out.along = {-north / norm, east / norm};
}

FIRETWIN_CLONES("avx2")
void FlameField::add_front(const Foot& foot, const Lanes& height, float size, GasLanes& out) const {
  // Tongues differ in height alone: patterns that shrank across and along too would be combed.
  const Lanes length = foot.node[length_channel], scale = foot.node[scale_channel];
  Lanes drawn, wide;
  drawn_lengths(length, size, drawn);
  drawn_lengths(scale, size, wide);
  const Lanes away = foot.node[distance_channel] / wide, up = height / drawn;
  const Lanes seen = (length > shortest && up < library_.top() && away < library_.behind() &&
                      away > -library_.ahead())
                         ? Lanes{} + 1.0F
                         : Lanes{};
  if (greatest(seen) <= 0.0F) {
    return;
  }
  out.lowest = lowest(drawn, seen);
  out.length = scale;
  out.drawn = wide;
  out.height = up;
  out.share = foot.node[share_channel];
  const float cell = library_.lines()[0].front()->scale().cell;
  const BlockLevels levels(size, cell * greatest(drawn * seen));
  out.fine += levels.fine();
  for (std::size_t kind = 0; kind < library_.lines().size(); ++kind) {
    const Lanes burning = seen * foot.shares[kind];
    const Line line{foot, away, up, levels, kind, 0};
    for (const Octave& octave : Octaves(wide, burning)) {
      add_line(line, octave, out);
    }
  }
}

/// Rows of low flames, which bend with noise.
FIRETWIN_CLONES("avx2")
void FlameField::add_low(const Foot& foot, const Lanes& height, float size, GasLanes& out) const {
  const Lanes length = foot.node[low_channel];
  Lanes drawn;
  drawn_lengths(length, size, drawn);
  const Lanes up = height / drawn;
  const FlameBlock& block = *library_.lines()[0].front();
  const Lanes seen = (length > shortest && up < block.top()) ? Lanes{} + 1.0F : Lanes{};
  if (greatest(seen) <= 0.0F) {
    return;
  }
  out.lowest = lowest(drawn, seen);
  out.length = length;
  out.drawn = drawn;
  out.height = up;
  out.share = Lanes{} + 1.0F;
  const BlockLevels levels(size, block.scale().cell * greatest(drawn * seen));
  out.fine += levels.fine();
  for (const Octave& octave : Octaves(row_length * drawn, seen)) {
    add_rows(foot, octave, up, levels, out);
  }
}

/// Adds the rows of one rounded length.
FIRETWIN_CLONES("avx2")
void FlameField::add_rows(const Foot& foot, const Octave& octave, const Lanes& height,
                          const BlockLevels& levels, GasLanes& out) const {
  const auto scale = std::exp2(static_cast<float>(octave.number));
  Lanes place;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const auto at = [&](std::size_t axis, const Lanes& of) {
      return static_cast<float>((static_cast<double>(of[lane]) + origin_[axis]) /
                                static_cast<double>(scale));
    };
    const float east = at(0, foot.x), north = at(1, foot.y);
    const float bend = wave(warp_waves[0] * east, warp_waves[0] * north, 3) +
                       0.5F * wave(warp_waves[1] * east, warp_waves[1] * north, 4);
    place[lane] = (foot.node[distance_channel][lane] / scale + row_warp * bend) / row_spacing;
  }
  const BlockScale& block = library_.lines()[0].front()->scale();
  const float behind = block.front, ahead = library_.lines()[0].front()->across() - block.front;
  const Lanes low = octave.weight > 0.0F ? place : Lanes{} + 1.0e6F,
              high = octave.weight > 0.0F ? place : Lanes{} - 1.0e6F;
  const auto first = static_cast<std::int64_t>(std::floor(least(low)));
  const auto last = static_cast<std::int64_t>(std::floor(greatest(high))) + 1;
  for (std::int64_t row = first; row <= last; ++row) {
    const Lanes away = (place - static_cast<float>(row)) * row_spacing - row_front;
    const Lanes burning = (away < behind && away > -ahead) ? octave.weight : Lanes{};
    if (greatest(burning) > 0.0F) {
      const Line line{foot, away, height, levels, 0, static_cast<std::uint32_t>(row) * 7U + 11U};
      add_line(line, {octave.number, burning}, out);
    }
  }
}

/// Adds flames along a line, in the directions that are nearest to the front's.
FIRETWIN_CLONES("avx2")
void FlameField::add_line(const Line& line, const Octave& octave, GasLanes& out) const {
  out.any = true;
  std::array<Lanes, directions> turns;
  Lanes total = Lanes{} + 1.0e-6F;
  for (std::size_t n = 0; n < directions; ++n) {
    Lanes cosine = line.foot.along[0] * axes[n][0] + line.foot.along[1] * axes[n][1];
    cosine = cosine < 0.0F ? -cosine : cosine;
    smooth_lanes(cosine, turned[0], turned[1], turns[n]);
    total += turns[n];
  }
  for (int direction = 0; direction < directions; ++direction) {
    const Lanes weight = octave.weight * turns[static_cast<std::size_t>(direction)] / total;
    if (greatest(weight) > 0.0F) {
      add_segments(line, octave.number, direction, weight, out);
    }
  }
}

FIRETWIN_CLONES("avx2")
void FlameField::add_segments(const Line& line, int octave, int direction, const Lanes& weight,
                              GasLanes& out) const {
  // A segment with the end of the one before is as long as the block: nothing repeats in it.
  const FlameBlock& block = *library_.lines()[line.kind].front();
  const float segment_length = block.along() / (2.0F - overlap);
  const double scale = static_cast<double>(segment_length) * std::exp2(octave);
  const auto [east, north] = axes[static_cast<std::size_t>(direction)];
  // Segments of neighbouring rows are not side by side.
  const double aside = line.salt != 0 ? unit(murmur_finalizer(line.salt)) : 0.0;
  const double start =
      aside +
      (static_cast<double>(east) * origin_[0] + static_cast<double>(north) * origin_[1]) / scale;
  const auto inverse = static_cast<float>(1.0 / scale);
  const Lanes place = (line.foot.x * east + line.foot.y * north) * inverse +
                      static_cast<float>(start - std::floor(start));
  const Lanes low = weight > 0.0F ? place : Lanes{} + 1.0e9F,
              high = weight > 0.0F ? place : Lanes{} - 1.0e9F;
  const auto first = static_cast<std::int64_t>(std::floor(least(low)));
  const auto last = static_cast<std::int64_t>(std::floor(greatest(high) + 1.0F - overlap));
  for (std::int64_t number = first; number <= last; ++number) {
    // 0 to 1 within the segment; it fades in over the end of the one before.
    const Lanes at = place - static_cast<float>(number);
    Lanes in, gone;
    smooth_lanes(at, overlap - 1.0F, 0.0F, in);
    smooth_lanes(at, overlap, 1.0F, gone);
    const Lanes part = weight * in * (1.0F - gone);
    if (greatest(part) > 0.0F) {
      add_segment({line, octave, direction, number + static_cast<std::int64_t>(std::floor(start)),
                   at * segment_length, part},
                  out);
    }
  }
}

void FlameField::add_segment(const Segment& segment, GasLanes& out) const {
  const Line& line = segment.line;
  const auto salt = line.salt * 64U + static_cast<std::uint32_t>(segment.direction) * 16U +
                    static_cast<std::uint32_t>(line.kind);
  const std::uint32_t hash = lattice_hash(segment.number, segment.octave, salt);
  if (line.salt != 0 && unit(murmur_finalizer(hash + 3U)) > burning_rows) {
    return;
  }
  const auto& kind = library_.lines()[line.kind];
  const FlameBlock& block = *kind[hash % kind.size()];
  const double first = unit(murmur_finalizer(hash + 1U));
  const auto length = std::exp2(static_cast<float>(segment.octave));
  // Neighbours are far apart in time.
  const double phase = spread(unit(lattice_hash(segment.octave, salt, 1)), segment.number);
  const Moment now = moment(block, time_, length, phase);
  Lanes across = line.across;
  bend_edge(segment.along, hash, across);
  each_loop(block, now, [&](std::int64_t loop, float time, float share) {
    const auto offset = static_cast<float>(spread(first, loop)) * block.along();
    const bool mirrored = ((loop + static_cast<std::int64_t>(hash >> 6U)) & 1) != 0;
    const BlockPlaces places{block.scale().front - across,
                             offset + (mirrored ? -segment.along : segment.along), line.height};
    add_block(block, places, time, line.levels, segment.weight * share, out);
  });
}

/// Adds crowns; where they overlap, the one with more gas counts.
FIRETWIN_CLONES("avx2")
void FlameField::add_crowns(const Lanes& x, const Lanes& y, const Lanes& z, float size,
                            GasLanes& out) const {
  std::array<std::uint32_t, 64> numbers;
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (const std::uint32_t number : crowns_.at(x[lane], y[lane])) {
      const auto end = numbers.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(numbers.begin(), end, number) == end && count < numbers.size()) {
        numbers[count++] = number;
      }
    }
  }
  for (std::size_t n = 0; n < count; ++n) {
    const Spindle& crown = crowns_.all()[numbers[n]];
    const std::uint32_t hash = crowns_.hash(numbers[n]);
    const FlameBlock& block = *library_.crowns()[hash % library_.crowns().size()];
    const Lanes rise = z - crown.z, up = rise / crown.top;
    if (least(up) > block.top() || greatest(up) < 0.0F) {
      continue;
    }
    Lanes away;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      away[lane] =
          FlameCrowns::lean * shape_.flight_to(rise[lane] - FlameCrowns::upright * crown.top);
    }
    const float wide = 1.0F / FlameCrowns::size(crown);
    const Lanes dx = (x - crown.x - static_cast<float>(shape_.wind[0]) * away) * wide,
                dy = (y - crown.y - static_cast<float>(shape_.wind[1]) * away) * wide;
    const BlockLevels levels(size, block.scale().cell * crown.top);
    const float octave = std::log2(crown.top), low = std::floor(octave);
    const float part = smoothstep(octave_blend[0], octave_blend[1], octave - low);
    GasLanes own;
    for (int next = 0; next < 2; ++next) {
      const float weight = next == 0 ? 1.0F - part : part;
      if (weight > 0.0F) {
        const float length = std::exp2(low + static_cast<float>(next));
        const Moment now = moment(block, time_, length, unit(murmur_finalizer(hash + 2U)));
        each_loop(block, now, [&](std::int64_t loop, float time, float share) {
          const auto turn = static_cast<float>(2.0 * std::numbers::pi *
                                               spread(unit(murmur_finalizer(hash + 1U)), loop));
          const float cosine = std::cos(turn), sine = std::sin(turn);
          const BlockPlaces places{block.scale().front + dx * cosine + dy * sine,
                                   0.5F * block.along() + dy * cosine - dx * sine, up};
          add_block(block, places, time, levels, Lanes{} + weight * share, own);
        });
      }
    }
    finish_codes(own);
    const Lanes fine = Lanes{} + levels.fine();
    const Lanes mine = own.code * fine + own.coarse.extinction,
                best = out.code * out.fine + out.coarse.extinction;
    const auto more = up >= 0.0F && mine > crown_blend && mine > best;
    out.code = more ? own.code : out.code;
    out.fine = more ? fine : out.fine;
    out.coarse.extinction = more ? own.coarse.extinction : out.coarse.extinction;
    out.coarse.hot = more ? own.coarse.hot : out.coarse.hot;
    out.height = more ? up : out.height;
    out.length = more ? Lanes{} + crown.top : out.length;
    out.drawn = out.length;
    out.share = Lanes{} + 1.0F;
    out.lowest = std::min(out.lowest, crown.top);
    out.any = out.any || greatest(mine) > crown_blend;
  }
}

} // namespace firetwin::flames
