#pragma once

#include "io/metadata.hpp"
#include "volume/leaf.hpp"
#include "volume/vdb_summary.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <vector>

namespace firetwin::volume {

/// Fills the values of one leaf; those that are not active do not matter. Called on several threads
/// at once.
using FillLeaf = std::function<void(const Leaf& leaf, LeafValues& values)>;

/// A grid whose leaves need no values of their own: they are asked for one by one. Grids may share
/// a tree.
struct LeafGrid {
  openvdb::FloatGrid::Ptr grid;
  FillLeaf fill;
};

/// Writes VDB files, Blosc and active mask, with offsets, so that readers load single grids.
///
/// OpenVDB's own writer works through grids and leaves one by one, and compresses each leaf twice
/// (the first time to learn its size, for "delayed loading"). Here leaves are compressed once, in
/// parallel, as soon as their values are known, and go to the file a few dozen at a time: no grid
/// is ever whole in memory. What is written piece by piece is written by OpenVDB's functions; see
/// its io/Archive.cc for the order. The file does not depend on the number of threads.
class VdbArchive : private openvdb::io::Archive {
public:
  VdbArchive();

  /// Adds a grid, half precision where it says so (saveFloatAsHalf).
  void add(LeafGrid grid);

  /// @throws InputError when the folder or file cannot be written.
  VdbSummary write(const std::filesystem::path& path, const io::Metadata& metadata) const;

private:
  struct Piece;
  class Pieces;
  class File;

  void write(std::ostream& file, const io::Metadata& metadata) const;
  /// A grid's compression, metadata, transform and topology.
  void describe(const openvdb::GridBase& grid, std::ostream& stream) const;

  std::vector<LeafGrid> grids_;
  VdbSummary frame_;
};

} // namespace firetwin::volume
