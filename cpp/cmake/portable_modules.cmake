# One module for each Python, of which only the headers are required. Everything but the bindings is compiled once.
set(FIRETWIN_PYTHONS "" CACHE STRING "Versions of Python to build for, such as 3.11;3.13")
set(FIRETWIN_PYTHON_HEADERS "" CACHE PATH "Folder with the files of python3.11 and so on")

foreach(python IN LISTS FIRETWIN_PYTHONS)
  string(REPLACE "." "" digits ${python})
  set(module firetwin_core_${digits})
  set(folder "${FIRETWIN_PYTHON_HEADERS}/python${python}")
  add_library(${module} MODULE ${binding_sources})
  if(WIN32)
    set(folder "${folder}/org/bytedeco/cpython/windows-x86_64")
    set(suffix ".cp${digits}-win_amd64.pyd")
    target_include_directories(${module} SYSTEM PRIVATE "${folder}/include")
    target_link_libraries(${module} PRIVATE "${folder}/libs/python${digits}.lib")
  else()
    # Debian has the processor-dependent header in a separate folder below the second of these.
    target_include_directories(${module} SYSTEM PRIVATE "${folder}/usr/include/python${python}" "${folder}/usr/include")
    set(suffix ".cpython-${digits}-x86_64-linux-gnu.so")
  endif()
  set_target_properties(${module} PROPERTIES PREFIX "" OUTPUT_NAME firetwin_core SUFFIX "${suffix}"
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${python}")
  install(TARGETS ${module} LIBRARY DESTINATION . COMPONENT core-${python})
  list(APPEND modules ${module})
endforeach()
