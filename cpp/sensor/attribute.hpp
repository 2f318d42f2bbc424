#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <variant>

namespace firetwin::sensor {

/// Ratio of two integers, such as 24000/1001 frames per second.
struct Rational {
  std::int32_t numerator = 0;
  std::uint32_t denominator = 1;
};

/// SMPTE ST 12-1 time code. Rates above 30 frames per second count pairs of frames; `second_field`
/// is true for the second frame of a pair.
struct TimeCode {
  unsigned hours = 0;   ///< 0 to 23
  unsigned minutes = 0; ///< 0 to 59
  unsigned seconds = 0; ///< 0 to 59
  unsigned frame = 0;   ///< 0 to 29
  bool drop_frame = false;
  bool second_field = false;
};

/// Value of a header attribute: text, int, float, rational, timecode, v2f, v3f or m44f of OpenEXR.
/// Matrices are row by row and multiply row vectors from the right, as in Imath.
using Attribute = std::variant<std::string, std::int32_t, float, Rational, TimeCode,
                               std::array<float, 2>, std::array<float, 3>, std::array<float, 16>>;

/// Attributes by OpenEXR's name.
using Attributes = std::map<std::string, Attribute>;

} // namespace firetwin::sensor
