#pragma once

#include <array>
#include <cstdint>

namespace firetwin {

/// Philox4x64-10: a counter-based random number generator (Salmon et al. 2011, "Parallel random
/// numbers: as easy as 1, 2, 3", doi:10.1145/2063384.2063405). The four numbers depend on the key
/// and the counter alone, so that any thread can draw any of them. numpy.random.Philox gives the
/// same.
constexpr std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> counter,
                                              std::array<std::uint64_t, 2> key) {
  __extension__ using Wide = unsigned __int128;
  for (int round = 0; round < 10; ++round) {
    const Wide a = Wide{0xD2E7470EE14C6C93} * counter[0];
    const Wide b = Wide{0xCA5A826395121157} * counter[2];
    const auto high = [](Wide w) { return static_cast<std::uint64_t>(w >> 64); };
    const auto low = [](Wide w) { return static_cast<std::uint64_t>(w); };
    counter = {high(b) ^ counter[1] ^ key[0], low(b), high(a) ^ counter[3] ^ key[1], low(a)};
    key[0] += 0x9E3779B97F4A7C15;
    key[1] += 0xBB67AE8584CAA73B;
  }
  return counter;
}

/// The upper 53 bits as a number in [0, 1).
constexpr double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

} // namespace firetwin
