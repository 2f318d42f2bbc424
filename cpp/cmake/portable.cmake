# The static libraries of cpp/portable/libraries.sh. The module exports only its init function: if its OpenVDB, TBB or
# OpenImageIO were visible, they and Blender's copies would call each other's functions and crash.
find_package(TBB CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
find_path(GEOGRAPHICLIB_INCLUDE_DIR GeographicLib/LocalCartesian.hpp REQUIRED)
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
foreach(name GeographicLib openvdb blosc lz4 boost_thread jpeg deflate z)
  find_library(${name}_LIBRARY ${name} REQUIRED)
endforeach()
# Dependencies of a static libtiff, which its files do not declare.
set_property(TARGET TIFF::TIFF APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${jpeg_LIBRARY} ${deflate_LIBRARY} ${z_LIBRARY})
set_property(TARGET OpenImageIO::OpenImageIO APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${boost_thread_LIBRARY})

# A target, not a file, so that its dependencies follow it on the link line.
add_library(library::openvdb STATIC IMPORTED)
set_target_properties(library::openvdb PROPERTIES IMPORTED_LOCATION ${openvdb_LIBRARY})
target_link_libraries(library::openvdb INTERFACE ${blosc_LIBRARY} ${lz4_LIBRARY} ${z_LIBRARY} TBB::tbb)
add_library(library::openimageio INTERFACE IMPORTED)
target_link_libraries(library::openimageio INTERFACE OpenImageIO::OpenImageIO)
add_library(library::geographiclib INTERFACE IMPORTED)
target_link_libraries(library::geographiclib INTERFACE ${GeographicLib_LIBRARY})
target_include_directories(library::geographiclib INTERFACE ${GEOGRAPHICLIB_INCLUDE_DIR})
target_include_directories(library::openvdb INTERFACE ${OPENVDB_INCLUDE_DIR})
target_compile_definitions(library::openvdb INTERFACE OPENVDB_STATICLIB)
target_compile_definitions(library::openimageio INTERFACE OIIO_STATIC_DEFINE)
# In C++20, oneTBB's concepts reject arguments that OpenVDB 10 passes.
add_compile_definitions(__TBB_USE_CONSTRAINTS=0)
add_link_options(-Wl,--exclude-libs,ALL -Wl,--version-script,${CMAKE_SOURCE_DIR}/cpp/portable/exports.map -Wl,--strip-all)
if(WIN32)
  # TBB is compiled with a stack protector.
  set_property(TARGET TBB::tbb APPEND PROPERTY INTERFACE_LINK_LIBRARIES ssp)
  # Windows' loader does not choose between versions of a function (base/clones.hpp).
  add_compile_options(-march=x86-64-v3)
else()
  # Without this Blender's allocator would replace TBB's, which is not linked.
  add_link_options(-Wl,-z,nodynamic-undefined-weak)
endif()
