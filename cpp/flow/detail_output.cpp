#include "flow/detail_output.hpp"

#include <algorithm>
#include <span>

namespace firetwin::flow {

DetailOutput::DetailOutput(const SparseSmoke& smoke)
    : values_of_block_(smoke.values()),
      values_(static_cast<std::size_t>(smoke.blocks()[2]) * values_of_block_),
      used_(static_cast<std::size_t>(smoke.blocks()[2])) {}

void DetailOutput::move_to(SparseSmoke& smoke, Index i, Index j, float min_extinction) {
  for (std::size_t k = 0; k < used_.size(); ++k) {
    if (used_[k] == 0) {
      continue;
    }
    const std::span<float> block(values_.data() + k * values_of_block_, values_of_block_);
    for (float& density : block.first(SparseSmoke::block_size)) {
      density = density < min_extinction ? 0.0F : density;
    }
    if (std::any_of(block.begin(), block.end(), [](float value) { return value != 0.0F; })) {
      smoke.keep({i, j, static_cast<Index>(k)}, block);
    }
    std::fill(block.begin(), block.end(), 0.0F);
    used_[k] = 0;
  }
}

} // namespace firetwin::flow
