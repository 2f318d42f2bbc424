# GCC 12 against the glibc of Debian 11 and the libraries of build/portable, not those of this machine.
if(DEFINED ENV{FIRETWIN_PORTABLE})
  set(portable "$ENV{FIRETWIN_PORTABLE}")
else()
  get_filename_component(portable "${CMAKE_CURRENT_LIST_DIR}/../../build/portable" ABSOLUTE)
endif()

set(CMAKE_C_COMPILER gcc-12)
set(CMAKE_CXX_COMPILER g++-12)
set(CMAKE_SYSROOT "${portable}/sysroot")
set(CMAKE_PREFIX_PATH "${portable}/libraries")
set(CMAKE_FIND_ROOT_PATH "${portable}/libraries" "${CMAKE_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_FIND_LIBRARY_SUFFIXES .a .so)
set(CMAKE_FIND_USE_PACKAGE_REGISTRY OFF)
set(CMAKE_FIND_USE_SYSTEM_PACKAGE_REGISTRY OFF)
set(ENV{PKG_CONFIG_LIBDIR} "${portable}/libraries/lib/pkgconfig")

# One section per function and per variable, so that the linker can drop unused ones.
set(common "-ffunction-sections -fdata-sections -fvisibility=hidden")
set(CMAKE_C_FLAGS_INIT "${common}")
set(CMAKE_CXX_FLAGS_INIT "${common} -fvisibility-inlines-hidden -fno-gnu-unique \
-nostdinc++ -isystem /usr/include/c++/12 -isystem /usr/include/x86_64-linux-gnu/c++/12")
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Without -B and -L GCC would use the start files and libc of this machine. old_glibc.o: see old_glibc.c.
set(link "-B${CMAKE_SYSROOT}/usr/lib/x86_64-linux-gnu -L${CMAKE_SYSROOT}/usr/lib/x86_64-linux-gnu \
-L${CMAKE_SYSROOT}/lib/x86_64-linux-gnu -pthread -static-libstdc++ -Wl,--gc-sections ${portable}/old_glibc.o")
set(CMAKE_EXE_LINKER_FLAGS_INIT "${link}")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "${link}")
set(CMAKE_MODULE_LINKER_FLAGS_INIT "${link}")
