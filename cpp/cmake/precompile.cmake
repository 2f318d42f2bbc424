# For a build on this machine that is there soon: headers of other projects are read once instead of once per file, and files
# that instantiate the same templates are compiled together. Wheels are built without, and so find a missing #include.
option(FIRETWIN_PRECOMPILE "Precompile the headers of other projects" OFF)

if(FIRETWIN_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms: GCC takes a precompiled standard library for our code.
  add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
endif()

set(FIRETWIN_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numbers> <numeric>
  <optional> <span> <stdexcept> <string> <utility> <vector> <oneapi/tbb/parallel_for.h>)

# Compiles these files of a target as one.
function(firetwin_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${target})
endfunction()

function(firetwin_precompile target name)
  if(NOT FIRETWIN_PRECOMPILE)
    return()
  endif()
  if(name STREQUAL "base")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS})
  elseif(name STREQUAL "volume")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS} <openvdb/openvdb.h>)
    firetwin_together(${target} volume/grids.cpp volume/fog.cpp volume/level_leaves.cpp)
  elseif(name STREQUAL "bindings")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS} <pybind11/numpy.h> <pybind11/stl.h> <pybind11/stl/filesystem.h>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
  else()
    target_precompile_headers(${target} REUSE_FROM firetwin_base)
  endif()
endfunction()
