# Headers of other projects, read once instead of once per file: two thirds of the time that most files take to compile.
# What is built to be given away compiles without, and so finds a missing #include.
option(FIRETWIN_PRECOMPILE "Precompile the headers of other projects" OFF)

if(FIRETWIN_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds) # false alarms of GCC, which takes the standard library for our code here
endif()

set(FIRETWIN_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numbers> <numeric>
  <optional> <span> <stdexcept> <string> <utility> <vector> <oneapi/tbb/parallel_for.h>)

function(firetwin_precompile target name)
  if(NOT FIRETWIN_PRECOMPILE)
    return()
  endif()
  if(name STREQUAL "base")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS})
  elseif(name STREQUAL "volume")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS} <openvdb/openvdb.h>)
  elseif(name STREQUAL "bindings")
    target_precompile_headers(${target} PRIVATE ${FIRETWIN_HEADERS} <pybind11/numpy.h> <pybind11/stl.h> <pybind11/stl/filesystem.h>)
  else()
    target_precompile_headers(${target} REUSE_FROM firetwin_base)
  endif()
endfunction()
