#include "volume/archive.hpp"

#include "io/new_file.hpp"
#include "volume/leaf_writer.hpp"

#include <oneapi/tbb/parallel_pipeline.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

namespace firetwin::volume {

using Leaf = openvdb::FloatTree::LeafNodeType;

struct Topology::Tree {
  openvdb::FloatTree::Ptr tree = std::make_shared<openvdb::FloatTree>();
};

Topology::Topology(const Leaves& leaves, const std::vector<Tile>& tiles) {
  const auto made = std::make_shared<Tree>();
  const auto coord = [](const Coord& at) { return openvdb::Coord(at.x(), at.y(), at.z()); };
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), coord(leaves.origins[i]));
    Leaf::NodeMaskType mask;
    for (std::size_t word = 0; word < leaves.masks[i].words.size(); ++word) {
      mask.getWord<std::uint64_t>(static_cast<openvdb::Index>(word)) = leaves.masks[i].words[word];
    }
    leaf->setValueMask(mask);
    leaf->setTransientData(static_cast<openvdb::Index32>(i));
    made->tree->addLeaf(leaf.release()); // the tree takes ownership
  }
  for (const Tile& tile : tiles) {
    made->tree->addTile(1, coord(tile.origin), tile.value, true);
  }
  tree_ = made;
}

namespace {

constexpr std::size_t leaves_per_piece = 32;
constexpr std::size_t max_pieces = 256; // in memory at once, 32 to 64 kB each

/// Last field of a file's header. OpenVDB writes a random UUID there; a fixed one makes files of
/// the same grids identical.
constexpr std::string_view fixed_uuid = "00000000-0000-0000-0000-000000000000";

/// Makes the grid without leaf values.
openvdb::FloatGrid::Ptr fog_volume(const FogGrid& fog, const openvdb::FloatTree::Ptr& tree) {
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
  const openvdb::math::Transform::Ptr transform =
      openvdb::math::Transform::createLinearTransform(fog.voxel_size);
  transform->postTranslate(openvdb::Vec3d(fog.origin[0], fog.origin[1], fog.origin[2]));
  grid->setTransform(transform);
  grid->setName(fog.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->insertMeta("units", openvdb::StringMetadata(fog.units));
  grid->setSaveFloatAsHalf(fog.half);
  grid->setTree(tree);
  return grid;
}

/// A grid with the function that computes its values.
struct LeafGrid {
  openvdb::FloatGrid::Ptr grid;
  const FillLeaf* fill;
};

/// A chunk of a grid's data: first the header (everything but the values), then the values of some
/// leaves.
struct Piece {
  std::size_t grid = 0;
  bool head = true;
  std::size_t first = 0; ///< index of a leaf, in file order
  std::size_t last = 0;
  std::string bytes;
};

/// Iterates over the pieces of all grids in file order.
class Pieces {
public:
  explicit Pieces(const std::vector<LeafGrid>& grids) : leaves_(grids.size()) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
      std::as_const(*grids[i].grid).tree().getNodes(leaves_[i]);
    }
  }

  /// Returns the next piece, without its bytes.
  std::optional<Piece> next() {
    if (next_.grid == leaves_.size()) {
      return std::nullopt;
    }
    Piece piece = next_;
    const std::size_t all = leaves_[piece.grid].size();
    next_.head = piece.last == all;
    next_.grid += next_.head ? 1 : 0;
    next_.first = next_.head ? 0 : piece.last;
    next_.last = next_.head ? 0 : std::min(next_.first + leaves_per_piece, all);
    return piece;
  }

  bool is_last(const Piece& piece) const { return piece.last == leaves_[piece.grid].size(); }

  /// Serialises the values of a piece's leaves.
  std::string values(const LeafGrid& from, const Piece& piece) const {
    LeafWriter writer(from.grid->saveFloatAsHalf(), &openvdb::io::bloscToStream);
    LeafValues values;
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const Leaf& leaf = *leaves_[piece.grid][i];
      const openvdb::Coord origin = leaf.origin();
      (*from.fill)({origin.x(), origin.y(), origin.z()}, leaf.transientData(), values);
      writer.write(mask_of(leaf), values);
    }
    return writer.take();
  }

private:
  static LeafMask mask_of(const Leaf& leaf) {
    LeafMask mask;
    for (std::size_t word = 0; word < mask.words.size(); ++word) {
      mask.words[word] =
          leaf.getValueMask().getWord<std::uint64_t>(static_cast<openvdb::Index>(word));
    }
    return mask;
  }

  std::vector<std::vector<const Leaf*>> leaves_; ///< by grid
  Piece next_;
};

/// Writes pieces one after the other, and fills in each grid's offsets in its header.
class GridFile {
public:
  explicit GridFile(std::ostream& file) : file_(file) {}

