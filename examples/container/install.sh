#!/usr/bin/env bash
# Installs Firetwin in the image of a container with Debian 12 or 13; Containerfile and firetwin.def call it as root.
#
#   install.sh build SOURCE WHEELS   builds the wheels of the source tree SOURCE in the folder WHEELS
#   install.sh run WHEELS            installs these wheels, Blender's Python module and its libraries in /opt/firetwin
#
# FIRETWIN_PACKAGES names more Debian packages for the image, such as the client of a scheduler. FIRETWIN_EXTRAS names the
# extras of the package `firetwin` (default: blender).
set -euo pipefail

build_packages=(g++-12 cmake ninja-build make pkg-config dpkg-dev curl ca-certificates python3-venv)
run_packages=(
  python3 python3-venv ca-certificates
  # Libraries that Blender loads, and a software renderer for EEVEE.
  libegl1 libgl1 libgl1-mesa-dri libxi6 libxrender1 libxkbcommon0 libxxf86vm1 libxfixes3 libsm6 libice6 libgomp1
  # Fonts of labels.
  fontconfig fonts-dejavu-core
)

install_packages() { # package...
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
  rm -rf /var/lib/apt/lists/* /var/cache/apt/archives/*.deb
}

case ${1:-} in
  build)
    source=${2:?} wheels=${3:?}
    install_packages "${build_packages[@]}"
    "$source/cpp/portable/build.sh"
    mkdir -p "$wheels"
    cp "$source"/build/portable/wheels/*.whl "$wheels"
    ;;
  run)
    wheels=${2:?}
    read -ra more <<<"${FIRETWIN_PACKAGES:-}"
    install_packages "${run_packages[@]}" ${more[@]+"${more[@]}"}
    python3 -m venv /opt/firetwin
    /opt/firetwin/bin/pip install --quiet --no-cache-dir --disable-pip-version-check --prefer-binary --find-links "$wheels" \
      "firetwin[${FIRETWIN_EXTRAS:-blender}]"
    /opt/firetwin/bin/pip check
    /opt/firetwin/bin/firetwin --version
    ;;
  *)
    echo "usage: install.sh build SOURCE WHEELS | run WHEELS" >&2
    exit 2
    ;;
esac
