#!/usr/bin/env bash
# To be sourced by libraries.sh: how each library is built, static and minimal. A recipe runs in the unpacked source folder. It
# installs for the prefix $prefix below the folder $DESTDIR; the libraries named in `needs` are then in $prefix.
# shellcheck disable=SC2154 # portable, prefix, here and jobs are set by libraries.sh

# shellcheck disable=SC2034 # used by libraries.sh
declare -A needs=(
  [c-blosc]="lz4 zlib" [libpng]=zlib [tiff]="libdeflate libjpeg-turbo zlib" [openexr]="imath libdeflate"
  [openvdb]="boost c-blosc tbb zlib" [openimageio]="boost fmt imath libjpeg-turbo libpng openexr robin-map tiff zlib"
)

with_cmake() { # source-folder option...
  local source=$1
  shift
  cmake -S "$source" -B build -G Ninja --toolchain "$here/toolchain.cmake" -DCMAKE_INSTALL_PREFIX="$prefix" \
    -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_FLAGS_RELEASE="-O2 -DNDEBUG" \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "$@"
  cmake --build build -j "$jobs"
  cmake --install build
}

with_configure() { # option...
  CC="gcc-12 --sysroot=$portable/sysroot" CFLAGS="-O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections" \
    ./configure --prefix="$prefix" --libdir="$prefix/lib" "$@"
}

# Some source files alone, for libraries whose own files would compile all.
with_sources() { # library include-folder source...
  {
    echo 'cmake_minimum_required(VERSION 3.25)'
    echo "project($1 LANGUAGES CXX)"
    echo "add_library($1 STATIC ${*:3})"
    echo "target_include_directories($1 PRIVATE $2 $prefix/include)"
    echo "install(TARGETS $1)"
  } >CMakeLists.txt
  with_cmake . -DCMAKE_CXX_STANDARD=17
}

copy_headers() { # folder...
  mkdir -p "$DESTDIR$prefix/include"
  cp -r "$@" "$DESTDIR$prefix/include/"
}

# Debian's tarball of zlib has no CMake file.
build_zlib() {
  with_configure --static
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
  with_cmake . -DENABLE_SHARED=OFF -DENABLE_STATIC=ON -DWITH_TURBOJPEG=OFF -DWITH_TOOLS=OFF -DWITH_TESTS=OFF \
    -DCMAKE_ASM_NASM_COMPILER="$portable/nasm/usr/bin/nasm"
}

build_tiff() {
  with_cmake . -Dtiff-tools=OFF -Dtiff-tests=OFF -Dtiff-contrib=OFF -Dtiff-docs=OFF -Dtiff-opengl=OFF -Dcxx=OFF \
    -Dzstd=OFF -Dlzma=OFF -Dwebp=OFF -Djbig=OFF -Dlerc=OFF
}

# Only the local frame, UTM with MGRS, and geodesics, with the sources that they refer to. The headers need the version, which GeographicLib's CMake files would write.
build_geographiclib() {
  printf '#define GEOGRAPHICLIB_%s\n' 'VERSION_STRING "2.7"' 'VERSION_MAJOR 2' 'VERSION_MINOR 7' 'VERSION_PATCH 0' \
    'DATA "/usr/local/share/GeographicLib"' 'HAVE_LONG_DOUBLE 1' 'WORDS_BIGENDIAN 0' 'PRECISION 2' 'SHARED_LIB 0' \
    >include/GeographicLib/Config.h
  with_sources GeographicLib include src/{Geocentric,LocalCartesian,Math,Utility}.cpp \
    src/{MGRS,UTMUPS,PolarStereographic,TransverseMercator,TransverseMercatorExact,EllipticFunction}.cpp \
    src/{Geodesic,GeodesicLine,GeodesicExact,GeodesicLineExact,DST}.cpp
  copy_headers include/GeographicLib
}

build_fmt() { with_cmake . -DFMT_TEST=OFF -DFMT_DOC=OFF; }

build_robin-map() { with_cmake .; }

build_imath() { with_cmake .; }

build_openexr() {
  sed -i '/add_subdirectory.*\(OpenEXRUtil\|website\/src\)/d' CMakeLists.txt src/lib/CMakeLists.txt
  with_cmake . -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_BUILD_EXAMPLES=OFF
}

build_tbb() { with_cmake . -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON; }

# All headers of Boost, and the few source files of two libraries that OpenImageIO requires.
build_boost() {
  local folder
  while read -r folder; do
    copy_headers "$folder/boost"
  done < <(find libs -type d -name include -not -path '*/test/*' -not -path '*/example/*' -exec test -d '{}/boost' \; -print)
  with_sources boost_thread "$DESTDIR$prefix/include" \
    libs/thread/src/pthread/{thread,once}.cpp libs/thread/src/{future,tss_null}.cpp libs/chrono/src/chrono.cpp
}

