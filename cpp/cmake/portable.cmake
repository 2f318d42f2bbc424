# The static libraries of cpp/portable/libraries.sh. The module shows nothing but its entry: with its OpenVDB, TBB or
# OpenImageIO visible, the ones inside Blender and these would use each other's functions and crash.
find_package(TBB CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
find_package(GeographicLib CONFIG REQUIRED)
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
foreach(name openvdb blosc lz4 boost_thread jpeg deflate z)
  find_library(${name}_LIBRARY ${name} REQUIRED)
endforeach()
# What a static libtiff needs, which nothing else tells.
set_property(TARGET TIFF::TIFF APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${jpeg_LIBRARY} ${deflate_LIBRARY} ${z_LIBRARY})
set_property(TARGET OpenImageIO::OpenImageIO APPEND PROPERTY INTERFACE_LINK_LIBRARIES ${boost_thread_LIBRARY})

target_link_libraries(firetwin_libraries INTERFACE ${openvdb_LIBRARY} ${blosc_LIBRARY} ${lz4_LIBRARY} ${z_LIBRARY}
  OpenImageIO::OpenImageIO ${GeographicLib_LIBRARIES} TBB::tbb)
target_include_directories(firetwin_libraries SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR})
# oneTBB's concepts reject what OpenVDB 10 passes to it in C++20.
target_compile_definitions(firetwin_libraries INTERFACE __TBB_USE_CONSTRAINTS=0 OIIO_STATIC_DEFINE
  OPENVDB_STATICLIB)
# Without -z nodynamic-undefined-weak Blender's allocator would step in for TBB's, which is left out.
target_link_options(firetwin_libraries INTERFACE -Wl,--exclude-libs,ALL
  -Wl,--version-script,${CMAKE_SOURCE_DIR}/cpp/portable/exports.map -Wl,-z,nodynamic-undefined-weak
  -Wl,--strip-all)
