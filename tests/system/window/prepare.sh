#!/usr/bin/env bash
# Inside the Debian folder: installs Blender and what drives it, and builds the wheels for its Python.
# usage: tests/system/window/prepare.sh WHEELS
set -euo pipefail
wheels=${1:?usage: tests/system/window/prepare.sh WHEELS}

packages=(
  blender libopenexr-3-4-33
  # Blender's own extensions need these, and Debian's package only half of them.
  python3-numpy python3-requests python3-cattr python3-zstandard
  python3-scipy # for the suggested allocation
  # A screen, hands, eyes, and OpenGL by the CPU.
  xvfb xdotool python3-xlib imagemagick libgl1-mesa-dri libegl1
  # A headset without a device.
  monado-service libopenxr1-monado mesa-vulkan-drivers
  g++ cmake ninja-build pkgconf python3-dev python3-venv
  libopenvdb-dev libboost-dev libimath-dev libblosc-dev libtbb-dev libopenimageio-dev libopenexr-dev
  libgeographiclib-dev libfast-float-dev libfftw3-dev
  nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev
)

say() { echo "window: $*" >&2; }

logged() { # what log command...
  say "$1"
  if ! "${@:3}" >"$2" 2>&1; then
    tail -n 20 "$2" >&2
    say "FAILED: $1"
    exit 1
  fi
}

# dpkg knows packages that others only recommend, without a status.
if ! states=$(dpkg-query --show --showformat='${db:Status-Status}\n' "${packages[@]}" 2>/dev/null) ||
  grep -qvx installed <<<"$states"; then
  export DEBIAN_FRONTEND=noninteractive
  logged "reading the package lists" /tmp/apt.log apt-get update
  logged "installing Blender (700 MB)" /tmp/apt.log apt-get install --yes --no-install-recommends "${packages[@]}"
  apt-get clean
fi
blender --version | head -n 1 >&2

venv=build/window/venv
if [[ ! -x $venv/bin/pip ]]; then
  mkdir -p build/window
  python3 -m venv "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check "scikit-build-core==1.1.2" "pybind11==3.1.0"
fi
logged "building the core for $(python3 --version)" /tmp/wheel.log "$venv/bin/pip" wheel --no-deps --no-build-isolation \
  --config-settings=build-dir="$PWD/build/window/core" --config-settings=cmake.define.FIRETWIN_QUICK_BUILD=ON \
  --wheel-dir "$wheels" ./cpp
"$venv/bin/pip" download --quiet --disable-pip-version-check --no-deps --only-binary=:all: --require-hashes \
  --requirement cpp/portable/extension-wheels.txt --dest "$wheels"
