#!/usr/bin/env bash
# Builds and checks wheels of firetwin_core for any x86-64 Linux with glibc 2.28 or newer, for the Pythons of Blender 4.5 and
# 5.0 (3.11), and of 5.1 and later (3.13), and the wheel of firetwin, which requires them. They go to build/portable/wheels.
# The first run downloads (220 MB) and builds the libraries; later runs use the archives in build/portable/archives.
#
#   cpp/portable/build.sh                 build everything
#   cpp/portable/build.sh --libraries     build only the libraries
#   cpp/portable/build.sh --windows       build wheels for 64-bit Windows, in build/portable/windows/wheels
#
# Needs g++-12, cmake, ninja, make, dpkg-deb, curl, bzip2, xz, and Python 3 with venv; for Windows, mingw-w64 instead of g++-12,
# and maven. FIRETWIN_PORTABLE replaces the folder build/portable; FIRETWIN_JOBS is the number of parallel compilers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
here=$PWD/cpp/portable
portable=$(realpath -m "${FIRETWIN_PORTABLE:-build/portable}")
pythons="3.11 3.13"
toolchain=$here/toolchain.cmake compilers="gcc-12 g++-12" packages=g++-12
if [[ ${1:-} == --windows ]]; then
  shift
  mkdir -p "$portable/sources" "$portable/windows"
  ln -sfn ../sources "$portable/windows/sources"
  portable=$portable/windows toolchain=$here/windows/toolchain.cmake
  compilers="x86_64-w64-mingw32-g++-posix mvn" packages="g++-mingw-w64-x86-64-posix maven"
  export FIRETWIN_SYSTEM=windows
fi
export FIRETWIN_PORTABLE=$portable

# shellcheck source=cpp/portable/logged.sh
source "$here/logged.sh"

say() { echo "portable: $*" >&2; }

for command in $compilers cmake ninja make dpkg-deb curl bzip2 xz python3; do
  if ! command -v "$command" >/dev/null; then
    say "$command is missing; on Debian: apt-get install $packages cmake ninja-build make dpkg curl bzip2 xz-utils python3-venv"
    exit 1
  fi
done
if [[ $(uname -s -m) != "Linux x86_64" ]]; then
  say "this builds on and for x86-64 Linux; .github/workflows/wheels.yml builds for the other systems"
  exit 1
fi

# Runs a step once, and again if its dependencies changed.
once() { # name dependencies command...
  local stamp=$portable/stamps/$1 want=$2
  if [[ ! -f $stamp || $(<"$stamp") != "$want" ]]; then
    "${@:3}"
    mkdir -p "$portable/stamps"
    echo "$want" >"$stamp"
  fi
}

make_tools() {
  rm -rf "$portable/tools"
  python3 -m venv "$portable/tools"
  "$portable/tools/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/tools.txt"
}

compile() {
  local build=$portable/module python
  # --fresh: the folder may be from another checkout.
  cmake --fresh -S . -B "$build" -G Ninja --toolchain "$toolchain" -DCMAKE_BUILD_TYPE=Release \
    -DFIRETWIN_LIBRARIES=portable -DFIRETWIN_VERSION="$version" -DFIRETWIN_PYTHONS="${pythons// /;}" \
    -DFIRETWIN_QUICK_BUILD=ON -DFIRETWIN_PYTHON_HEADERS="$portable" -Dpybind11_DIR="$("$portable/tools/bin/python" -m pybind11 --cmakedir)"
  cmake --build "$build" -j "${FIRETWIN_JOBS:-$(nproc)}"
  for python in $pythons; do
    rm -rf "$build/stage-$python"
    cmake --install "$build" --component core --prefix "$build/stage-$python"
    cmake --install "$build" --component "core-$python" --prefix "$build/stage-$python"
  done
}

start=$SECONDS
mapfile -t missing < <("$here/libraries.sh" "$portable" --missing)
"$here/fetch.sh" "$portable/sources" "${missing[@]}"
once sysroot "$(cat "$here/sources.txt" "$here/sysroot.sh" | sha256sum)" "$here/sysroot.sh" "$portable/sources" "$portable"
once tools "$(sha256sum <"$here/tools.txt")" make_tools
"$here/libraries.sh" "$portable"
say "libraries ready after $((SECONDS - start)) s"
if [[ ${1:-} == --libraries ]]; then
  exit
fi

version=$("$portable/tools/bin/python" -c 'import tomllib; print(tomllib.load(open("pyproject.toml", "rb"))["project"]["version"])')
code=$(find cpp CMakeLists.txt pyproject.toml -type f ! -name '*.pyc' ! -path 'cpp/portable/*.py' -print0 | sort -z | xargs -0 sha256sum | sha256sum)
once module "$code" logged firetwin_core "$portable/logs/module.log" compile
rm -rf "$portable/wheels"
for python in $pythons; do
  "$portable/tools/bin/python" "$here/pack.py" core "$portable/module/stage-$python" "$python" "$portable"
done
"$portable/tools/bin/python" "$here/pack.py" addon "$portable"
"$here/check.sh" "$portable"
say "done after $((SECONDS - start)) s"
