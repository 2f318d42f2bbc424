#include "run/npy.hpp"

#include "io/name.hpp"
#include "run/npy_header.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace firetwin::run {
namespace {

constexpr std::size_t max_header_length = 1 << 20;
constexpr std::size_t block_bytes = 1 << 20; ///< block size of reads with conversion
/// In Fortran order, values farther apart are read one by one: a system call costs about as much as
/// copying this many bytes.
constexpr std::size_t near_bytes = 2048;

[[noreturn]] void fail(const io::File& file, const std::string& reason) {
  io::fail(file.path(), reason);
}

/// Number of bytes; empty on overflow.
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
  if (prefix.header_size > max_header_length ||
      prefix.header_offset + prefix.header_size > file.size()) {
    fail(file, "the .npy header is truncated; copy the file again");
  }
  std::vector<char> text(prefix.header_size);
  file.read(prefix.header_offset, text);
  return parse_npy_header({text.data(), text.size()}, prefix.header_offset, io::utf8(file.path()));
}

NpyItem item_of(const io::File& file, const std::string& descr) {
  if (const auto item = parse_item(descr)) {
    return *item;
  }
  if (descr.find('O') != std::string::npos) {
    fail(file, "holds Python objects, which are never loaded; save it with astype('<f4')");
  }
  fail(file, "has type '" + descr +
                 "' where integers, '<f4' or '<f8' are needed; save it with astype('<f4')");
}

/// Iterates over array elements in Fortran order and gives their index in C order.
class Places {
public:
  explicit Places(std::span<const std::size_t> shape)
      : shape_(shape), index_(shape.size(), 0), stride_(shape.size(), 1) {
    for (std::size_t axis = shape.size(); axis-- > 1;) {
      stride_[axis - 1] = stride_[axis] * shape[axis];
    }
  }

  std::size_t next() {
    const std::size_t place = place_;
    for (std::size_t axis = 0; axis < shape_.size(); ++axis) {
      place_ += stride_[axis];
      if (++index_[axis] < shape_[axis]) {
        break;
      }
      place_ -= stride_[axis] * shape_[axis];
      index_[axis] = 0;
    }
    return place;
  }

private:
  std::span<const std::size_t> shape_;
  std::vector<std::size_t> index_, stride_;
  std::size_t place_ = 0;
};

} // namespace

NpyFile::NpyFile(const std::filesystem::path& path) : file_(path) {
  const Prefix prefix = read_prefix(file_);
  NpyHeader header = read_header(file_, prefix);
  item_ = item_of(file_, header.descr);
  shape_ = std::move(header.shape);
  fortran_order_ = header.fortran_order && shape_.size() > 1;
  data_offset_ = prefix.header_offset + prefix.header_size;
  const auto bytes = bytes_of(shape_, item_.size);
  if (bytes != file_.size() - data_offset_) {
    fail(file_, "its header says " + shape_text(shape_) + " of " + std::to_string(item_.size) +
                    " bytes each, but " + std::to_string(file_.size() - data_offset_) +
                    " bytes of data follow; copy or save the file again");
  }
  const std::size_t values = *bytes / item_.size;
  part_ = shape_.empty() || values == 0 ? 1 : values / shape_.front();
}

void NpyFile::read(std::size_t first, std::span<float> out) const {
  read_as(first, out);
}

void NpyFile::read(std::size_t first, std::span<double> out) const {
  read_as(first, out);
}

template <class T> void NpyFile::read_as(std::size_t first, std::span<T> out) const {
  if (out.empty()) {
    return;
  }
  const std::uint64_t begin = std::uint64_t{first} * part_;
  const bool as_it_is = item_.kind == 'f' && item_.size == sizeof(T) && !item_.swapped;
  const std::span<char> raw(reinterpret_cast<char*>(out.data()), out.size_bytes());
  if (fortran_order_ && as_it_is) {
    gather(first, out.size() / part_, raw);
  } else if (fortran_order_) {
    std::vector<char> bytes(out.size() * item_.size);
    gather(first, out.size() / part_, bytes);
    convert_values(begin, bytes, out);
  } else if (as_it_is) {
    file_.read(data_offset_ + begin * item_.size, raw);
  } else {
    const std::size_t at_once = block_bytes / item_.size;
    std::vector<char> bytes(std::min(out.size(), at_once) * item_.size);
    for (std::size_t done = 0; done < out.size(); done += at_once) {
      const auto part = out.subspan(done, std::min(at_once, out.size() - done));
      const auto block = std::span(bytes).first(part.size() * item_.size);
      file_.read(data_offset_ + (begin + done) * item_.size, block);
      convert_values(begin + done, block, part);
    }
  }
}

template <class T>
void NpyFile::convert_values(std::uint64_t begin, std::span<const char> bytes,
                             std::span<T> out) const {
  if (const auto too_large = convert(item_, bytes, out)) {
    fail(file_, "value " + std::to_string(begin + *too_large) +
                    " of the flattened array is too large for a 32-bit float; use nan or no_data");
  }
}

/// Gathers array[first : first + count] of a file in Fortran order, as bytes in C order.
void NpyFile::gather(std::size_t first, std::size_t count, std::span<char> out) const {
  const std::size_t size = item_.size, row = shape_.front() * size;
  const bool together = count == shape_.front() || row <= near_bytes;
  const std::size_t rows = together ? std::max<std::size_t>(block_bytes / row, 1) : 1;
  Places places{std::span(shape_).subspan(1)};
  std::vector<char> block;
  for (std::size_t done = 0; done < part_; done += rows) {
    const std::size_t now = std::min(rows, part_ - done);
    block.resize((now - 1) * row + count * size);
    file_.read(data_offset_ + done * row + first * size, block);
    for (std::size_t i = 0; i < now; ++i) {
      const std::size_t place = places.next();
      for (std::size_t j = 0; j < count; ++j) {
        std::memcpy(&out[(j * part_ + place) * size], &block[i * row + j * size], size);
      }
    }
  }
}

std::string shape_text(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i ? ", " : "") + std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

} // namespace firetwin::run
