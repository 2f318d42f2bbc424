#pragma once

#include "base/vector.hpp"
#include "io/metadata.hpp"
#include "volume/leaf.hpp"
#include "volume/vdb_summary.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// VDB files. Only archive.cpp includes OpenVDB's headers, which take long to compile.
namespace firetwin::volume {

/// Leaves and tiles of a grid, as OpenVDB's tree. Copies share the tree.
class Topology {
public:
  Topology() = default;
  explicit Topology(const Leaves& leaves, const std::vector<Tile>& tiles = {});

private:
  friend class VdbFile;
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// Computes the values of a leaf, by its first voxel or by its number in the topology's leaves;
/// inactive values are ignored. Called from several threads at once.
using FillLeaf = std::function<void(const Coord& origin, std::size_t leaf, LeafValues& values)>;

/// A fog volume whose leaf values are computed on demand, leaf by leaf.
struct FogGrid {
  std::string name;
  std::string units;
  double voxel_size; ///< m
  Vector origin{};   ///< centre of voxel (0, 0, 0), m
  bool half = true;  ///< half precision
  Topology topology;
  FillLeaf fill;
};

/// Writes a VDB file with Blosc and active-mask compression, and with offsets, so that readers can
/// load single grids. VdbSummary::mass and `culled_mass` remain 0.
///
/// OpenVDB's own writer processes grids and leaves one by one, and compresses each leaf twice (the
/// first time to learn its size, for "delayed loading"). This one compresses each leaf once, in
/// parallel, as soon as its values are known, and writes a few dozen leaves at a time, so no grid
/// is ever complete in memory. Each piece is written by OpenVDB's functions; see its io/Archive.cc
/// for their order. The file does not depend on the number of threads.
/// @throws InputError if the folder or the file cannot be written
VdbSummary write_vdb(const std::filesystem::path& path, const std::vector<FogGrid>& grids,
                     const io::Metadata& metadata);

/// Returns the version of the OpenVDB library, such as "10.0.1abi10".
std::string openvdb_version();

} // namespace firetwin::volume
