# The static libraries that vcpkg builds from vcpkg.json, on macOS.
find_package(TBB CONFIG REQUIRED)
find_package(OpenVDB CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
find_package(GeographicLib CONFIG REQUIRED)

foreach(library openvdb openimageio geographiclib)
  add_library(library::${library} INTERFACE IMPORTED)
endforeach()
target_link_libraries(library::openvdb INTERFACE OpenVDB::openvdb TBB::tbb)
target_link_libraries(library::openimageio INTERFACE OpenImageIO::OpenImageIO)
target_link_libraries(library::geographiclib INTERFACE ${GeographicLib_LIBRARIES})
add_compile_definitions(__TBB_USE_CONSTRAINTS=0)
if(APPLE)
  # Symbols of these libraries must not clash with the OpenVDB, TBB and OpenImageIO of Blender.
  add_link_options(-Wl,-exported_symbol,_PyInit_firetwin_core -Wl,-dead_strip)
  # Apple's standard library still requires this switch for std::jthread.
  add_compile_definitions(_LIBCPP_ENABLE_EXPERIMENTAL)
endif()

# The wheel contains the licence of each library.
if(SKBUILD)
  file(GLOB copyrights "${VCPKG_INSTALLED_DIR}/${VCPKG_TARGET_TRIPLET}/share/*/copyright")
  foreach(copyright IN LISTS copyrights)
    cmake_path(GET copyright PARENT_PATH folder)
    cmake_path(GET folder FILENAME library)
    install(FILES "${copyright}" DESTINATION "${SKBUILD_METADATA_DIR}/licenses/libraries/${library}" COMPONENT core)
  endforeach()
endif()
