#!/usr/bin/env bash
# To be sourced by libraries.sh after recipes.sh: what differs for Windows.
# shellcheck disable=SC2154 # prefix is set by libraries.sh

with_configure() { # option...
  CC=x86_64-w64-mingw32-gcc-posix AR=x86_64-w64-mingw32-ar RANLIB=x86_64-w64-mingw32-ranlib \
    CFLAGS="-O2 -ffunction-sections -fdata-sections -Wa,-muse-unaligned-vector-move" \
    ./configure --prefix="$prefix" --libdir="$prefix/lib" "$@"
}

change() { # library sed-script: change its recipe
  eval "$(declare -f "build_$1" | sed -E "$2")"
}

change boost 's#pthread/\{thread,once\}#win32/{thread,tss_pe}#; 2a sed -i "1i #define BOOST_THREAD_BUILD_LIB" libs/thread/src/win32/*.cpp;'
change fftw3 's/--enable-float/--host=x86_64-w64-mingw32 --enable-float --with-our-malloc/'
# The compiler crashes on this option. The module exports nothing of TBB.
change tbb '2a sed -i "s/-fstack-clash-protection//" cmake/compilers/GNU.cmake; sed -i "s/__declspec(dllexport)//" include/oneapi/tbb/detail/_export.h;'
change openvdb 's/-DUSE_BLOSC=ON/-DUSE_BLOSC=ON -DOPENVDB_DISABLE_BOOST_IMPLICIT_LINKING=OFF/'
# Its imitation of pthreads has the names of GCC's.
change c-blosc '2a sed -i -E "s/\\\\bpthread_(create|cond_[a-z]+)/blosc_&/g" blosc/*.[ch] blosc/win32/*;'
