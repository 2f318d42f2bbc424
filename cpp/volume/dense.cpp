#include "volume/dense.hpp"

#include "base/check.hpp"
#include "volume/archive.hpp"
#include "volume/dense_leaves.hpp"
#include "volume/fog.hpp"

#include <sstream>
#include <stdexcept>

namespace firetwin::volume {
namespace {

[[noreturn]] void refuse(const std::string& name, const DenseField& field,
                         const openvdb::Coord& at) {
  LeafValues values;
  copy_leaf(field, at, values);
  std::ostringstream text;
  text << "grid \"" << name << "\" holds " << values[0] << " at [" << at.x() << ", " << at.y()
       << ", " << at.z() << "]; values must be finite, and at most 65504 in half precision";
  throw std::invalid_argument(text.str());
}

} // namespace

VdbSummary write_dense(const std::filesystem::path& path,
                       const std::map<std::string, DenseField>& fields,
                       const DenseSettings& settings, const io::Metadata& metadata) {
  check_voxel_size(settings.voxel_size);
  check_finite(settings.origin, "origin");
  check_zero_or_more(static_cast<double>(settings.tolerance), "tolerance");
  if (!settings.within.empty() && !fields.contains(settings.within)) {
    throw std::invalid_argument("within must name one of the grids, not \"" + settings.within +
                                '"');
  }
  VdbArchive archive;
  double mass = 0.0;
  double culled_mass = 0.0;
  const double volume = settings.voxel_size * settings.voxel_size * settings.voxel_size;
  const auto add = [&](const std::string& name, const openvdb::FloatTree* within) {
    const DenseField& field = fields.at(name);
    const openvdb::FloatGrid::Ptr grid = fog_grid(name, settings.voxel_size, settings.origin, "");
    grid->setSaveFloatAsHalf(settings.half);
    const bool is_density = name == "density";
    const DenseLeaves leaves = find_leaves(field, settings, is_density, within, grid->tree());
    if (leaves.bad) {
      refuse(name, field, *leaves.bad);
    }
    if (is_density) {
      mass = leaves.sum * volume;
      culled_mass = leaves.culled_sum * volume;
    }
    archive.add({grid, [&field](const Leaf& leaf, LeafValues& values) {
                   copy_leaf(field, leaf.origin(), values);
                 }});
    return grid;
  };
  const openvdb::FloatGrid::ConstPtr outer =
      settings.within.empty() ? nullptr : add(settings.within, nullptr);
  for (const auto& [name, field] : fields) {
    if (name != settings.within) {
      add(name, outer ? &outer->constTree() : nullptr);
    }
  }
  VdbSummary frame = archive.write(path, metadata);
  frame.mass = mass;
  frame.culled_mass = culled_mass;
  return frame;
}

} // namespace firetwin::volume
