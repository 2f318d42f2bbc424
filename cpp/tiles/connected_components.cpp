#include "tiles/connected_components.hpp"

namespace firetwin::tiles {

ConnectedComponents label_components(std::span<const std::uint8_t> mask, std::size_t rows,
                                     std::size_t columns) {
  ConnectedComponents found{rows, columns, 0, std::vector<std::int32_t>(mask.size(), -1)};
  std::vector<std::size_t> open;
  const auto visit = [&](std::size_t k) {
    if (mask[k] && found.number[k] < 0) {
      found.number[k] = static_cast<std::int32_t>(found.count);
      open.push_back(k);
    }
  };
  for (std::size_t first = 0; first < mask.size(); ++first) {
    visit(first);
    if (open.empty()) {
      continue;
    }
    while (!open.empty()) {
      const std::size_t k = open.back(), x = k % columns;
      open.pop_back();
      if (x > 0) {
        visit(k - 1);
      }
      if (x + 1 < columns) {
        visit(k + 1);
      }
      if (k >= columns) {
        visit(k - columns);
      }
      if (k + columns < mask.size()) {
        visit(k + columns);
      }
    }
    ++found.count;
  }
  return found;
}

std::vector<std::uint8_t> dilate(std::vector<std::uint8_t> mask, std::size_t rows,
                                 std::size_t columns, std::size_t by) {
  for (std::size_t turn = 0; turn < by; ++turn) {
    const auto before = mask;
    for_each_pair(rows, columns, [&](std::size_t a, std::size_t b) {
      mask[a] = mask[a] || before[b];
      mask[b] = mask[b] || before[a];
    });
  }
  return mask;
}

} // namespace firetwin::tiles
