// The .npy reader. The first byte says whether the rest is the whole file, or a header up to the
// first newline, with its length set right, and data after it.

#include "check.hpp"
#include "memory_file.hpp"
#include "run/npy.hpp"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace firetwin;

std::string with_prefix(std::string_view content) {
  const std::size_t size = std::min(content.find('\n'), content.size());
  std::string file("\x93NUMPY\x02\x00", 8);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    file += static_cast<char>(size >> shift & 0xFF);
  }
  file += content.substr(0, size);
  file += content.substr(std::min(size + 1, content.size()));
  return file;
}

/// The whole array, which must be its parts one after the other.
template <class T> void read_all(const run::NpyFile& file, std::size_t values) {
  std::vector<T> all(values);
  file.read(0, std::span<T>(all));
  const std::size_t parts = file.shape().empty() ? 1 : file.shape().front();
  if (values == 0 || parts == 0) {
    return;
  }
  std::vector<T> part(values / parts);
  for (const std::size_t index : {std::size_t{0}, parts / 2, parts - 1}) {
    file.read(index, std::span<T>(part));
    fuzz::check(std::memcmp(part.data(), &all[index * part.size()], part.size() * sizeof(T)) == 0,
                "an array is made of its parts");
  }
}

void read(const std::filesystem::path& path, std::size_t bytes) {
  const run::NpyFile file(path);
  std::size_t values = 1;
  for (const std::size_t n : file.shape()) {
    values *= n;
  }
  fuzz::check(values <= bytes, "a header may not claim more than the file holds");
  fuzz::expect_result_or_input_error([&] { read_all<float>(file, values); });
  read_all<double>(file, values);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile memory;
  if (size == 0) {
    return 0;
  }
  const std::string_view rest(reinterpret_cast<const char*>(data + 1), size - 1);
  const std::string content = data[0] % 2 ? with_prefix(rest) : std::string(rest);
  memory.write(content);
  fuzz::expect_result_or_input_error([&] { read(memory.path(), content.size()); });
  return 0;
}
