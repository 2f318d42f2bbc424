#include "volume/archive.hpp"

#include "io/new_file.hpp"
#include "volume/fog.hpp"
#include "volume/leaf_writer.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <sstream>

namespace firetwin::volume {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr std::size_t leaves_per_piece = 32;

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

} // namespace

VdbArchive::VdbArchive() {
  setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
}

VdbArchive::Stored VdbArchive::begin(const openvdb::GridBase& grid,
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

void VdbArchive::count(const openvdb::GridBase& grid) {
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

void VdbArchive::add(const std::vector<GridName>& grids, double voxel_size,
                     const SharedLeaves& leaves, const FillLeaf& fill) {
  const openvdb::FloatGrid::Ptr grid = fog_grid("", voxel_size, {0.0, 0.0, 0.0}, "");
  grid->setSaveFloatAsHalf(true);
  std::vector<std::size_t> order;
  plant(grid->tree(), leaves, order);
  const std::size_t chunks = (leaves.size() + leaves_per_piece - 1) / leaves_per_piece;
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
    const std::size_t last = std::min((chunk + 1) * leaves_per_piece, order.size());
    for (std::size_t i = chunk * leaves_per_piece; i < last; ++i) {
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

void VdbArchive::add(const openvdb::GridPtrVec& grids) {
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

Frame VdbArchive::write(const std::filesystem::path& path, const io::Metadata& metadata) const {
  Frame frame = frame_;
  frame.bytes = io::write_file(path, [&](std::ostream& file) { write(file, metadata); });
  return frame;
}

void VdbArchive::write(std::ostream& file, const io::Metadata& metadata) const {
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

} // namespace firetwin::volume
