# The static libraries that vcpkg builds from vcpkg.json, on Windows and macOS.
find_package(TBB CONFIG REQUIRED)
find_package(OpenVDB CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
find_package(GeographicLib CONFIG REQUIRED)

target_link_libraries(firetwin_libraries INTERFACE OpenVDB::openvdb OpenImageIO::OpenImageIO
  ${GeographicLib_LIBRARIES} TBB::tbb)
target_compile_definitions(firetwin_libraries INTERFACE __TBB_USE_CONSTRAINTS=0)
if(APPLE)
  # What the libraries hold must not meet the OpenVDB, TBB and OpenImageIO inside Blender.
  target_link_options(firetwin_libraries INTERFACE -Wl,-exported_symbol,_PyInit_firetwin_core -Wl,-dead_strip)
  # std::jthread is still behind this switch in Apple's standard library.
  target_compile_definitions(firetwin_libraries INTERFACE _LIBCPP_ENABLE_EXPERIMENTAL)
endif()

# Each library's licence goes into the wheel beside its code.
if(SKBUILD)
  file(GLOB copyrights "${VCPKG_INSTALLED_DIR}/${VCPKG_TARGET_TRIPLET}/share/*/copyright")
  foreach(copyright IN LISTS copyrights)
    cmake_path(GET copyright PARENT_PATH folder)
    cmake_path(GET folder FILENAME library)
    install(FILES "${copyright}" DESTINATION "${SKBUILD_METADATA_DIR}/licenses/libraries/${library}" COMPONENT core)
  endforeach()
endif()
