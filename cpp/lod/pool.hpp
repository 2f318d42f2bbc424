#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

namespace firetwin::lod {

/// Slots for what is shown, so that nothing pops: a cell keeps its slot for as long as it is among
/// those asked for, and its seed for ever.
class Pool {
public:
  /// @throws std::invalid_argument for more than 2^31 - 1 slots.
  explicit Pool(std::size_t capacity, std::uint64_t seed = 0);

  std::size_t capacity() const { return cells_.size(); }
  /// The cell in each slot, -1 where it is free.
  std::span<const std::int64_t> cells() const { return cells_; }

  /// The slot of each cell from now on. The first `capacity` cells get one, the rest -1: those that
  /// have one keep it, new ones take the lowest free slots in their order.
  /// @throws std::invalid_argument for negative cells and for a cell named twice; then nothing
  ///         changes.
  std::vector<std::int32_t> assign(std::span<const std::int64_t> cell);

  /// A number that depends on the pool's seed and the cell alone.
  std::uint32_t seed(std::int64_t cell) const;

private:
  std::uint64_t seed_;
  std::vector<std::int64_t> cells_;
  std::unordered_map<std::int64_t, std::int32_t> slot_of_;
  std::set<std::int32_t> free_;
};

} // namespace firetwin::lod
