#include "fuel.hpp"

#include "noise.hpp"

namespace flame_solver {
namespace {

// Sizes of patches of fuel and of the edge's bends in units, and how fast they change (by eye).
constexpr float patch = 0.22F, patch_rate = 0.35F, small_patch = 0.09F, small_rate = 0.8F;
constexpr float group = 0.6F, group_rate = 0.25F; ///< peaks and troughs along the line
constexpr float bend = 0.45F, small_bend = 0.15F;
constexpr float bend_shift = 0.07F, small_shift = 0.03F;
constexpr float edge_gain = 1.25F, edge_decay = 1.1F; ///< rate falls behind the leading edge
constexpr float rim_width = 0.04F; ///< over which the strip's strength rises from its rims
constexpr float burned_bed = 0.5F, bed_reach = 4.0F;
constexpr float clump = 0.075F, twig = 0.03F, flare_rate = 1.2F; ///< crown (by eye)

/// Noise along a line of length `along` with features of about `size`, fitted to the period.
struct Along {
  float scale;
  int period;
  Along(float along, float size)
      : scale(std::max(1.0F, std::round(along / size)) / along),
        period(std::max(1, static_cast<int>(std::lround(along / size)))) {}
};

/// Shift (units) of the leading edge at each y.
std::vector<float> edge_shift(const Settings& s, float time) {
  const float along = static_cast<float>(s.ny) / static_cast<float>(s.cells);
  const Along large(along, bend), small(along, small_bend);
  std::vector<float> shift;
  for (int j = 0; j < s.ny; ++j) {
    const float y = (static_cast<float>(j) + 0.5F) / static_cast<float>(s.cells);
    shift.push_back(bend_shift * noise(time * patch_rate, y * large.scale, 0.5F, large.period,
                                       noise_seed(s, 1)) +
                    small_shift * noise(time * small_rate, y * small.scale, 0.5F, small.period,
                                        noise_seed(s, 2)));
  }
  return shift;
}

/// Strength of fuel in patches, 1 in the mean.
float patches(const Settings& s, float x, float y, float time) {
  const float along = static_cast<float>(s.ny) / static_cast<float>(s.cells);
  const Along large(along, patch), small(along, small_patch), groups(along, group);
  const float sum =
      noise(x / patch, y * large.scale, time * patch_rate, large.period, noise_seed(s, 3)) +
      0.9F * noise(x / small_patch, y * small.scale, time * small_rate, small.period,
                   noise_seed(s, 4));
  const float peaks =
      noise(0.5F, y * groups.scale, time * group_rate, groups.period, noise_seed(s, 5));
  return std::max(0.0F, 1.0F + s.uneven * (sum + 0.7F * peaks));
}

/// Speed (nx, ny, 1) at which fuel gas leaves the ground.
Grid fuel_speed(const Settings& s, float time) {
  Grid speed(s.nx, s.ny, 1);
  const float cell = 1.0F / static_cast<float>(s.cells);
  const std::vector<float> shift = edge_shift(s, time);
  for_each(speed, [&](int i, int j, int k) {
    const float x =
        (static_cast<float>(i) + 0.5F) * cell - s.front - shift[static_cast<std::size_t>(j)];
    if (x >= 0.0F || x <= -s.depth) {
      return;
    }
    const float y = (static_cast<float>(j) + 0.5F) * cell;
    const float rim = std::min(1.0F, std::min(-x, x + s.depth) / rim_width);
    speed(i, j, k) =
        s.inflow * edge_gain * std::exp(edge_decay * x / s.depth) * rim * patches(s, x, y, time);
  });
  return speed;
}

/// Density of a crown's foliage at a place relative to the foot of its trunk.
float crown_density(const Settings& s, float x, float y, float z) {
  constexpr int unbounded = 1 << 12;
  const float up = (z - s.crown_base) / (s.crown_top - s.crown_base);
  if (up <= 0.0F || up >= 1.0F) {
    return 0.0F;
  }
  const float radius = s.crown_radius * std::pow(1.0F - up, 0.7F) * std::min(1.0F, up / 0.12F);
  const float away = std::sqrt(x * x + y * y) / radius;
  const float dense =
      0.35F + 2.0F * noise(x / clump, y / clump + 40.0F, z / clump, unbounded, noise_seed(s, 6)) +
      0.8F * noise(x / twig, y / twig + 90.0F, z / twig, unbounded, noise_seed(s, 7));
  return away < 1.0F ? std::clamp(dense, 0.0F, 1.0F) * (0.35F + 0.65F * away) : 0.0F;
}

} // namespace

Grid fuel_density(const Settings& s) {
  Grid density(s.nx, s.ny, s.nz);
  const float cell = 1.0F / static_cast<float>(s.cells);
  const float middle = 0.5F * static_cast<float>(s.ny) * cell;
  for_each(density, [&](int i, int j, int k) {
    const float x = (static_cast<float>(i) + 0.5F) * cell - s.front;
    const float y = (static_cast<float>(j) + 0.5F) * cell - middle;
    const float z = (static_cast<float>(k) + 0.5F) * cell;
    density(i, j, k) = s.crown != 0
                           ? crown_density(s, x, y, z)
                           : std::exp(-z / bed_height) * (x < -s.depth ? burned_bed : 1.0F);
  });
  return density;
}

void add_line_fuel(Grid& mixture, const Settings& s, float time, float duration) {
  const float cell = 1.0F / static_cast<float>(s.cells);
  const Grid speed = fuel_speed(s, time);
  const float first = 1.0F - std::exp(-cell / bed_height); // so that the levels sum to 1
  const int levels = std::min(s.nz, static_cast<int>(bed_reach * bed_height / cell) + 1);
  for (int k = 0; k < levels; ++k) {
    const float part = first * std::exp(-static_cast<float>(k) * cell / bed_height);
    for_each(speed, [&](int i, int j, int) {
      const float share = std::min(1.0F, speed(i, j, 0) * part * duration / cell);
      mixture(i, j, k) += (fuel_mixture - mixture(i, j, k)) * share;
    });
  }
}

void add_crown_fuel(Grid& mixture, const Grid& density, const Settings& s, float time,
                    float duration) {
  const float cell = 1.0F / static_cast<float>(s.cells);
  constexpr int unbounded = 1 << 12;
  for_each(density, [&](int i, int j, int k) {
    if (density(i, j, k) <= 0.0F) {
      return;
    }
    const float scale = cell / clump;
    const float flare =
        noise(static_cast<float>(i) * scale, static_cast<float>(j) * scale,
              static_cast<float>(k) * scale + time * flare_rate, unbounded, noise_seed(s, 8));
    const float rate = s.inflow * density(i, j, k) * std::max(0.0F, 1.0F + 1.6F * flare);
    mixture(i, j, k) += (fuel_mixture - mixture(i, j, k)) * std::min(1.0F, rate * duration);
  });
}

} // namespace flame_solver
