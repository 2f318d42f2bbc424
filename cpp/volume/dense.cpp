#include "volume/dense.hpp"

#include "base/check.hpp"
#include "volume/archive.hpp"
#include "volume/dense_leaves.hpp"

#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace firetwin::volume {
namespace {

[[noreturn]] void refuse(const std::string& name, const DenseField& field, const Coord& at) {
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
  std::vector<FogGrid> grids;
  double mass = 0.0;
  double culled_mass = 0.0;
  const double volume = settings.voxel_size * settings.voxel_size * settings.voxel_size;
  const auto add = [&](const std::string& name, const DenseLeaves* within) {
    const DenseField& field = fields.at(name);
    const bool is_density = name == "density";
    DenseLeaves found = find_leaves(field, settings, is_density, within);
    if (found.bad) {
      refuse(name, field, *found.bad);
    }
    if (is_density) {
      mass = found.sum * volume;
      culled_mass = found.culled_sum * volume;
    }
    grids.push_back({.name = name,
                     .units = "",
                     .voxel_size = settings.voxel_size,
                     .origin = settings.origin,
                     .half = settings.half,
                     .topology = Topology(found.leaves, found.tiles),
                     .fill = [&field](const Coord& origin, std::size_t, LeafValues& values) {
                       copy_leaf(field, origin, values);
                     }});
    return found;
  };
  std::optional<DenseLeaves> outer;
  if (!settings.within.empty()) {
    outer = add(settings.within, nullptr);
  }
  for (const auto& [name, field] : fields) {
    if (name != settings.within) {
      add(name, outer ? &*outer : nullptr);
    }
  }
  VdbSummary frame = write_vdb(path, grids, metadata);
  frame.mass = mass;
  frame.culled_mass = culled_mass;
  return frame;
}

} // namespace firetwin::volume
