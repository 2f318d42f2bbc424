# One module for each Python, of which only the headers are required. Everything but the bindings is compiled once.
set(FIRETWIN_PYTHONS "" CACHE STRING "Versions of Python to build for, such as 3.11;3.13")
set(FIRETWIN_PYTHON_HEADERS "" CACHE PATH "Folder with python3.11/usr/include and so on")

foreach(python IN LISTS FIRETWIN_PYTHONS)
  string(REPLACE "." "" digits ${python})
  set(module firetwin_core_${digits})
  set(headers "${FIRETWIN_PYTHON_HEADERS}/python${python}/usr/include")
  add_library(${module} MODULE ${binding_sources})
  # Debian has the processor-dependent header in a separate folder below the second of these.
  target_include_directories(${module} SYSTEM PRIVATE "${headers}/python${python}" "${headers}")
  set_target_properties(${module} PROPERTIES PREFIX "" OUTPUT_NAME firetwin_core
    SUFFIX ".cpython-${digits}-x86_64-linux-gnu.so" LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${python}")
  install(TARGETS ${module} LIBRARY DESTINATION . COMPONENT core-${python})
  list(APPEND modules ${module})
endforeach()
