// run.toml alone: a description whose values keep their promises, or an InputError.

#include "check.hpp"
#include "memory_file.hpp"
#include "run/description.hpp"

#include <cmath>
#include <cstdint>

namespace {

using namespace firetwin;

void read(const std::filesystem::path& path) {
  const run::Description m = run::read_description(path);
  fuzz::check(m.interval_s.has_value() != !m.times_s.empty(), "times come in one of two ways");
  fuzz::check(!m.interval_s || (std::isfinite(*m.interval_s) && *m.interval_s > 0), "interval_s");
  for (std::size_t i = 0; i < m.times_s.size(); ++i) {
    fuzz::check(std::isfinite(m.times_s[i]) && (i == 0 || m.times_s[i] > m.times_s[i - 1]),
                "times ascend");
  }
  fuzz::check(m.vertical == "orthometric" || m.vertical == "ellipsoidal", "vertical");
  fuzz::check(!m.no_data || std::isfinite(*m.no_data), "no_data");
  fuzz::check(m.start.size() >= 20 && m.start.back() == 'Z', "start is UTC");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile memory;
  memory.write({reinterpret_cast<const char*>(data), size});
  fuzz::expect_result_or_input_error([] { read(memory.path()); });
  return 0;
}
