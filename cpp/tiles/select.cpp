#include "tiles/select.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::tiles {
namespace {

void check(const Tree& tree, double error) {
  if (!(error >= 0.0)) {
    throw std::invalid_argument("error must be 0 or more");
  }
  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (tree.parent[i] < -1 || tree.parent[i] >= static_cast<std::int64_t>(i)) {
      throw std::invalid_argument("parent must be -1 or the number of an earlier tile");
    }
    if (std::isnan(tree.screen_error[i])) {
      throw std::invalid_argument("screen_error must not be NaN");
    }
  }
}

/// One traversal of the tree at a given error. Parents come before their children, so each step is
/// one pass over the tiles.
class Traversal {
public:
  Traversal(const Tree& tree, double error) : tree_(tree), state_(tree.size(), 0) {
    descend(error);
    ascend();
  }

  Cut cut(double error) const {
    Cut cut;
    cut.error = error;
    std::vector<bool> reached(tree_.size());
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      const std::int64_t parent = tree_.parent[i];
      reached[i] =
          is(i, visited) && (parent < 0 || (reached[at(parent)] && is(at(parent), refined)));
      if (reached[i]) {
        enter(i, cut);
      }
    }
    return cut;
  }

private:
  enum State : std::uint8_t {
    visited = 1,
    forced = 2,           ///< shown even if no view sees it
    refined = 4,          ///< its children are visited
    children_pending = 8, ///< its children would be visited, but are not loaded
    failed = 16,          ///< the tile or a descendant is broken and has no stand-in
    stands_in = 32,
    visited_child = 64 ///< has a visited child
  };

  static std::size_t at(std::int64_t index) { return static_cast<std::size_t>(index); }
  bool is(std::size_t i, State state) const { return (state_[i] & state) != 0; }
  bool has(std::size_t i, Flag flag) const { return (tree_.flags[i] & flag) != 0; }
  void set(std::size_t i, int state) { state_[i] = static_cast<std::uint8_t>(state_[i] | state); }
  void clear(std::size_t i, int state) {
    state_[i] = static_cast<std::uint8_t>(state_[i] & ~state);
  }

  /// True if the children of a refined tile are shown even if no view sees them.
  bool forces(std::size_t i) const {
    return has(i, pass_through) ? is(i, forced)
                                : has(i, replaces) || (has(i, unconditional) && is(i, forced));
  }

  void descend(double error) {
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      const std::int64_t parent = tree_.parent[i];
      if ((parent >= 0 && !is(at(parent), refined)) || has(i, outside_request_volume)) {
        continue;
      }
      if (parent >= 0 && forces(at(parent))) {
        set(i, forced);
      }
      const bool seen = tree_.screen_error[i] >= 0.0;
      if (!seen && !is(i, forced)) {
        continue;
      }
      set(i, visited);
      if (parent >= 0) {
        set(at(parent), visited_child);
      }
      if (has(i, unconditional) || (seen && tree_.screen_error[i] > error)) {
        set(i, refined | (has(i, pending) ? children_pending : 0));
      }
    }
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      if (!is(i, visited_child)) {
        clear(i, refined); // no child is loaded or needed
      }
    }
  }

  bool shows(std::size_t i) const {
    return has(i, content) && (!is(i, refined) || !has(i, replaces) || has(i, pass_through));
  }
  bool can_stand_in(std::size_t i) const { return has(i, content) && !has(i, broken); }

  void ascend() {
    for (std::size_t i = tree_.size(); i-- > 0;) {
      if (!is(i, visited)) {
        continue;
      }
      if (is(i, failed) && can_stand_in(i)) {
        clear(i, failed);
        set(i, stands_in);
        if (has(i, replaces) && !has(i, pass_through)) {
          clear(i, refined | children_pending);
        }
      }
      if ((is(i, failed) || (shows(i) && has(i, broken))) && tree_.parent[i] >= 0) {
        set(at(tree_.parent[i]), failed);
      }
    }
  }

  void enter(std::size_t i, Cut& cut) const {
    const auto number = static_cast<std::int64_t>(i);
    if (is(i, children_pending)) {
      cut.expand.push_back(number);
    }
    if (is(i, stands_in)) {
      cut.stand_ins.push_back(number);
    }
    if (shows(i) && has(i, broken)) {
      cut.missing.push_back(number);
    } else if (shows(i)) {
      cut.tiles.push_back(number);
      cut.bytes += tree_.bytes[i];
      cut.triangles += tree_.triangles[i];
    }
  }

  const Tree& tree_;
  std::vector<std::uint8_t> state_;
};

bool is_within(std::int64_t number, std::int64_t most) {
  return most < 0 || number <= most;
}

Cut choose(const Tree& tree, double error, const Budget& budget) {
  Cut cut = Traversal(tree, error).cut(error);
  cut.fits = is_within(static_cast<std::int64_t>(cut.tiles.size()), budget.tiles) &&
             is_within(cut.bytes, budget.bytes) && is_within(cut.triangles, budget.triangles);
  return cut;
}

} // namespace

Cut select(const Tree& tree, double error, const Budget& budget) {
  check(tree, error);
  Cut best = choose(tree, error, budget);
  if (best.fits) {
    return best;
  }
  std::vector<double> steps;
  std::copy_if(tree.screen_error.begin(), tree.screen_error.end(), std::back_inserter(steps),
               [&](double each) { return each > error; });
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::size_t low = 0, high = steps.size(); // fits at steps[high], does not fit below steps[low]
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    Cut cut = choose(tree, steps[middle], budget);
    if (cut.fits) {
      high = middle;
    } else {
      low = middle + 1;
    }
    if (cut.fits || !best.fits) {
      best = std::move(cut);
    }
  }
  return best;
}

} // namespace firetwin::tiles
