#include "flames/library.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace firetwin::flames {

FlameLibrary::FlameLibrary(std::vector<Kind> lines, Kind crowns)
    : lines_(std::move(lines)), crowns_(std::move(crowns)) {
  const auto is_empty = [](const Kind& kind) { return kind.empty(); };
  if (lines_.empty() || lines_.size() > most_kinds || crowns_.empty() ||
      std::any_of(lines_.begin(), lines_.end(), is_empty)) {
    throw std::invalid_argument(
        "a library needs blocks of crowns, and of one to four kinds of lines");
  }
  float wind = -1.0F;
  for (const Kind& kind : lines_) {
    const BlockScale& scale = kind.front()->scale();
    if (!(scale.wind > wind)) {
      throw std::invalid_argument("kinds of lines must be sorted by wind");
    }
    wind = scale.wind;
    for (const auto& block : kind) {
      behind_ = std::max(behind_, block->scale().front);
      ahead_ = std::max(ahead_, block->across() - block->scale().front);
      top_ = std::max(top_, block->top());
    }
  }
}

} // namespace firetwin::flames
