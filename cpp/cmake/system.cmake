# The shared libraries of a Linux distribution. Debian's CMake files for OpenVDB and OpenImageIO require packages that
# are not needed here (Boost.Iostreams, PyImath, OpenCV).
find_package(TBB CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(Imath REQUIRED IMPORTED_TARGET Imath)
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
find_path(OPENIMAGEIO_INCLUDE_DIR OpenImageIO/imageio.h REQUIRED)
find_library(OPENIMAGEIO_LIBRARY OpenImageIO REQUIRED)
find_library(OPENIMAGEIO_UTIL_LIBRARY OpenImageIO_Util REQUIRED)
find_path(GEOGRAPHICLIB_INCLUDE_DIR GeographicLib/LocalCartesian.hpp REQUIRED)
find_library(GEOGRAPHICLIB_LIBRARY NAMES GeographicLib Geographic REQUIRED)

foreach(library openvdb openimageio geographiclib)
  add_library(library::${library} INTERFACE IMPORTED)
endforeach()
target_link_libraries(library::openvdb INTERFACE ${OPENVDB_LIBRARY} PkgConfig::Imath TBB::tbb)
target_link_libraries(library::openimageio INTERFACE ${OPENIMAGEIO_LIBRARY} ${OPENIMAGEIO_UTIL_LIBRARY} PkgConfig::Imath)
target_link_libraries(library::geographiclib INTERFACE ${GEOGRAPHICLIB_LIBRARY})
target_include_directories(library::openvdb INTERFACE ${OPENVDB_INCLUDE_DIR})
target_include_directories(library::openimageio INTERFACE ${OPENIMAGEIO_INCLUDE_DIR})
target_include_directories(library::geographiclib INTERFACE ${GEOGRAPHICLIB_INCLUDE_DIR})

# OpenVDB's registry of types breaks if its inline statics are hidden or unique to one library:
# default visibility and -fno-gnu-unique are both needed (openvdb#1583).
# -fno-semantic-interposition: functions with default visibility can still be inlined.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-fno-gnu-unique -fno-semantic-interposition)
endif()
