# Quick builds, of wheels too: third-party headers are precompiled, the files of a folder are compiled together (unity build),
# and code that does not compute (bindings, the topology of VDB files) is compiled with -O1.
# The presets `release` and `asan` build without this, which reveals missing #includes. In a unity build, the names in the
# anonymous namespaces of a folder must be unique.
option(FIRETWIN_QUICK_BUILD "Build quickly: precompiled headers, unity builds, bindings with -O1" OFF)

function(firetwin_quick_build target name)
  if(NOT FIRETWIN_QUICK_BUILD)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False alarms: GCC does not recognise precompiled standard headers as system headers (the first three), and expects
    # an anonymous namespace in the main file only (the others).
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds -Wno-shadow
      -Wno-subobject-linkage)
    # The compiler's garbage collection takes a twelfth of its time; without this it starts at 128 MB.
    target_compile_options(${target} PRIVATE "SHELL:--param ggc-min-heapsize=524288")
  endif()
  set(headers <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numbers> <numeric> <optional>
    <span> <stdexcept> <string> <utility> <vector> <oneapi/tbb/parallel_for.h>)
  if(WIN32)
    list(PREPEND headers "${CMAKE_SOURCE_DIR}/cpp/base/windows.hpp")
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  if(name STREQUAL "base")
    target_precompile_headers(${target} PRIVATE ${headers})
    target_link_libraries(${target} PRIVATE TBB::tbb) # only for its headers
  elseif(name STREQUAL "bindings")
    target_precompile_headers(${target} PRIVATE ${headers} <pybind11/numpy.h> <pybind11/stl.h> <pybind11/stl/filesystem.h>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 7)
    set_source_files_properties(${documentation} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
    target_compile_options(${target} PRIVATE -O1)
  else()
    target_precompile_headers(${target} REUSE_FROM firetwin_base)
  endif()
  if(name STREQUAL "volume")
    set_source_files_properties(volume/archive.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # the only file with OpenVDB
    # GCC 16 does not accept a precompiled header of another optimisation level.
    set_source_files_properties(volume/archive.cpp PROPERTIES COMPILE_OPTIONS -O1 SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()
