#include "volume/archive.hpp"

#include "io/new_file.hpp"
#include "volume/leaf_writer.hpp"

#include <oneapi/tbb/parallel_pipeline.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

namespace firetwin::volume {
namespace {

constexpr std::size_t leaves_per_piece = 32;
constexpr std::size_t max_pieces = 256; // in memory at once, 32 to 64 kB each

/// Last field of a file's header. OpenVDB writes a random UUID there; a fixed one makes files of
/// the same grids identical.
constexpr std::string_view fixed_uuid = "00000000-0000-0000-0000-000000000000";

} // namespace

/// A chunk of a grid's data: first the header (everything but the values), then the values of some
/// leaves.
struct VdbArchive::Piece {
  std::size_t grid = 0;
  bool head = true;
  std::size_t first = 0; ///< index of a leaf, in file order
  std::size_t last = 0;
  std::string bytes;
};

/// Iterates over the pieces of all grids in file order.
class VdbArchive::Pieces {
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
    LeafWriter writer(from.grid->saveFloatAsHalf());
    LeafValues values;
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const Leaf& leaf = *leaves_[piece.grid][i];
      from.fill(leaf, values);
      writer.write(leaf.getValueMask(), values);
    }
    return writer.take();
  }

private:
  std::vector<std::vector<const Leaf*>> leaves_; ///< by grid
  Piece next_;
};

/// Writes pieces one after the other, and fills in each grid's offsets in its header.
class VdbArchive::GridFile {
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

VdbArchive::VdbArchive() {
  setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
}

void VdbArchive::describe(const openvdb::GridBase& grid, std::ostream& stream) const {
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

void VdbArchive::add(LeafGrid grid) {
  const std::uint64_t voxels = grid.grid->activeVoxelCount();
  frame_.voxels += voxels;
  if (voxels > frame_.active_voxels) {
    frame_.active_voxels = voxels;
    const openvdb::CoordBBox box = grid.grid->evalActiveVoxelBoundingBox();
    const openvdb::Vec3d half(0.5);
    const openvdb::Vec3d low = grid.grid->indexToWorld(box.min().asVec3d() - half);
    const openvdb::Vec3d high = grid.grid->indexToWorld(box.max().asVec3d() + half);
    frame_.bounds = {low[0], low[1], low[2], high[0], high[1], high[2]};
  }
  grids_.push_back(std::move(grid));
}

VdbSummary VdbArchive::write(const std::filesystem::path& path,
                             const io::Metadata& metadata) const {
  VdbSummary frame = frame_;
  frame.bytes = io::write_file(path, [&](std::ostream& file) { write(file, metadata); });
  return frame;
}

void VdbArchive::write(std::ostream& file, const io::Metadata& metadata) const {
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

} // namespace firetwin::volume
