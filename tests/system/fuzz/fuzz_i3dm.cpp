// i3dm. The first byte says whether the rest is the whole file, or parts of one whose model is a
// uri or embedded.

#include "tile_checks.hpp"

namespace {

using namespace firetwin::fuzz;

std::string content(std::uint8_t form, std::string_view rest) {
  if (form % 3 == 0) {
    return std::string(rest);
  }
  const bool embedded = form % 3 == 1;
  const auto [table, binary, model, buffer] = parts<4>(rest);
  return with_tables("i3dm", table, binary, embedded ? glb(model, buffer) : model,
                     word(embedded ? 1 : 0));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1) {
    check_content(content(data[0], {reinterpret_cast<const char*>(data + 1), size - 1}));
  }
  return 0;
}
