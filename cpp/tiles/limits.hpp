#pragma once

#include <cstddef>
#include <cstdint>

/// What content may ask for. Content comes from anywhere, so every count in it is checked.
namespace firetwin::tiles {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr std::size_t fuzz_divisor = 1000; ///< so that a fuzzer's inputs are quick
#else
constexpr std::size_t fuzz_divisor = 1;
#endif

constexpr std::size_t max_vertices = 10'000'000 / fuzz_divisor; ///< of a tile, instances expanded
constexpr std::size_t max_instances = 1'000'000 / fuzz_divisor; ///< of a tile
constexpr std::size_t max_indices = 60'000'000 / fuzz_divisor;  ///< of one primitive
constexpr std::size_t max_json_bytes = 64U << 20U;              ///< of one document
constexpr std::size_t max_decoded_bytes =
    (1U << 30U) / fuzz_divisor;                  ///< accessors and buffers together
constexpr std::size_t max_json_depth = 256;      ///< objects and arrays within each other
constexpr int max_composite_depth = 8;           ///< cmpt within cmpt
constexpr std::uint32_t max_image_side = 16'384; ///< pixels of either side
constexpr double max_vertex_distance = 1e9;      ///< m from the origin of the scene

} // namespace firetwin::tiles
