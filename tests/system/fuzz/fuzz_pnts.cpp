// pnts. The first byte says whether the rest is the whole file, or its feature table's two parts.

#include "tile_checks.hpp"

namespace {

using namespace firetwin::fuzz;

std::string content(std::uint8_t form, std::string_view rest) {
  if (form % 2 == 0) {
    return std::string(rest);
  }
  const auto [table, binary] = parts<2>(rest);
  return with_tables("pnts", table, binary, "");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1) {
    check_content(content(data[0], {reinterpret_cast<const char*>(data + 1), size - 1}));
  }
  return 0;
}
