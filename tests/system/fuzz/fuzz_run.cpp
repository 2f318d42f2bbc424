// A whole run folder with one of its files replaced: the first byte says which, the rest is the
// file.

#include "check.hpp"
#include "flux/arrival.hpp"
#include "run/run.hpp"

#include <oneapi/tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace {

using namespace firetwin;
namespace fs = std::filesystem;

const std::array<std::pair<std::string, std::string>, 9> files = {{
    {"latitude.txt", "38.7 38.8\n"},
    {"longitude.txt", "-120.6 -120.5 -120.4\n"},
    {"elevation.txt", "900 910 920\n930 940 950\n"},
    {"fuel_latitude.txt", "38.7 38.75 38.8\n"},
    {"fuel_longitude.txt", "-120.6 -120.4\n"},
    {"surface_fuel.txt", "1 2\n3 4\n5 6\n"},
    {"canopy_fuel.txt", "0 1\n0 1\n2 3\n"},
    {"heat_flux/000000.txt", "0 5 0\n0 0 0\n"},
    {"heat_flux/000001.txt", "0 5 1D3\n0 nan -1\n"},
}};

void write(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

/// A folder in memory, if the system has one; removed at the end of the process.
class RunFolder {
public:
  RunFolder() {
    const fs::path memory = "/dev/shm";
    const fs::path place = fs::is_directory(memory) ? memory : fs::temp_directory_path();
    std::string name = (place / "firetwin_fuzz_XXXXXX").string();
    fuzz::check(::mkdtemp(name.data()) != nullptr, "a temporary folder can be made");
    path_ = name;
    fs::create_directory(path_ / "heat_flux");
    for (const auto& [file, content] : files) {
      write(path_ / file, content);
    }
  }
  ~RunFolder() {
    std::error_code code;
    fs::remove_all(path_, code);
  }
  const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

void open(const fs::path& folder) {
  run::Description description;
  description.interval_s = 60.0;
  description.no_data = -9999.0;
  const run::Run run(folder, description);
  const std::vector<double>& times = run.times();
  for (std::size_t i = 0; i < times.size(); ++i) {
    fuzz::check(std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1]), "times ascend");
  }
  fuzz::check(run.elevation().size() == run.cells(), "elevation has every cell");
  const std::vector<double>& east = run.longitude();
  fuzz::check(std::abs(east.front() + east.back()) <= 360.0,
              "longitudes have their middle in +-180");
  fuzz::check(std::abs(east.back() - east.front()) <= 360.0, "longitudes go around once at most");
  const auto [low, high] = run.flux_range();
  fuzz::check(std::isfinite(low) && std::isfinite(high) && low <= high, "a range is a range");
  fuzz::check(flux::arrival_time(run).size() == run.cells(), "arrival has every cell");
  fuzz::check(flux::fuel_arrival_time(run).size() == run.surface_fuel().values().size(),
              "fuel arrival too");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A second thread would only wait for the first: the grids have six cells.
  static const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  static const RunFolder folder;
  if (size == 0) {
    return 0;
  }
  const auto& [name, content] = files[data[0] % files.size()];
  write(folder.path() / name, std::string(reinterpret_cast<const char*>(data + 1), size - 1));
  fuzz::expect_result_or_input_error([] { open(folder.path()); });
  write(folder.path() / name, content);
  return 0;
}
