#include "forest/site.hpp"

#include "philox.hpp"

namespace firetwin::forest {

std::array<double, 4> draw(const Site& site, std::size_t cell, Use use) {
  const auto bits = philox({cell, static_cast<std::uint64_t>(use), 0, 0}, {site.seed, 0});
  return {unit(bits[0]), unit(bits[1]), unit(bits[2]), unit(bits[3])};
}

} // namespace firetwin::forest
