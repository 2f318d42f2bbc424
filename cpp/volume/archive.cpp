#include "archive.hpp"

#include "error.hpp"
#include "lanes.hpp"
#include "system.hpp"

#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <system_error>

namespace firetwin {
namespace {

namespace fs = std::filesystem;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr std::size_t kChunk = 32; // leaves that are compressed into one block

/// A tree of leaves without values. Their numbers, in the order in which a file holds them, go
/// into `order`.
void plant(openvdb::FloatTree& tree, const SharedLeaves& leaves, std::vector<std::size_t>& order) {
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), leaves.origins[i]);
    leaf->setValueMask(leaves.masks[i]);
    leaf->setTransientData(static_cast<openvdb::Index32>(i));
    tree.addLeaf(leaf.release()); // the tree owns it now
  }
  order.reserve(leaves.size());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    order.push_back(leaf->transientData());
  }
}

/// Removes the temporary file unless it was renamed.
class Temporary {
public:
  explicit Temporary(const fs::path& target)
      : path_(target.string() + "." + std::to_string(system::process()) + ".tmp") {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

void require_folder(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string(), 0, 0, "no such folder; make it first");
  }
}

using HalfValues = std::array<std::uint16_t, kLeafVoxels>;

/// Rounds to half floats, nearest or even, as Imath's half does, but without branches: exponents
/// too small for half are made by adding 1/2 (the sum's last bits are the half's), others by moving
/// the exponent.
FIRETWIN_CLONES void to_half(const float* values, std::uint16_t* halves) {
  constexpr std::uint32_t kSmallest = 113U << 23;  // 2^-14
  constexpr std::uint32_t kInfinite = 0x477ff000U; // 65520
  for (std::size_t i = 0; i < kLeafVoxels; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    const std::uint32_t sign = bits >> 16 & 0x8000U;
    bits &= 0x7fffffffU;
    float magnitude = 0.0F;
    std::memcpy(&magnitude, &bits, sizeof magnitude);
    const float small = magnitude + 0.5F;
    std::uint32_t denormal = 0;
    std::memcpy(&denormal, &small, sizeof denormal);
    denormal -= 0x3f000000U;
    const std::uint32_t normal = (bits - (112U << 23) + 0xfffU + (bits >> 13 & 1U)) >> 13;
    std::uint32_t half = bits < kSmallest ? denormal : normal;
    half = bits >= kInfinite ? 0x7c00U : half;
    half = bits > 0x7f800000U ? 0x7e00U : half;
    halves[i] = static_cast<std::uint16_t>(half | sign);
  }
}

/// Values of one grid, leaf after leaf, as LeafNode::writeBuffers writes them when all values that
/// are not active are the background.
class LeafWriter {
public:
  void write(const LeafMask& mask, std::span<const openvdb::Index> active,
             const LeafValues& values) {
    to_half(values.data(), halves_.data());
    if (active.size() < kLeafVoxels) {
      for (std::size_t i = 0; i < active.size(); ++i) {
        halves_[i] = halves_[active[i]];
      }
    }
    mask.save(stream_);
    stream_.put(openvdb::io::NO_MASK_OR_INACTIVE_VALS);
    const std::size_t bytes = active.size() * sizeof(std::uint16_t);
    if (active.size() == known_count_ && std::memcmp(halves_.data(), known_.data(), bytes) == 0) {
      stream_ << known_bytes_; // deep smoke and its shade are the same for leaves on end
      return;
    }
    const auto before = static_cast<std::size_t>(stream_.tellp());
    openvdb::io::bloscToStream(stream_, reinterpret_cast<const char*>(halves_.data()),
                               sizeof(std::uint16_t), active.size());
    known_bytes_ = stream_.view().substr(before);
    known_ = halves_;
    known_count_ = active.size();
  }

  std::string take() { return std::move(stream_).str(); }

private:
  std::ostringstream stream_{std::ios_base::binary};
  HalfValues halves_;
  HalfValues known_;
  std::size_t known_count_ = 0;
  std::string known_bytes_;
};

} // namespace

VolumeArchive::VolumeArchive() {
  setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
}

VolumeArchive::Stored VolumeArchive::begin(const openvdb::GridBase& grid,
                                           std::ostringstream& stream) const {
  openvdb::io::setDataCompression(stream, compression());
  setGridCompression(stream, grid);
  const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid()); // with the same tree
  copy->addStatsMetadata();
  copy->insertMeta(openvdb::GridBase::META_FILE_COMPRESSION,
                   openvdb::StringMetadata(
                       openvdb::io::compressionToString(openvdb::io::getDataCompression(stream))));
  copy->writeMeta(stream);
  copy->writeTransform(stream);
  copy->writeTopology(stream);
  return {grid.getName(),
          grid.type(),
          grid.saveFloatAsHalf(),
          static_cast<std::size_t>(stream.tellp()),
          {}};
}

