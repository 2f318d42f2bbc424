#include "base/interpolation.hpp"
#include "flow/detail.hpp"
#include "flow/parallel.hpp"

#include <algorithm>

namespace firetwin::flow {

std::shared_ptr<const NoiseFrame> Detail::find_noise(const VoxelRegion& b,
                                                     const std::array<Index, 3>& blocks) const {
  auto found = std::make_shared<NoiseFrame>();
  const DetailNoise painted(settings_.size, b.voxel, seeds_);
  const auto [size, share] = painted.finer_octave();
  found->size = static_cast<float>(size);
  found->share = static_cast<float>(share) / painted.outline();
  found->weights = weights_;
  found->seeds = seeds_;
  found->corners = {blocks[0] + 1, blocks[1] + 1, blocks[2] + 1};
  const auto [nx, ny, nz] = found->corners;
  found->places.resize(static_cast<std::size_t>(nx * ny * nz));
  const Index top = shape_.nz - 1;
  each(nx, [&, ny, nz](Index i) {
    const auto room = static_cast<std::size_t>(whole_lanes(top + 1));
    std::vector<float> height(room), ground(static_cast<std::size_t>(lanes));
    std::array<std::vector<float>, Drift::parts> drift;
    for (Index j = 0; j < ny; ++j) {
      const Index column = std::min(i * SparseSmoke::side, b.shape[0] - 1) * b.shape[1] +
                           std::min(j * SparseSmoke::side, b.shape[1] - 1);
      const double side = static_cast<double>(SparseSmoke::side) * b.voxel;
      const double x = b.origin[0] + static_cast<double>(i) * side;
      const double y = b.origin[1] + static_cast<double>(j) * side;
      const ColumnStencil at(static_cast<float>((x - corner_[0]) / spacing_ - 0.5),
                             static_cast<float>((y - corner_[1]) / spacing_ - 0.5), shape_);
      heights_.linear(at, 0, top, height.data());
      ground_.linear(at, 0, 0, ground.data());
      const float higher = b.surface[static_cast<std::size_t>(column)] - ground[0];
      for (std::size_t part = 0; part < Drift::parts; ++part) {
        drift[part].assign(room, 0.0F);
        if (shows(part / 3)) {
          drift_[part].linear(at, 0, top, drift[part].data());
        }
      }
      std::size_t level = 0;
      for (Index k = 0; k < nz; ++k) {
        const double z = b.origin[2] + static_cast<double>(k) * side;
        const auto here = [&](std::size_t n) { return height[n] + higher * terrain_share_[n]; };
        const auto last = static_cast<std::size_t>(top);
        while (level + 1 < last && here(level + 1) < static_cast<float>(z)) {
          ++level;
        }
        const float way = (static_cast<float>(z) - here(level)) / (here(level + 1) - here(level));
        const float above = lerp(levels_[level], levels_[level + 1], way);
        const float held = std::clamp(way, 0.0F, 1.0F);
        auto& place = found->places[static_cast<std::size_t>((i * ny + j) * nz + k)];
        for (std::size_t part = 0; part < Drift::parts; ++part) {
          const double from = part % 3 == 0 ? x : part % 3 == 1 ? y : static_cast<double>(above);
          const float moved = lerp(drift[part][level], drift[part][level + 1], held);
          place[part] = static_cast<float>(from - static_cast<double>(moved));
        }
      }
    }
  });
  return found;
}

} // namespace firetwin::flow
