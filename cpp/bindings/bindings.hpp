#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace firetwin::bindings {

/// For people to read: bytes that are not UTF-8, as in some file names, are shown as \xNN.
pybind11::str readable(const std::string& bytes);

void init_errors(pybind11::module_& module);
void init_geo(pybind11::module_ module);
void init_run(pybind11::module_ module);
void init_flux(pybind11::module_ module);
void init_lod(pybind11::module_ module);
void init_forest(pybind11::module_ module);
void init_particles(pybind11::module_ module);
void init_volume(pybind11::module_ module);
void init_sensor(pybind11::module_ module);
void init_flow(pybind11::module_ module);
void init_flow_detail(pybind11::module_ module);

} // namespace firetwin::bindings