void VolumeArchive::count(const openvdb::GridBase& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const std::uint64_t voxels = grid.activeVoxelCount();
  frame_.voxels += voxels;
  if (box.empty() || voxels <= frame_.active_voxels) {
    return;
  }
  frame_.active_voxels = voxels;
  const openvdb::Vec3d low = grid.indexToWorld(box.min().asVec3d() - openvdb::Vec3d(0.5));
  const openvdb::Vec3d high = grid.indexToWorld(box.max().asVec3d() + openvdb::Vec3d(0.5));
  frame_.bounds = {low[0], low[1], low[2], high[0], high[1], high[2]};
}

void VolumeArchive::add(const std::vector<GridName>& grids, double voxel_size,
                        const SharedLeaves& leaves, const FillLeaf& fill) {
  const openvdb::FloatGrid::Ptr grid = fog_grid("", voxel_size, {0.0, 0.0, 0.0}, "");
  grid->setSaveFloatAsHalf(true);
  std::vector<std::size_t> order;
  plant(grid->tree(), leaves, order);
  const std::size_t chunks = (leaves.size() + kChunk - 1) / kChunk;
  const std::size_t first = grids_.size();
  for (const auto& [name, units] : grids) {
    grid->setName(name);
    grid->insertMeta("units", openvdb::StringMetadata(units));
    std::ostringstream stream(std::ios_base::binary);
    Stored stored = begin(*grid, stream);
    stored.pieces.resize(1 + chunks);
    stored.pieces[0] = std::move(stream).str();
    grids_.push_back(std::move(stored));
    count(*grid);
  }
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    std::vector<LeafValues> values(grids.size());
    std::vector<LeafWriter> writers(grids.size());
    std::vector<openvdb::Index> active;
    const std::size_t last = std::min((chunk + 1) * kChunk, order.size());
    for (std::size_t i = chunk * kChunk; i < last; ++i) {
      const LeafMask& mask = leaves.masks[order[i]];
      active.clear();
      for (auto voxel = mask.beginOn(); voxel; ++voxel) {
        active.push_back(voxel.pos());
      }
      fill(order[i], values);
      for (std::size_t g = 0; g < grids.size(); ++g) {
        writers[g].write(mask, active, values[g]);
      }
    }
    for (std::size_t g = 0; g < grids.size(); ++g) {
      grids_[first + g].pieces[1 + chunk] = writers[g].take();
    }
  });
}

void VolumeArchive::add(const openvdb::GridPtrVec& grids) {
  const std::size_t first = grids_.size();
  grids_.resize(first + grids.size());
  tbb::parallel_for(std::size_t{0}, grids.size(), [&](std::size_t i) {
    std::ostringstream stream(std::ios_base::binary);
    Stored stored = begin(*grids[i], stream);
    grids[i]->writeBuffers(stream);
    stored.pieces.push_back(std::move(stream).str());
    grids_[first + i] = std::move(stored);
  });
  for (const openvdb::GridBase::Ptr& grid : grids) {
    count(*grid);
  }
}

VolumeFrame VolumeArchive::write(const std::string& path, const Metadata& metadata) const {
  const fs::path target(path);
  require_folder(target);
  const Temporary temporary(target);
  try {
    std::ofstream file;
    file.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    file.open(temporary.path(), std::ios_base::binary);
    write(file, metadata);
    file.close();
    fs::rename(temporary.path(), target);
    VolumeFrame frame = frame_;
    frame.bytes = fs::file_size(target);
    return frame;
  } catch (const std::ios_base::failure&) {
    throw InputError(path, 0, 0,
                     "cannot write the volume: " + std::generic_category().message(errno));
  } catch (const fs::filesystem_error& error) {
    throw InputError(path, 0, 0, "cannot write the volume: " + error.code().message());
  }
}

void VolumeArchive::write(std::ostream& file, const Metadata& metadata) const {
  writeHeader(file, true);
  openvdb::MetaMap entries;
  for (const auto& [key, value] : metadata) {
    entries.insertMeta(key, openvdb::StringMetadata(value));
  }
  entries.writeMeta(file);
  const auto grids = static_cast<std::int32_t>(grids_.size());
  file.write(reinterpret_cast<const char*>(&grids), sizeof grids);
  for (const Stored& grid : grids_) {
    openvdb::io::GridDescriptor place(grid.name, grid.type, grid.half);
    place.writeHeader(file);
    const std::int64_t start = std::int64_t{file.tellp()} + 3 * std::int64_t{sizeof start};
    const auto size = std::accumulate(
        grid.pieces.begin(), grid.pieces.end(), std::size_t{0},
        [](std::size_t sum, const std::string& piece) { return sum + piece.size(); });
    place.setGridPos(start);
    place.setBlockPos(start + static_cast<std::int64_t>(grid.topology_end));
    place.setEndPos(start + static_cast<std::int64_t>(size));
    place.writeStreamPos(file);
    for (const std::string& piece : grid.pieces) {
      file.write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
  }
}

} // namespace firetwin
