#pragma once

#include <cstddef>
#include <cstdint>

/// Limits of content. It is untrusted, so every count in it is checked.
namespace firetwin::tiles {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr std::size_t fuzz_divisor = 1000; ///< keeps fuzz inputs fast
#else
constexpr std::size_t fuzz_divisor = 1;
#endif

constexpr std::size_t max_vertices = 10'000'000 / fuzz_divisor; ///< per tile, instances expanded
constexpr std::size_t max_instances = 1'000'000 / fuzz_divisor; ///< per tile
constexpr std::size_t max_indices = 60'000'000 / fuzz_divisor;  ///< per primitive
constexpr std::size_t max_json_bytes = 64U << 20U;              ///< per document
constexpr std::size_t max_decoded_bytes =
    (1U << 30U) / fuzz_divisor;                  ///< per tile, accessors and buffers
constexpr std::size_t max_json_depth = 256;      ///< nested objects and arrays
constexpr int max_composite_depth = 8;           ///< nested cmpt
constexpr std::uint32_t max_image_side = 16'384; ///< pixels, width or height
constexpr double max_vertex_distance = 1e9;      ///< m from the scene's origin

} // namespace firetwin::tiles
