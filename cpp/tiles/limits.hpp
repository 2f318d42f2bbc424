#pragma once

#include <cstddef>
#include <cstdint>

/// What content may ask for. Content comes from anywhere, so every count in it is checked.
namespace firetwin::tiles {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr std::size_t fewer = 1000; ///< so that a fuzzer's inputs are quick
#else
constexpr std::size_t fewer = 1;
#endif

constexpr std::size_t most_vertices = 10'000'000 / fewer;       ///< of a tile, instances expanded
constexpr std::size_t most_instances = 1'000'000 / fewer;       ///< of a tile
constexpr std::size_t most_indices = 60'000'000 / fewer;        ///< of one primitive
constexpr std::size_t most_json_bytes = 64U << 20U;             ///< of one document
constexpr std::size_t most_decoded_bytes = (1U << 30U) / fewer; ///< accessors and buffers together
constexpr std::size_t deepest_json = 256;      ///< objects and arrays within each other
constexpr int deepest_composite = 8;           ///< cmpt within cmpt
constexpr std::uint32_t widest_image = 16'384; ///< pixels of either side
constexpr double farthest_vertex = 1e9;        ///< m from the origin of the scene

} // namespace firetwin::tiles
