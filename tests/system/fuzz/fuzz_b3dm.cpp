// b3dm. The first byte says whether the rest is the whole file; a header of 1.0 or of one of the
// two older kinds around glTF; or the parts of all that.

#include "tile_checks.hpp"

namespace {

using namespace firetwin::fuzz;

/// A header of 20 or of 24 bytes, with a batch table.
std::string legacy(const std::string& batch, const std::string& body, bool longer) {
  const std::size_t size = (longer ? 24 : 20) + batch.size() + body.size();
  const std::string tables =
      longer ? word(batch.size()) + word(0) + word(1) : word(1) + word(batch.size());
  return "b3dm" + word(1) + word(size) + tables + batch + body;
}

std::string content(std::uint8_t form, std::string_view rest) {
  if (form % 4 == 0) {
    return std::string(rest);
  }
  const auto [table, binary, json, buffer] = parts<4>(rest);
  const std::string body = glb(json, buffer);
  return form % 4 == 1 ? with_tables("b3dm", table, binary, body)
                       : legacy(table, body, form % 4 == 2);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1) {
    check_content(content(data[0], {reinterpret_cast<const char*>(data + 1), size - 1}));
  }
  return 0;
}
