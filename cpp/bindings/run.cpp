#include "bindings.hpp"

namespace firetwin::bindings {
namespace py = pybind11;

void init_run(py::module_ module) { module.doc() = ""; }

} // namespace firetwin::bindings
