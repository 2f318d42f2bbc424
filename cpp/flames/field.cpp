#include "flames/field.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firetwin::flames {
namespace {

constexpr double largest_eddy = 10.0;  // m, size of the largest eddies
constexpr double octave_ratio = 2.07;  // of sizes of octaves
constexpr float octave_weight = 0.56F; // octave_ratio of their strengths
constexpr float fold_weight = 0.8F;    // and of the folds of bright sheets
constexpr float octave_warp = 0.35F;   // displacement of an octave by the previous one, cells
constexpr float first_band =
    0.25F; // m, height of the first band; each is twice as high as the last
constexpr float crown_eddies = 2.2F; // radii of a crown that correspond to a flame's length
constexpr float reach = 4.0F;        // m by which eddies move flames up
constexpr float folds = 1.0F;        // thinness of the bright sheets within flames
constexpr float sheets = 0.97F;      // share of the soot in them
constexpr float patches = 0.4F;      // strength of hotter and cooler patches
constexpr float slow = 2.0F;         // m, height below which gas may be as slow as at the ground
constexpr double octave_turn = 2.4;  // radians between the lattices of octaves
constexpr double drawn_out = 1.3;    // height over width of eddies
constexpr std::array<double, FlameField::sways> sway_sizes{7.5, 2.4, 0.8}; // m
constexpr std::array<double, 2> fuel_sizes{2.6, 0.8};                      // m, gaps of fuel

__attribute__((always_inline)) inline void clamp_lanes(const Lanes& value, float low, float high,
                                                       Lanes& out) {
  const Lanes a = Lanes{} + low, b = Lanes{} + high;
  out = value < a ? a : value;
  out = out > b ? b : out;
}

/// 0 at `low`, 1 at `high`, smooth between.
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
  float found = value[0];
  for (std::size_t lane = 1; lane < lane_count; ++lane) {
    found = std::max(found, value[lane]);
  }
  return found;
}

} // namespace

FlameField::FlameField(const FlameTiles& tiles, const FlameShape& shape, const Vector& origin,
                       double time)
    : tiles_(tiles), shape_(shape) {
  double size = largest_eddy;
  for (std::size_t n = 0; n < octaves; ++n, size /= octave_ratio) {
    const auto seed = static_cast<std::uint32_t>(n);
    detail_[n] =
        make_octave(size, octave_turn * static_cast<double>(n), seed, origin, time, drawn_out);
  }
  for (std::size_t n = 0; n < 2 * sways; ++n) {
    const auto seed = static_cast<std::uint32_t>(100 + n);
    sway_[n] = make_octave(sway_sizes[n / 2], octave_turn * static_cast<double>(n), seed, origin,
                           time, 2.0);
  }
  for (std::size_t n = 0; n < fuel_.size(); ++n) {
    fuel_[n] = make_octave(fuel_sizes[n], octave_turn * static_cast<double>(n),
                           static_cast<std::uint32_t>(200 + n), origin, 0.0, 1.0);
  }
}

float FlameField::rise_speed(double height) const {
  return static_cast<float>(
      std::sqrt(shape_.launch * shape_.launch + 2.0 * shape_.acceleration * height));
}

FlameField::Octave FlameField::make_octave(double size, double angle, std::uint32_t seed,
                                           const Vector& origin, double time,
                                           double stretch) const {
  Octave made{};
  made.size = static_cast<float>(size);
  const double cosine = std::cos(angle) / size, sine = std::sin(angle) / size;
  made.cosine = static_cast<float>(cosine);
  made.sine = static_cast<float>(sine);
  const double east = origin[0] - shape_.wind[0] * time, north = origin[1] - shape_.wind[1] * time;
  split_coordinate(cosine * east + sine * north, made.origin.cell[0], made.origin.part[0]);
  split_coordinate(cosine * north - sine * east, made.origin.cell[1], made.origin.part[1]);
  made.origin.cell[0] += seed * 0x9e3779b9U;
  for (std::size_t band = 0; band < bands; ++band) {
    const double height =
        std::max(static_cast<double>(first_band) * static_cast<double>(1U << band), 0.4 * size);
    const double rate = static_cast<double>(rise_speed(height)) / (size * stretch);
    made.rate[band] = static_cast<float>(rate);
    split_coordinate(-time * rate, made.cell[band], made.part[band]);
    made.cell[band] += static_cast<std::uint32_t>(band) * 0x85ebca6bU;
  }
  return made;
}

