#pragma once

#include "documentation.hpp"

#include <pybind11/pybind11.h>

#include <string>

namespace firetwin::bindings {

/// Decodes text for messages: bytes that are not UTF-8, as in some file names, become \xNN.
pybind11::str readable(const std::string& bytes);

void init_errors(Module& module);
void init_constants(Module module);
void init_geo(Module module);
void init_run(Module module);
void init_flux(Module module);
void init_lod(Module module);
void init_forest(Module module);
void init_particles(Module module);
void init_terrain(Module module);
void init_march(Module module);
void init_flames(Module module);
void init_smoke(Module module);
void init_volume(Module module);
void init_sensor(Module module);
void init_flow(Module module);
void init_flow_detail(Module module);
void init_tiles(Module module);
void init_tiles_heights(Module module);
void init_tiles_select(Module module);

} // namespace firetwin::bindings
