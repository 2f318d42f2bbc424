#include "bindings.hpp"
#include "volume/archive.hpp"

#include <OpenImageIO/imageio.h>
#include <oneapi/tbb/global_control.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <stdexcept>
#include <string>

namespace py = pybind11;

namespace {

/// Limits the worker threads of every function in this module; 0: all cores.
void set_threads(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  if (threads < 0) {
    throw std::invalid_argument("threads must be 0 (all cores) or more");
  }
  limit.reset();
  if (threads > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
  }
}

std::map<std::string, std::string> build_info() {
  return {{"compiler", FIRETWIN_COMPILER},
          {"openvdb", firetwin::volume::openvdb_version()},
          {"openimageio", OIIO_VERSION_STRING},
          {"tbb", TBB_runtime_version()}};
}

} // namespace

PYBIND11_MODULE(firetwin_core, whole) {
  namespace bindings = firetwin::bindings;
  py::options options;
  options.disable_function_signatures(); // the docstrings begin with the signature, in the format
                                         // of Python's C functions
  bindings::Module module(whole);
  module.attr("__version__") = FIRETWIN_VERSION;
  module.def("set_threads", &set_threads, py::arg("threads"));
  module.def("build_info", &build_info);
  bindings::init_errors(module);
  bindings::init_constants(module.def_submodule("constants"));
  bindings::init_geo(module.def_submodule("geo"));
  bindings::init_run(module.def_submodule("run"));
  bindings::init_flux(module.def_submodule("flux"));
  bindings::init_lod(module.def_submodule("lod"));
  bindings::init_forest(module.def_submodule("forest"));
  bindings::init_particles(module.def_submodule("particles"));
  bindings::init_terrain(module.def_submodule("terrain"));
  auto volume = module.def_submodule("volume");
  bindings::init_volume(volume);
  bindings::init_flames(module.def_submodule("flames"));
  bindings::init_march(volume);
  bindings::init_smoke(volume);
  bindings::init_sensor(module.def_submodule("sensor"));
  auto flow = module.def_submodule("flow");
  bindings::init_flow(flow);
  bindings::init_flow_detail(flow);
  auto tiles = module.def_submodule("tiles");
  bindings::init_tiles(tiles);
  bindings::init_tiles_heights(tiles);
  bindings::init_tiles_select(tiles);
}
