// cmpt. The first byte says whether the rest is the whole file; what two contents are within one,
// each of them a line; or how often one is wrapped.

#include "tile_checks.hpp"

namespace {

using namespace firetwin::fuzz;

std::string composite(const std::string& inner, std::size_t count) {
  return "cmpt" + word(1) + word(16 + inner.size()) + word(count) + inner;
}

std::string content(std::uint8_t form, std::string_view rest) {
  if (form % 3 == 0) {
    return std::string(rest);
  }
  if (form % 3 == 1) {
    const auto [points, binary, json, buffer] = parts<4>(rest);
    return composite(with_tables("pnts", points, binary, "") + glb(json, buffer), 2);
  }
  std::string wrapped(rest);
  for (int i = 0; i < form / 3 % 12; ++i) {
    wrapped = composite(wrapped, 1);
  }
  return wrapped;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1) {
    check_content(content(data[0], {reinterpret_cast<const char*>(data + 1), size - 1}));
  }
  return 0;
}