# Without point grids, and without reading: Firetwin writes grids of floats.
build_openvdb() {
  sed -i -E '/^  (io\/(File|Queue|Stream|TempFile)|math\/(Proximity|QuantizedUnitVec)|points\/(Attribute.*|points))\.cc$/d' \
    openvdb/openvdb/CMakeLists.txt
  sed -i -E '/points::internal|Point(Index|Data)(32|64|Grid)/d; s/\bGridTypes::foreach/TypeList<FloatGrid>::foreach/' \
    openvdb/openvdb/openvdb.cc
  with_cmake . -DOPENVDB_CORE_SHARED=OFF -DOPENVDB_CORE_STATIC=ON -DOPENVDB_BUILD_BINARIES=OFF -DUSE_BLOSC=ON -DUSE_ZLIB=ON \
    -DUSE_IMATH_HALF=OFF -DOPENVDB_USE_DELAYED_LOADING=OFF -DUSE_EXPLICIT_INSTANTIATION=OFF -DUSE_CCACHE=OFF \
    -DUSE_PKGCONFIG=OFF -DDISABLE_DEPENDENCY_VERSION_CHECKS=ON -DBLOSC_USE_STATIC_LIBS=ON -DBLOSC_ROOT="$prefix" \
    -DBoost_INCLUDE_DIR="$prefix/include" -DCMAKE_CXX_STANDARD=17
}

# Only reading and writing of files, without image buffers, their cache and textures, which would be most of the build.
build_openimageio() {
  sed -i 's/^set (Boost_COMPONENTS thread)/set (Boost_COMPONENTS)/' src/cmake/externalpackages.cmake
  local library=src/libOpenImageIO
  sed -i -E '/^ +(imagebufalgo.*|maketexture|printinfo|\.\.\/libtexture\/.*)\.cpp$/d' $library/CMakeLists.txt
  sed -i '/^\/\/ Image Processing Implementations/,$d' $library/color_ocio.cpp
  echo 'OIIO_NAMESPACE_END' >>$library/color_ocio.cpp
  sed -i '/^}  \/\/ namespace pvt/,$d' $library/imagebuf.cpp # keeps counters that other files name
  {
    echo 'int opencv_version = 0;'
    printf 'const std::vector<std::string>& %s() { static const std::vector<std::string> none; return none; }\n' \
      font_dirs font_list font_file_list
    printf '}\nOIIO_NAMESPACE_END\n'
  } >>$library/imagebuf.cpp
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
    -DINTERNALIZE_FMT=OFF -DSTOP_ON_WARNING=OFF -DBoost_INCLUDE_DIR="$prefix/include" -DCMAKE_CXX_STANDARD=17 \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_MODE=GROUP
}

# Only float32 transforms, with AVX2 selected at run time: configure compiles only the AVX2 code for AVX2, while FFTW's CMake
# file would compile all code for it.
build_fftw3() {
  with_configure --enable-float --enable-sse2 --enable-avx2 --enable-static --disable-shared --disable-fortran --disable-doc
  sed -i 's/ libbench2 \. tests / . /' Makefile
  make -j "$jobs"
  make install
}

build_fast-float() { with_cmake . -DFASTFLOAT_TEST=OFF; }

build_nlohmann-json() { copy_headers include/nlohmann; }

build_meshoptimizer() {
  with_sources meshoptimizer src src/{allocator,indexcodec,vertexcodec,vertexfilter}.cpp
  copy_headers src/meshoptimizer.h
}

# Only decoders.
build_draco() {
  local sources
  printf '#define DRACO_%s_SUPPORTED\n' POINT_CLOUD_COMPRESSION MESH_COMPRESSION NORMAL_ENCODING STANDARD_EDGEBREAKER \
    PREDICTIVE_EDGEBREAKER BACKWARDS_COMPATIBILITY ATTRIBUTE_INDICES_DEDUPLICATION ATTRIBUTE_VALUES_DEDUPLICATION \
    >src/draco/draco_features.h
  mapfile -t sources < <(find src/draco/{attributes,compression,core,mesh,metadata,point_cloud} -name '*.cc' \
    ! -name '*test*' ! -name '*encod*' ! -name 'encode*' | sort)
  with_sources draco src "${sources[@]}"
  mkdir -p "$DESTDIR$prefix/include"
  (cd src && find draco -name '*.h' -exec cp --parents -t "$DESTDIR$prefix/include" {} +)
}

