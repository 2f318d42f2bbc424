#pragma once

#include "base/vector.hpp"
#include "flames/lattice_noise.hpp"
#include "flames/tiles.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace firetwin::flames {

/// Constants of the shape of flames.
struct FlameShape {
  std::array<double, 2> wind{}; ///< speed at which rising gas is carried, m/s east and north
  double launch = 1.5;          ///< speed of rise at the ground, m/s
  double acceleration = 7.0;    ///< of rising gas, m/s2
  float fill = 0.85F;           ///< value at the foot of a flame without noise; it burns above 0
  float taper = 0.95F;          ///< decrease of the value over a flame's length
  float ragged = 3.3F;          ///< strength of the noise
  float edge = 0.22F;           ///< values from 0 over which a flame becomes opaque
  float roll = 0.25F;           ///< displacement by eddies relative to their size
  float broken = 0.6F;          ///< strength of gaps at the foot where fuel is gone
};

/// Flames at eight points.
struct FlameSamples {
  Lanes flame;  ///< extinction over a flame's mean, 0 to 1.4
  Lanes heat;   ///< 0 at the coolest to 1 at the hottest part
  Lanes soot;   ///< share of the extinction of cooled soot over the flames, 0 to 1
  Lanes length; ///< flame length there, m
};

/// Places of eight points in the flames around them.
struct FlameShares {
  Lanes share;  ///< height relative to the flame's length; about 1 at the outline
  Lanes length; ///< flame length, m
  Lanes eddy;   ///< size below which eddies are, m
  Lanes hollow; ///< factor on the extinction: flames surround the needles of a crown
};

/// Flames as a function of place and time: a map of flame length, and noise that rises with
/// the gas.
///
/// A parcel of gas leaves the ground with `launch` and accelerates, so noise is sampled at the time
/// at which the gas left the ground. It drifts with the wind: flames lean, but eddies stay round.
/// The octaves below half of a flame's length are sampled in bands of height and blended, because a
/// pattern that rises faster and faster would be drawn out. Soot is in thin folded sheets within a
/// flame. Coordinates are relative to `origin`. Nothing depends on other times or on the camera.
class FlameField {
public:
  static constexpr std::size_t octaves = 9, bands = 9, sways = 3;
  static constexpr float below_ground =
      2.0F; ///< m below the map's ground, where drawn ground may be lower

  FlameField(const FlameTiles& tiles, const FlameShape& shape, const Vector& origin, double time);

  /// Evaluates eight points, relative to the origin, m; `fine` is the size of a pixel there, m.
  void evaluate(const Lanes& x, const Lanes& y, const Lanes& z, float fine,
                FlameSamples& out) const;

  /// Returns a distance (m) from a place in a direction within which nothing burns; 0 near flames.
  float free_distance(const std::array<float, 3>& place,
                      const std::array<float, 3>& direction) const;

private:
  /// Noise of one size: its lattice, turned about the vertical.
  struct Octave {
    float size, cosine, sine;
    LatticeOrigin origin;          ///< z unused
    std::array<float, bands> rate; ///< cells per second of flight in each band
    std::array<float, bands> part; ///< place of the present in its cell
    std::array<std::uint32_t, bands> cell;
  };

  Octave make_octave(double size, double turn, std::uint32_t seed, const Vector& origin,
                     double time, double stretch) const;
  float rise_speed(double height) const;
  float flight_to(float height) const;
  void add_crowns(const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& moved_x,
                  const Lanes& moved_y, FlameShares& shares) const;

  const FlameTiles& tiles_;
  FlameShape shape_;
  std::array<Octave, octaves> detail_;
  std::array<Octave, 2 * sways> sway_;
  std::array<Octave, 2> fuel_;
};

} // namespace firetwin::flames
