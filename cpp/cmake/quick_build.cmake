# Quick builds on this machine: third-party headers are precompiled, files that instantiate the same templates are compiled
# together (unity build), and the bindings are compiled with -O1, as the libraries do the computing.
# Wheels are built without this, which reveals missing #includes.
option(FIRETWIN_QUICK_BUILD "Build quickly: precompiled headers, unity builds, bindings with -O1" OFF)

function(firetwin_quick_build target name)
  if(NOT FIRETWIN_QUICK_BUILD)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False alarms: GCC does not recognise precompiled standard headers as system headers.
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
  endif()
  set(headers <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numbers> <numeric> <optional>
    <span> <stdexcept> <string> <utility> <vector> <oneapi/tbb/parallel_for.h>)
  if(name STREQUAL "base")
    target_precompile_headers(${target} PRIVATE ${headers})
  elseif(name STREQUAL "volume")
    target_precompile_headers(${target} PRIVATE ${headers} <openvdb/openvdb.h>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    set_source_files_properties(volume/grids.cpp volume/fog.cpp volume/level_leaves.cpp PROPERTIES UNITY_GROUP leaves)
  elseif(name STREQUAL "bindings")
    target_precompile_headers(${target} PRIVATE ${headers} <pybind11/numpy.h> <pybind11/stl.h> <pybind11/stl/filesystem.h>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
    if(NOT MSVC)
      target_compile_options(${target} PRIVATE -O1)
    endif()
  else()
    target_precompile_headers(${target} REUSE_FROM firetwin_base)
  endif()
endfunction()
