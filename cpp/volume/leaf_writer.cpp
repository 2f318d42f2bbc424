#include "volume/leaf_writer.hpp"

#include "base/clones.hpp"

#include <cstring>
#include <string_view>

namespace firetwin::volume {
namespace {

/// Rounds to half floats, nearest with ties to even, as Imath's half does, but without branches:
/// for subnormal halves it adds 1/2 (the last bits of the sum are the half's bits), otherwise it
/// rebiases the exponent.
FIRETWIN_CLONES("avx2")
void to_half(const LeafValues& values, HalfValues& halves) {
  constexpr std::uint32_t smallest_normal = 113U << 23; // 2^-14
  constexpr std::uint32_t infinite = 0x477ff000U;       // 65520
  for (std::size_t i = 0; i < leaf_voxels; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &values[i], sizeof bits);
    const std::uint32_t sign = bits >> 16 & 0x8000U;
    bits &= 0x7fffffffU;
    float magnitude = 0.0F;
    std::memcpy(&magnitude, &bits, sizeof magnitude);
    const float small = magnitude + 0.5F;
    std::uint32_t denormal = 0;
    std::memcpy(&denormal, &small, sizeof denormal);
    denormal -= 0x3f000000U;
    const std::uint32_t normal = (bits - (112U << 23) + 0xfffU + (bits >> 13 & 1U)) >> 13;
    std::uint32_t half = bits < smallest_normal ? denormal : normal;
    half = bits >= infinite ? 0x7c00U : half;
    half = bits > 0x7f800000U ? 0x7e00U : half;
    halves[i] = static_cast<std::uint16_t>(half | sign);
  }
}

/// Moves the active values to the front. @return their number
template <class T> std::size_t gather(const LeafMask& mask, std::array<T, leaf_voxels>& values) {
  if (mask.is_full()) {
    return leaf_voxels;
  }
  std::size_t count = 0;
  mask.each([&](std::size_t voxel) { values[count++] = values[voxel]; });
  return count;
}

} // namespace

void LeafWriter::write(const LeafMask& mask, const LeafValues& values) {
  if (half_) {
    to_half(values, halves_);
    const std::size_t count = gather(mask, halves_);
    put(mask, reinterpret_cast<const char*>(halves_.data()), sizeof halves_[0], count);
  } else {
    values_ = values;
    const std::size_t count = gather(mask, values_);
    put(mask, reinterpret_cast<const char*>(values_.data()), sizeof values_[0], count);
  }
}

void LeafWriter::put(const LeafMask& mask, const char* values, std::size_t value_size,
                     std::size_t count) {
  stream_.write(reinterpret_cast<const char*>(mask.words.data()), sizeof mask.words);
  stream_.put(0); // openvdb::io::NO_MASK_OR_INACTIVE_VALS
  const std::string_view bytes(values, count * value_size);
  if (bytes == known_) {
    stream_ << known_bytes_; // neighbouring leaves deep in smoke are often identical
    return;
  }
  const auto before = static_cast<std::size_t>(stream_.tellp());
  compress_(stream_, values, value_size, count);
  known_bytes_ = stream_.view().substr(before);
  known_ = bytes;
}

} // namespace firetwin::volume