float FlameField::flight_to(float height) const {
  const auto launch = static_cast<float>(shape_.launch),
             lift = static_cast<float>(shape_.acceleration);
  return (std::sqrt(launch * launch + 2.0F * lift * std::max(height, 0.0F)) - launch) / lift;
}

/// Replaces flames of the ground by flames of crowns that reach higher over these points.
///
/// Flames climb the trunk, surround the crown as wide as it is, and narrow to tongues above it,
/// where they lean.
void FlameField::add_crowns(const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& moved_x,
                            const Lanes& moved_y, FlameShares& shares) const {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (const std::uint32_t number : tiles_.spindles_at(x[lane], y[lane])) {
      const Spindle& crown = tiles_.spindles()[number];
      const float up = (z[lane] - crown.z) / crown.top;
      if (up < -0.1F || up > FlameTiles::crown_top) {
        continue;
      }
      const float away =
          FlameTiles::lean * flight_to(z[lane] - crown.z - FlameTiles::upright * crown.top);
      const auto wind_x = static_cast<float>(shape_.wind[0]),
                 wind_y = static_cast<float>(shape_.wind[1]);
      const float dx = x[lane] - wind_x * away + moved_x[lane] - crown.x,
                  dy = y[lane] - wind_y * away + moved_y[lane] - crown.y;
      const float square = dx * dx + dy * dy, widest = FlameTiles::crown_wide * crown.radius;
      if (square > widest * widest) {
        continue;
      }
      const float branches = crown.base / crown.top;
      const float climb = std::clamp(up / std::max(branches, 0.01F), 0.0F, 1.0F);
      const float narrow = std::clamp((up - branches) / (1.0F - branches), 0.0F, 1.0F);
      const float wide = crown.radius * (up < branches ? 0.45F + 0.65F * climb * climb
                                                       : 1.15F - 0.5F * narrow * narrow);
      const float round = square / (wide * wide), tip = std::max(up - 0.6F, 0.0F);
      const float share = 0.9F * round + 0.25F * std::max(up, 0.0F) + 2.4F * tip * tip;
      if (share < shares.share[lane]) {
        shares.share[lane] = share;
        shares.length[lane] = std::max(shares.length[lane], crown.top);
        shares.eddy[lane] = crown_eddies * crown.radius;
        shares.hollow[lane] = 0.3F + 0.7F * std::clamp(1.6F * round + 2.0F * tip, 0.0F, 1.0F);
      }
    }
  }
}

float FlameField::free_distance(const std::array<float, 3>& place,
                                const std::array<float, 3>& direction) const {
  const auto [x, y, z] = place;
  const float across = std::hypot(direction[0], direction[1]), along = std::abs(direction[2]);
  const auto wind_x = static_cast<float>(shape_.wind[0]),
             wind_y = static_cast<float>(shape_.wind[1]);
  const auto launch = static_cast<float>(shape_.launch),
             lift = static_cast<float>(shape_.acceleration);
  const float ground = tiles_.ground_at(x, y);
  const float height = std::clamp(z - ground, 0.0F, 1.0e6F);
  // The foot moves no faster than this within half the height.
  const float least = height > slow ? std::sqrt(launch * launch + lift * height) : launch;
  const float speed = across + std::hypot(wind_x, wind_y) / least * (along + 0.5F * across);
  const float away = flight_to(height);
  const auto [longest, edge] = tiles_.rooted(x - wind_x * away, y - wind_y * away);
  float free = edge / std::max(speed, 0.01F);
  if (longest > 0.0F) {
    const float over = height - FlameTiles::soot_top * longest - std::min(reach, 0.5F * longest);
    free =
        over > 0.0F ? std::min(free, 0.5F * over / std::max(along + 0.5F * across, 0.01F)) : 0.0F;
  } else if (height > slow) {
    free = std::min(free, 0.5F * height / std::max(along + 0.5F * across, 0.01F));
  }
  return free > 0.0F ? std::min(free, tiles_.spindle_distance(x, y, z, across)) : 0.0F;
}

