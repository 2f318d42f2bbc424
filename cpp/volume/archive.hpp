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

/// Fills the values of one leaf; inactive values are ignored. Called from several threads at once.
using FillLeaf = std::function<void(const Leaf& leaf, LeafValues& values)>;

/// A grid whose leaf values are computed on demand, leaf by leaf. Grids may share a tree.
struct LeafGrid {
  openvdb::FloatGrid::Ptr grid;
  FillLeaf fill;
};

/// Writes VDB files with Blosc and active-mask compression, and with offsets, so that readers can
/// load single grids.
///
/// OpenVDB's own writer processes grids and leaves one by one, and compresses each leaf twice (the
/// first time to learn its size, for "delayed loading"). This writer compresses each leaf once, in
/// parallel, as soon as its values are known, and writes a few dozen leaves at a time, so no grid
/// is ever complete in memory. Each piece is written by OpenVDB's functions; see its io/Archive.cc
/// for their order. The file does not depend on the number of threads.
class VdbArchive : private openvdb::io::Archive {
public:
  VdbArchive();

  /// Adds a grid, in half precision if its saveFloatAsHalf is set.
  void add(LeafGrid grid);

  /// @throws InputError if the folder or the file cannot be written
  VdbSummary write(const std::filesystem::path& path, const io::Metadata& metadata) const;

private:
  struct Piece;
  class Pieces;
  class GridFile;

  void write(std::ostream& file, const io::Metadata& metadata) const;
  /// Writes a grid's compression, metadata, transform and topology.
  void describe(const openvdb::GridBase& grid, std::ostream& stream) const;

  std::vector<LeafGrid> grids_;
  VdbSummary frame_;
};

} // namespace firetwin::volume
