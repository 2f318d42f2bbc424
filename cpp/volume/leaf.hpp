#pragma once

#include "puffs.hpp"
#include "smoke.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace firetwin {

constexpr float kInside = 300.0F;  // m of depth at which density reaches 1
constexpr float kOutside = 150.0F; // m outside the balls where voxels end

/// How far the mass of a puff of radius R is spread, m: to the far side of the balls on its surface.
inline float spread(float radius) {
  return 1.5F * radius + 60.0F;
}

/// The fields of one 8^3 leaf, z running fastest. Its lowest voxel is centred on `corner`.
class LeafFields {
public:
  static constexpr std::size_t kSide = 8;
  static constexpr std::size_t kVoxels = kSide * kSide * kSide;
  using Values = std::array<float, kVoxels>;

  LeafFields(const std::array<float, 3>& corner, float voxel_size)
      : corner_(corner), voxel_(voxel_size) {}

  /// Signed distance (m, positive inside) to the balls; false when the leaf lies outside them all.
  bool measure(const Puffs& puffs, std::span<const std::uint32_t> balls);
  /// Smoke in kg/m3 from the puffs with mass.
  void concentrate(const Puffs& puffs, std::span<const std::uint32_t> balls);
  /// Light of the flames, see write_smoke.
  void light(const Flames& flames);

  const Values& distance() const { return distance_; }
  const Values& radius() const { return radius_; }
  const Values& concentration() const { return concentration_; }
  const Values& glow() const { return glow_; }
  /// Height of the voxels of layer z, m.
  float height(std::size_t z) const { return corner_[2] + static_cast<float>(z) * voxel_; }

private:
  // Smooth fields are computed on 3^3 nodes, four voxels apart, that neighbouring leaves share.
  static constexpr std::size_t kNodes = 3;
  using Nodes = std::array<double, kNodes * kNodes * kNodes>;

  std::array<double, 3> node(std::size_t x, std::size_t y, std::size_t z) const;
  template <typename Field> Nodes at_nodes(Field field) const;
  static void interpolate(const Nodes& nodes, Values& values);

  std::array<float, 3> corner_;
  float voxel_;
  Values distance_{};
  Values radius_{};
  Values concentration_{};
  Values glow_{};
};

} // namespace firetwin