FIRETWIN_CLONES("avx2")
void FlameField::evaluate(const Lanes& x, const Lanes& y, const Lanes& z, float fine,
                          FlameSamples& out) const {
  const auto launch = static_cast<float>(shape_.launch),
             lift = static_cast<float>(shape_.acceleration);
  const auto wind_x = static_cast<float>(shape_.wind[0]),
             wind_y = static_cast<float>(shape_.wind[1]);
  Lanes ground;
  tiles_.ground(x, y, ground);
  Lanes height = z - ground;
  const auto buried = height < -below_ground;
  height = height > 1.0e6F ? Lanes{} + 1.0e6F : height;
  height = height < 0.0F ? Lanes{} : height;
  Lanes speed, flight;
  roots(launch * launch + 2.0F * lift * height, speed);
  flight = (speed - launch) * (1.0F / lift);
  Lanes foot_x = x - wind_x * flight, foot_y = y - wind_y * flight;

  // Eddies: displacement by the curl of noise, so that edges roll up.
  const auto noise_at = [&](const Octave& octave, const Lanes& px, const Lanes& py,
                            const Lanes& upward, const LaneHash& cell, Lanes& value,
                            Lanes* slope) __attribute__((always_inline)) {
    lattice_noise(octave.cosine * px + octave.sine * py + octave.origin.part[0],
                  octave.cosine * py - octave.sine * px + octave.origin.part[1], upward, cell,
                  octave.origin.cell[0], octave.origin.cell[1], value, slope);
  };
  Lanes risen = height, moved_x{}, moved_y{};
  for (std::size_t n = 0; n < sways; ++n) {
    const float size = sway_[2 * n].size;
    if (size < 2.0F * fine) {
      break;
    }
    Lanes strength;
    clamp_lanes(height * (1.2F / size), 0.06F, 1.0F, strength);
    strength *= shape_.roll * size;
    std::array<std::array<Lanes, 3>, 2> slope;
    for (std::size_t k = 0; k < 2; ++k) {
      const Octave& octave = sway_[2 * n + k];
      Lanes value, turned[3];
      noise_at(octave, x + moved_x, y + moved_y, flight * octave.rate[0] + octave.part[0],
               LaneHash{} + octave.cell[0], value, turned);
      slope[k][0] = (octave.cosine * turned[0] - octave.sine * turned[1]) * size;
      slope[k][1] = (octave.sine * turned[0] + octave.cosine * turned[1]) * size;
      slope[k][2] = turned[2];
    }
    moved_x -= strength * slope[0][2];
    moved_y -= strength * slope[1][2];
    risen += strength * (slope[0][0] + slope[1][1]);
  }
  foot_x += moved_x;
  foot_y += moved_y;
  risen = risen < 0.0F ? Lanes{} : risen;
  roots(launch * launch + 2.0F * lift * risen, speed);
  flight = (speed - launch) * (1.0F / lift);

  FlameShares shares;
  auto& [share, length, eddy, hollow] = shares;
  tiles_.length(foot_x, foot_y, length);
  share = length > 0.05F ? risen / length : Lanes{} + 9.0F;
  eddy = length;
  hollow = Lanes{} + 1.0F;
  if (!tiles_.spindles().empty()) {
    add_crowns(x, y, z, moved_x, moved_y, shares);
  }
  share = buried ? Lanes{} + 9.0F : share;
  out.length = length;
  bool any = false;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    any = any || share[lane] < FlameTiles::soot_top;
  }
  if (!any) {
    out.flame = out.heat = out.soot = Lanes{};
    return;
  }

  // Bands of height, so that detail keeps its proportions as the gas speeds up.
  // The exponent of a height and the rest of its bits are near its logarithm to base 2.
  Lanes relative;
  clamp_lanes(risen * (1.0F / first_band), 1.0F, static_cast<float>(1U << (bands - 2)), relative);
  const LaneIndex bits = (LaneIndex)relative;
  const LaneIndex band = (bits >> 23) - 127;
  const Lanes rest = __builtin_convertvector(bits & 0x7fffff, Lanes) * (1.0F / 8388608.0F);
  std::array<Lanes, 2> part;
  Lanes norm;
  roots(rest * rest + (1.0F - rest) * (1.0F - rest), norm);
  part[0] = (1.0F - rest) / norm;
  part[1] = rest / norm;
  bool even = true;
  for (std::size_t lane = 1; lane < lane_count; ++lane) {
    even = even && band[lane] == band[0];
  }
  const float tallest = greatest(eddy), smallest = std::max(fine, 0.008F * tallest);
  Lanes sum{}, patch{}, total = Lanes{} + 1.0e-6F, last{}, grain{}, grains = Lanes{} + 1.0e-6F;
  float amplitude = 1.0F;
  float folds_weight = 1.0F; // finer folds are nearly as strong
  for (std::size_t n = 0; n < octaves;
       ++n, amplitude *= octave_weight, folds_weight *= fold_weight) {
    const Octave& octave = detail_[n];
    if (octave.size > 1.3F * tallest) {
      continue;
    }
    if (octave.size < smallest) {
      break;
    }
    Lanes weight; // eddies are smaller than the flame
    clamp_lanes(1.6F - octave.size / (eddy + 1.0e-6F) * 1.6F, 0.0F, 1.0F, weight);
    weight *= amplitude;
    Lanes found{};
    for (std::size_t k = 0; k < 2; ++k) {
      Lanes rate, present;
      LaneHash cell;
      if (even) {
        const auto number = static_cast<std::size_t>(band[0]) + k;
        rate = Lanes{} + octave.rate[number];
        present = Lanes{} + octave.part[number];
        cell = LaneHash{} + octave.cell[number];
      } else {
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          const auto number = static_cast<std::size_t>(band[lane]) + k;
          rate[lane] = octave.rate[number];
          present[lane] = octave.part[number];
          cell[lane] = octave.cell[number];
        }
      }
      Lanes value;
      noise_at(octave, x + moved_x + (octave_warp * octave.size) * last,
               y + moved_y + (octave_warp * octave.size) * last, flight * rate + present, cell,
               value, nullptr);
      found += part[k] * value;
    }
    last = found;
    sum += weight * found;
    total += weight;
    patch += (n % 2 == 0 ? -1.0F : 1.0F) * weight * found; // independent of the sum
    Lanes small;
    clamp_lanes(1.5F - octave.size / (eddy + 1.0e-6F) * 3.0F, 0.0F, 1.0F, small);
    grain += small * folds_weight * found;
    grains += small * small * (folds_weight * folds_weight);
  }
  const Lanes noise = sum / total * 1.7F;

  Lanes gaps{};
  if (shape_.broken > 0.0F) {
    for (const Octave& octave : fuel_) {
      Lanes value;
      noise_at(octave, foot_x, foot_y, Lanes{}, LaneHash{} + octave.cell[0], value, nullptr);
      gaps += value;
    }
  }
  Lanes rooted, full, top, base, cool;
  clamp_lanes(1.0F - share * 2.5F, 0.0F, 1.0F, rooted);
  clamp_lanes(share * 1.6F, 0.0F, 1.0F, full);
  clamp_lanes(share, 0.0F, 1.4F, cool);
  Lanes value = shape_.fill - shape_.taper * share * (0.45F + 0.5F * share) +
                shape_.ragged * noise * (0.45F + 0.55F * full) + shape_.broken * gaps * rooted;
  smooth_lanes(length, 0.5F, 0.0F, base);
  value -= 0.5F * base;
  smooth_lanes(value, 0.0F, shape_.edge, out.flame);
  smooth_lanes(share, 1.5F, 1.0F, top);
  // Soot glows in thin folded sheets, with dark gas between them.
  Lanes sheet, core;
  roots(grains, sheet);
  sheet = grain / sheet;
  sheet = sheet < 0.0F ? -sheet : sheet;
  clamp_lanes(1.0F - sheet * folds, 0.0F, 1.0F, sheet);
  sheet *= sheet;
  // Folds that are too small to be drawn: mean extinction, and light of the hottest and of all
  // heights.
  const Lanes bright = grains > 0.01F ? sheet : Lanes{} + 1.1F;
  sheet = grains > 0.01F ? sheet : Lanes{} + 0.4F;
  clamp_lanes(value, 0.0F, 1.2F, core);
  // Hot where fuel gas burns, at the foot and in patches; cool where soot has radiated its heat.
  patch *= 1.7F / total;
  out.flame *= top * hollow * (1.0F - sheets + 1.4F * sheets * sheet) * (1.0F - 0.1F * cool);
  clamp_lanes((0.05F + 0.5F * core) * (0.25F + bright) * (1.0F - 0.4F * cool) *
                      (1.0F + 0.35F * gaps * rooted) +
                  patches * patch + 0.15F * rooted,
              0.0F, 1.0F, out.heat);
  out.heat = grains > 0.01F ? out.heat : 0.5F + 0.25F * (out.heat - 0.5F);
  Lanes begin, end, thick;
  smooth_lanes(share, 0.55F, 1.3F, begin);
  smooth_lanes(share, FlameTiles::soot_top, 1.4F, end);
  smooth_lanes(value + patches * patch, -0.5F, -0.05F, thick);
  clamp_lanes(1.0F - out.flame, 0.0F, 1.0F, out.soot);
  out.soot *= begin * end * thick;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (!(share[lane] < FlameTiles::soot_top)) {
      out.flame[lane] = out.heat[lane] = out.soot[lane] = 0.0F;
    }
  }
}

} // namespace firetwin::flames