  void write(const openvdb::GridBase& grid, const Piece& piece, bool is_last) {
    if (piece.head) {
      descriptor_ =
          openvdb::io::GridDescriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
      descriptor_.writeHeader(file_);
      offsets_ = file_.tellp();
      descriptor_.writeStreamPos(file_); // placeholder, rewritten at the end of the grid
      descriptor_.setGridPos(file_.tellp());
    }
    file_.write(piece.bytes.data(), static_cast<std::streamsize>(piece.bytes.size()));
    if (piece.head) {
      descriptor_.setBlockPos(file_.tellp());
    }
    if (is_last) {
      descriptor_.setEndPos(file_.tellp());
      file_.seekp(offsets_);
      descriptor_.writeStreamPos(file_);
      file_.seekp(descriptor_.getEndPos());
    }
  }

private:
  std::ostream& file_;
  openvdb::io::GridDescriptor descriptor_;
  std::streampos offsets_;
};

} // namespace

class VdbFile : private openvdb::io::Archive {
public:
  explicit VdbFile(const std::vector<FogGrid>& grids) {
    setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    for (const FogGrid& fog : grids) {
      grids_.push_back({fog_volume(fog, fog.topology.tree_->tree), &fog.fill});
    }
  }

  VdbSummary summary() const;
  void write(std::ostream& file, const io::Metadata& metadata) const;

private:
  /// Writes a grid's compression, metadata, transform and topology.
  void describe(const openvdb::GridBase& grid, std::ostream& stream) const;

  std::vector<LeafGrid> grids_;
};

void VdbFile::describe(const openvdb::GridBase& grid, std::ostream& stream) const {
  openvdb::io::setDataCompression(stream, compression());
  setGridCompression(stream, grid);
  const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid()); // shares the tree
  copy->addStatsMetadata();
  copy->insertMeta(openvdb::GridBase::META_FILE_COMPRESSION,
                   openvdb::StringMetadata(
                       openvdb::io::compressionToString(openvdb::io::getDataCompression(stream))));
  copy->writeMeta(stream);
  copy->writeTransform(stream);
  copy->writeTopology(stream);
}

VdbSummary VdbFile::summary() const {
  VdbSummary summary;
  for (const auto& [grid, fill] : grids_) {
    const std::uint64_t voxels = grid->activeVoxelCount();
    summary.voxels += voxels;
    if (voxels > summary.active_voxels) {
      summary.active_voxels = voxels;
      const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
      const openvdb::Vec3d half(0.5);
      const openvdb::Vec3d low = grid->indexToWorld(box.min().asVec3d() - half);
      const openvdb::Vec3d high = grid->indexToWorld(box.max().asVec3d() + half);
      summary.bounds = {low[0], low[1], low[2], high[0], high[1], high[2]};
    }
  }
  return summary;
}

void VdbFile::write(std::ostream& file, const io::Metadata& metadata) const {
  writeHeader(file, true);
  file.seekp(-static_cast<std::streamoff>(fixed_uuid.size()), std::ios_base::cur);
  file << fixed_uuid;
  openvdb::MetaMap entries;
  for (const auto& [key, value] : metadata) {
    entries.insertMeta(key, openvdb::StringMetadata(value));
  }
  entries.writeMeta(file);
  const auto grids = static_cast<std::int32_t>(grids_.size());
  file.write(reinterpret_cast<const char*>(&grids), sizeof grids);

  Pieces pieces(grids_);
  GridFile parts(file);
  int reason = 0; // errno is thread-local
  const auto take = [&](tbb::flow_control& control) {
    std::optional<Piece> piece = pieces.next();
    if (!piece) {
      control.stop();
    }
    return std::move(piece).value_or(Piece{});
  };
  const auto fill = [&](Piece piece) {
    const LeafGrid& from = grids_[piece.grid];
    if (piece.head) {
      std::ostringstream stream(std::ios_base::binary);
      describe(*from.grid, stream);
      piece.bytes = std::move(stream).str();
    } else {
      piece.bytes = pieces.values(from, piece);
    }
    return piece;
  };
  const auto put = [&](const Piece& piece) {
    try {
      parts.write(*grids_[piece.grid].grid, piece, pieces.is_last(piece));
    } catch (const std::ios_base::failure&) {
      reason = errno;
      throw;
    }
  };
  try {
    tbb::parallel_pipeline(
        max_pieces, tbb::make_filter<void, Piece>(tbb::filter_mode::serial_in_order, take) &
                        tbb::make_filter<Piece, Piece>(tbb::filter_mode::parallel, fill) &
                        tbb::make_filter<Piece, void>(tbb::filter_mode::serial_in_order, put));
  } catch (const std::ios_base::failure&) {
    errno = reason;
    throw;
  }
}

VdbSummary write_vdb(const std::filesystem::path& path, const std::vector<FogGrid>& grids,
                     const io::Metadata& metadata) {
  const VdbFile made(grids);
  VdbSummary summary = made.summary();
  summary.bytes = io::write_file(path, [&](std::ostream& file) { made.write(file, metadata); });
  return summary;
}

std::string openvdb_version() {
  return openvdb::getLibraryAbiVersionString();
}

} // namespace firetwin::volume
