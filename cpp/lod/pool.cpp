#include "lod/pool.hpp"

#include "base/random.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_set>

namespace firetwin::lod {
namespace {

/// Second word of Philox's key: 0 belongs to the forest, 1 to the particles.
constexpr std::uint64_t stream = 2;

} // namespace

Pool::Pool(std::size_t capacity, std::uint64_t seed) : seed_(seed) {
  if (capacity > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::invalid_argument("capacity must be below 2^31");
  }
  cells_.assign(capacity, -1);
  for (std::size_t i = 0; i < capacity; ++i) {
    free_.insert(free_.end(), static_cast<std::int32_t>(i));
  }
}

std::vector<std::int32_t> Pool::assign(std::span<const std::int64_t> cell) {
  std::unordered_set<std::int64_t> all, wanted;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (cell[i] < 0 || !all.insert(cell[i]).second) {
      throw std::invalid_argument("cell " + std::to_string(cell[i]) +
                                  (cell[i] < 0 ? " is negative" : " is named twice"));
    }
    if (i < capacity()) {
      wanted.insert(cell[i]);
    }
  }
  for (std::int64_t& held : cells_) {
    if (held >= 0 && !wanted.contains(held)) {
      const auto found = slot_of_.find(held);
      free_.insert(found->second);
      slot_of_.erase(found);
      held = -1;
    }
  }
  std::vector<std::int32_t> slot(cell.size(), -1);
  for (std::size_t i = 0; i < std::min(cell.size(), capacity()); ++i) {
    auto found = slot_of_.find(cell[i]);
    if (found == slot_of_.end()) {
      found = slot_of_.emplace(cell[i], free_.extract(free_.begin()).value()).first;
      cells_[static_cast<std::size_t>(found->second)] = cell[i];
    }
    slot[i] = found->second;
  }
  return slot;
}

std::uint32_t Pool::seed(std::int64_t cell) const {
  const auto bits = philox({static_cast<std::uint64_t>(cell), 0, 0, 0}, {seed_, stream});
  return static_cast<std::uint32_t>(bits[0] >> 32);
}

} // namespace firetwin::lod
