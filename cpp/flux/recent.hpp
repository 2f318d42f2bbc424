#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>

namespace firetwin::flux {

/// The last `count` things that were made, by number. Those who hold one keep it.
template <class Thing, std::size_t count> class Recent {
public:
  template <class Make> std::shared_ptr<const Thing> get(std::size_t number, const Make& make) {
    const auto is_it = [number](const Entry& e) { return e.second && e.first == number; };
    auto found = std::find_if(entries_.begin(), entries_.end(), is_it);
    if (found == entries_.end()) {
      --found;
      *found = {number, std::make_shared<const Thing>(make())};
    }
    std::rotate(entries_.begin(), found, found + 1);
    return entries_.front().second;
  }

private:
  using Entry = std::pair<std::size_t, std::shared_ptr<const Thing>>;
  std::array<Entry, count> entries_;
};

} // namespace firetwin::flux
