#include "run/npy.hpp"

#include "io/name.hpp"
#include "run/npy_header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace firetwin::run {
namespace {

static_assert(std::endian::native == std::endian::little, "npy files are read as little-endian");

constexpr std::size_t longest_header = 1 << 20;

[[noreturn]] void fail(const io::File& file, const std::string& reason) {
  io::fail(file.path(), reason);
}

/// Number of bytes, or nothing where it overflows.
std::optional<std::uint64_t> bytes_of(std::span<const std::size_t> shape, std::size_t item_size) {
  std::uint64_t total = item_size;
  for (const std::size_t n : shape) {
    if (n != 0 && total > std::numeric_limits<std::uint64_t>::max() / n) {
      return std::nullopt;
    }
    total *= n;
  }
  return total;
}

struct Prefix {
  std::size_t header_offset;
  std::size_t header_size;
};

Prefix read_prefix(const io::File& file) {
  std::array<char, 12> start{};
  const std::size_t have = std::min<std::uint64_t>(file.size(), start.size());
  file.read(0, std::span(start).first(have));
  if (have < 10 || std::memcmp(start.data(), "\x93NUMPY", 6) != 0) {
    fail(file, "is not a .npy file; save the array with numpy.save");
  }
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(start[i])};
  };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3 || (version > 1 && have < 12)) {
    fail(file, "has an unknown .npy version; save the array again with numpy.save");
  }
  if (version == 1) {
    return {10, byte(8) | byte(9) << 8};
  }
  return {12, byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24};
}

NpyHeader read_header(const io::File& file, const Prefix& prefix) {
  if (prefix.header_size > longest_header ||
      prefix.header_offset + prefix.header_size > file.size()) {
    fail(file, "the .npy header is cut off; copy the file again");
  }
  std::vector<char> text(prefix.header_size);
  file.read(prefix.header_offset, text);
  return parse_npy_header({text.data(), text.size()}, prefix.header_offset, io::utf8(file.path()));
}

std::size_t item_size(const io::File& file, const std::string& descr) {
  if (descr == "<f4") {
    return 4;
  }
  if (descr == "<f8") {
    return 8;
  }
  if (descr.find('O') != std::string::npos) {
    fail(file, "holds Python objects, which are never loaded; save it with astype('<f4')");
  }
  fail(file, "has type '" + descr + "' where '<f4' or '<f8' is needed; save it with astype('<f4')");
}

} // namespace

NpyFile::NpyFile(const std::filesystem::path& path) : file_(path) {
  const Prefix prefix = read_prefix(file_);
  NpyHeader header = read_header(file_, prefix);
  item_size_ = item_size(file_, header.descr);
  if (header.fortran_order && header.shape.size() > 1) {
    fail(file_, "is in Fortran order; save it with numpy.ascontiguousarray");
  }
  shape_ = std::move(header.shape);
  data_offset_ = prefix.header_offset + prefix.header_size;
  const auto bytes = bytes_of(shape_, item_size_);
  if (bytes != file_.size() - data_offset_) {
    fail(file_, "its header says " + shape_text(shape_) + " of " + std::to_string(item_size_) +
                    " bytes each, but " + std::to_string(file_.size() - data_offset_) +
                    " bytes of data follow; copy or save the file again");
  }
}

void NpyFile::read(std::uint64_t first, std::span<float> out) const {
  if (item_size_ == 4) {
    file_.read(data_offset_ + 4 * first, {reinterpret_cast<char*>(out.data()), out.size() * 4});
    return;
  }
  std::vector<double> wide(out.size());
  read(first, std::span(wide));
  for (std::size_t i = 0; i < wide.size(); ++i) {
    // The largest double that still rounds to a finite float is just below 2^128 - 2^103.
    if (std::isfinite(wide[i]) && std::abs(wide[i]) >= 0x1.ffffffp127) {
      fail(file_,
           "value " + std::to_string(first + i) +
               " of the flattened array is too large for a 32-bit float; use nan or no_data");
    }
    out[i] = static_cast<float>(wide[i]);
  }
}

void NpyFile::read(std::uint64_t first, std::span<double> out) const {
  if (item_size_ == 8) {
    file_.read(data_offset_ + 8 * first, {reinterpret_cast<char*>(out.data()), out.size() * 8});
    return;
  }
  std::vector<float> narrow(out.size());
  read(first, std::span(narrow));
  std::copy(narrow.begin(), narrow.end(), out.begin());
}

std::string shape_text(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i ? ", " : "") + std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

} // namespace firetwin::run
