#pragma once

#include "io/metadata.hpp"
#include "volume/frame.hpp"
#include "volume/leaf.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace firetwin::volume {

/// Name and units of a grid.
struct GridName {
  std::string name;
  std::string units;
};

/// Leaves that several grids have in common: where they begin and which voxels are active.
struct SharedLeaves {
  std::vector<openvdb::Coord> origins;
  std::vector<LeafMask> masks;

  std::size_t size() const { return origins.size(); }
};

/// Fills the values of one leaf in each of the grids, 0 where a voxel is not active. Called on
/// several threads at once.
using FillLeaf = std::function<void(std::size_t leaf, std::span<LeafValues> grids)>;

/// A VDB file in the making, Blosc and active mask, with offsets, so that readers load single
/// grids.
///
/// OpenVDB's own writer works through grids and leaves one by one, and compresses each leaf twice
/// (the first time to learn its size, for "delayed loading"). Here leaves are compressed once, in
/// parallel, as soon as their values are known, and no grid is ever whole in memory. What is
/// written piece by piece is written by OpenVDB's functions; see its io/Archive.cc for the order.
class VdbArchive : private openvdb::io::Archive {
public:
  VdbArchive();

  /// Adds half-precision fog volumes with cubic voxels and the same active voxels.
  void add(const std::vector<GridName>& grids, double voxel_size, const SharedLeaves& leaves,
           const FillLeaf& fill);
  /// Adds whole grids, each on its own thread.
  void add(const openvdb::GridPtrVec& grids);

  /// @throws InputError when the folder or file cannot be written.
  Frame write(const std::filesystem::path& path, const io::Metadata& metadata) const;

private:
  /// A grid as it lies in a file.
  struct Stored {
    std::string name;
    std::string type;
    bool half = false;
    std::size_t topology_end = 0;    ///< bytes, where the first piece's values begin
    std::vector<std::string> pieces; ///< compression, metadata, transform and topology; values
  };

  /// Everything but the values.
  Stored begin(const openvdb::GridBase& grid, std::ostringstream& stream) const;
  void count(const openvdb::GridBase& grid);
  void write(std::ostream& file, const io::Metadata& metadata) const;

  std::vector<Stored> grids_;
  Frame frame_;
};

} // namespace firetwin::volume
