#!/usr/bin/env bash
# Builds static, minimal libraries for firetwin_core, in order of their dependencies. Unchanged libraries are not rebuilt;
# rebuilding one rebuilds all after it.
# usage: libraries.sh PORTABLE, the absolute folder with sources/ and sysroot/; makes PORTABLE/libraries
set -euo pipefail
portable=${1:?usage: libraries.sh PORTABLE}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$portable/libraries
export FIRETWIN_PORTABLE=$portable
jobs=${FIRETWIN_JOBS:-$(nproc)}

# shellcheck source=cpp/portable/logged.sh
source "$here/logged.sh"

with_cmake() { # source-folder option...
  local source=$1
  shift
  cmake -S "$source" -B build -G Ninja --toolchain "$here/toolchain.cmake" -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_FLAGS_RELEASE="-O2 -DNDEBUG" \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DBUILD_SHARED_LIBS=OFF "$@"
  cmake --build build -j "$jobs"
  cmake --install build
}

# Debian's tarball of zlib has no CMake file.
build_zlib() {
  CC="gcc-12 --sysroot=$portable/sysroot" \
    CFLAGS="-O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections" ./configure --static --prefix="$prefix"
  make -j "$jobs" libz.a
  make install
}

build_libdeflate() { with_cmake . -DLIBDEFLATE_BUILD_SHARED_LIB=OFF -DLIBDEFLATE_BUILD_GZIP=OFF; }

build_lz4() { with_cmake build/cmake -DBUILD_STATIC_LIBS=ON -DLZ4_BUILD_CLI=OFF -DLZ4_BUILD_LEGACY_LZ4C=OFF; }

build_c-blosc() {
  with_cmake . -DBUILD_SHARED=OFF -DBUILD_STATIC=ON -DBUILD_TESTS=OFF -DBUILD_BENCHMARKS=OFF -DBUILD_FUZZERS=OFF \
    -DPREFER_EXTERNAL_LZ4=ON -DPREFER_EXTERNAL_ZLIB=ON -DDEACTIVATE_ZSTD=ON -DDEACTIVATE_SNAPPY=ON
}

build_libpng() { with_cmake . -DPNG_SHARED=OFF -DPNG_STATIC=ON -DPNG_TESTS=OFF -DPNG_TOOLS=OFF -DPNG_FRAMEWORK=OFF; }

build_libjpeg-turbo() {
  with_cmake . -DENABLE_SHARED=OFF -DENABLE_STATIC=ON -DWITH_TURBOJPEG=OFF \
    -DCMAKE_ASM_NASM_COMPILER="$portable/nasm/usr/bin/nasm"
}

build_tiff() {
  with_cmake . -Dtiff-tools=OFF -Dtiff-tests=OFF -Dtiff-contrib=OFF -Dtiff-docs=OFF -Dtiff-opengl=OFF -Dcxx=OFF \
    -Dzstd=OFF -Dlzma=OFF -Dwebp=OFF -Djbig=OFF -Dlerc=OFF
}

build_geographiclib() {
  with_cmake . -DBUILD_DOCUMENTATION=OFF -DBUILD_MANPAGES=OFF -DBINDIR=OFF -DSBINDIR= -DEXAMPLEDIR= -DDOCDIR= -DMANDIR=
}

build_fmt() { with_cmake . -DFMT_TEST=OFF -DFMT_DOC=OFF; }

build_robin-map() { with_cmake .; }

build_imath() { with_cmake . -DBUILD_TESTING=OFF; }

build_openexr() { with_cmake . -DBUILD_TESTING=OFF -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF; }

build_tbb() { with_cmake . -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON; }

# All headers of Boost, and the few source files of two libraries that OpenImageIO requires.
build_boost() {
  mkdir -p "$prefix/include"
  local folder
  while read -r folder; do
    cp -r "$folder/boost" "$prefix/include/"
  done < <(find libs -type d -name include -not -path '*/test/*' -not -path '*/example/*' -exec test -d '{}/boost' \; -print)
  local sources=(libs/thread/src/pthread/{thread,once}.cpp libs/thread/src/{future,tss_null}.cpp libs/chrono/src/chrono.cpp)
  {
    echo 'cmake_minimum_required(VERSION 3.25)'
    echo 'project(boost LANGUAGES CXX)'
    echo "add_library(boost_thread STATIC ${sources[*]})"
    echo "target_include_directories(boost_thread PRIVATE $prefix/include)"
    echo 'target_compile_definitions(boost_thread PRIVATE BOOST_ALL_NO_LIB BOOST_THREAD_BUILD_LIB)'
    echo 'install(TARGETS boost_thread)'
  } >CMakeLists.txt
  with_cmake .
}

build_openvdb() {
  with_cmake . -DOPENVDB_CORE_SHARED=OFF -DOPENVDB_CORE_STATIC=ON -DOPENVDB_BUILD_BINARIES=OFF -DUSE_BLOSC=ON -DUSE_ZLIB=ON \
    -DUSE_IMATH_HALF=OFF -DOPENVDB_USE_DELAYED_LOADING=OFF -DUSE_EXPLICIT_INSTANTIATION=OFF -DUSE_CCACHE=OFF \
    -DUSE_PKGCONFIG=OFF -DDISABLE_DEPENDENCY_VERSION_CHECKS=ON -DBLOSC_USE_STATIC_LIBS=ON -DBLOSC_ROOT="$prefix" \
    -DBoost_INCLUDE_DIR="$prefix/include" -DCMAKE_CXX_STANDARD=17
}

