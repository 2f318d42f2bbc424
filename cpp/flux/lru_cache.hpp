#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>

namespace firetwin::flux {

/// LRU cache of `count` values by number. A value lives as long as a caller holds its pointer.
template <class Value, std::size_t count> class LruCache {
public:
  /// Returns the value of a number; calls `make()` if it is not in the cache.
  template <class Make> std::shared_ptr<const Value> get(std::size_t number, const Make& make) {
    const auto is_it = [number](const Entry& e) { return e.second && e.first == number; };
    auto found = std::find_if(entries_.begin(), entries_.end(), is_it);
    if (found == entries_.end()) {
      --found;
      *found = {number, std::make_shared<const Value>(make())};
    }
    std::rotate(entries_.begin(), found, found + 1);
    return entries_.front().second;
  }

private:
  using Entry = std::pair<std::size_t, std::shared_ptr<const Value>>;
  std::array<Entry, count> entries_;
};

} // namespace firetwin::flux