build_openimageio() {
  sed -i 's/^set (Boost_COMPONENTS thread)/set (Boost_COMPONENTS)/' src/cmake/externalpackages.cmake
  # Only reading and writing of files: image processing and textures would be most of the build.
  sed -i -E '/^ +(imagebufalgo_(pixelmath|compare|deep|addsub|muldiv|mad|minmaxchan|orient|xform)|maketexture|printinfo)\.cpp/d;
    s/imagebufalgo_yee.cpp //; /^ +..\/libtexture\/(texturesys|texture3d|environment)\.cpp/d' src/libOpenImageIO/CMakeLists.txt
  local without=() package
  for package in Qt5 Qt6 OpenGL GLEW OpenColorIO OpenCV FFmpeg GIF Libheif LibRaw OpenJPEG OpenJph OpenVDB Ptex WebP R3DSDK Nuke \
    DCMTK Freetype Field3D TBB JXL BZip2 pystring; do
    without+=("-DUSE_${package^^}=0" "-DUSE_$package=0" "-DENABLE_$package=OFF")
  done
  for package in BMP CINEON DDS DPX FITS HDR ICO IFF NULL PNM PSD RLA SGI SOFTIMAGE TARGA TERM ZFILE; do
    without+=("-DENABLE_$package=OFF")
  done
  with_cmake . "${without[@]}" -DUSE_PYTHON=0 -DUSE_STD_FILESYSTEM=ON -DOIIO_DISABLE_BOOST_STACKTRACE=ON -DOIIO_BUILD_TOOLS=OFF \
    -DOIIO_BUILD_TESTS=OFF -DBUILD_DOCS=OFF -DINSTALL_DOCS=OFF -DINSTALL_FONTS=OFF -DEMBEDPLUGINS=ON -DLINKSTATIC=ON -DBUILD_MISSING_DEPS=OFF \
    -DINTERNALIZE_FMT=OFF -DSTOP_ON_WARNING=OFF -DBoost_INCLUDE_DIR="$prefix/include" -DCMAKE_CXX_STANDARD=17
}

# Only float32 transforms, with AVX2 selected at run time: configure compiles only the AVX2 code for AVX2, while FFTW's CMake
# file would compile all code for it.
build_fftw3() {
  CC="gcc-12 --sysroot=$portable/sysroot" \
    CFLAGS="-O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections" ./configure --prefix="$prefix" --libdir="$prefix/lib" \
    --enable-float --enable-sse2 --enable-avx2 --enable-static --disable-shared --disable-fortran --disable-doc
  make -j "$jobs"
  make install
}

build_fast-float() { with_cmake . -DFASTFLOAT_TEST=OFF; }

# Header-only.
build_nlohmann-json() { cp -r include/nlohmann "$prefix/include/"; }

build_meshoptimizer() { with_cmake . -DMESHOPT_BUILD_DEMO=OFF -DMESHOPT_BUILD_GLTFPACK=OFF; }

build_draco() { with_cmake . -DDRACO_TESTS=OFF -DDRACO_TRANSCODER_SUPPORTED=OFF; }

build_tomlplusplus() { cp -r usr/include/toml++ "$prefix/include/"; }

unpack() { # archive
  case $1 in
    *.deb) dpkg-deb --extract "$1" . ;;
    *boost*) tar --extract --file "$1" --strip-components=1 --wildcards 'boost/LICENSE*' \
      'boost/libs/*/include' 'boost/libs/thread/src' 'boost/libs/chrono/src' ;;
    *draco*) tar --extract --file "$1" --strip-components=1 --exclude '*/testdata' ;;
    *) tar --extract --file "$1" --strip-components=1 ;;
  esac
}

# The wheel contains the licence of each library.
keep_license() { # name work-folder
  local into=$portable/licenses/$1
  rm -rf "$into"
  mkdir -p "$into"
  find "$2" -maxdepth 1 -type f \( -iname 'licen[cs]e*' -o -iname 'copying*' -o -iname 'copyright*' -o -name 'README.ijg' \) \
    -exec cp -t "$into" {} +
  find "$2/LICENSES" "$2/usr/share/doc" -type f \( -name '*.txt' -o -name copyright \) -exec cp -t "$into" {} + 2>/dev/null || true
  if [[ -z $(ls "$into") ]]; then
    echo "libraries: the licence of $1 was not found" >&2
    exit 1
  fi
}

in_folder() { # work-folder name archive
  cd "$1"
  unpack "$3"
  "build_$2"
}

build() { # name archive
  local work=$portable/work/$1 log=$portable/logs/$1.log start=$SECONDS
  rm -rf "$work"
  mkdir -p "$work"
  logged "libraries: $1" "$log" in_folder "$work" "$1" "$2"
  keep_license "$1" "$work"
  rm -rf "$work"
  echo "libraries: $1 built in $((SECONDS - start)) s" >&2
}

mkdir -p "$portable/logs" "$portable/stamps" "$prefix"
gcc-12 --sysroot="$portable/sysroot" -O2 -fPIC -ffunction-sections -Wall -Wextra -c \
  "$here/old_glibc.c" -o "$portable/old_glibc.o"

want=$({ gcc-12 --version && cat "$here/toolchain.cmake" "$here/old_glibc.c" && declare -f with_cmake unpack; } | sha256sum)
while read -r name _ path sha256; do
  if [[ -z $name || $name == \#* ]] || ! declare -F "build_$name" >/dev/null; then
    continue
  fi
  want=$(echo "$want $sha256 $(declare -f "build_$name")" | sha256sum)
  stamp=$portable/stamps/$name
  if [[ ! -f $stamp || $(<"$stamp") != "$want" ]]; then
    build "$name" "$portable/sources/$(basename "$path")"
    echo "$want" >"$stamp"
  fi
done <"$here/sources.txt"
