#!/usr/bin/env bash
# Makes this checkout ready to run: system packages, a virtual environment in .venv, and a build of Firetwin.
# Safe to run again: what is already there is left alone, and an unchanged checkout takes about a second.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build pkg-config python3 python3-dev python3-venv
  libopenvdb-dev libboost-dev libimath-dev libblosc-dev libtbb-dev libopenimageio-dev libopenexr-dev
  libgeographiclib-dev libtomlplusplus-dev libfast-float-dev libfftw3-dev
  # Libraries that Blender loads.
  libegl1 libgl1 libgl1-mesa-dri libxi6 libxrender1 libxkbcommon0 libxxf86vm1 libxfixes3 libsm6 libice6 libgomp1
)
test_packages=(
  geographiclib-tools libopenvdb-tools openimageio-tools proj-bin ffmpeg shellcheck
  # The portable wheels, and folders with other Debians.
  g++-12 make curl debootstrap
)
extras="blender"

for argument in "$@"; do
  case $argument in
    --with-tests)
      packages+=("${test_packages[@]}")
      extras="blender,test,lint"
      ;;
    *)
      echo "usage: examples/setup.sh [--with-tests]" >&2
      exit 2
      ;;
  esac
done

say() { echo "setup: $*" >&2; }

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    if [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
      echo "$package"
    fi
  done
}

install_packages() {
  if ! command -v apt-get >/dev/null; then
    say "this system has no apt-get; what is needed has these names on Debian, and other names here:"
    say "  ${packages[*]}"
    say "going on: the build tells what it misses"
    return
  fi
  local missing as_root=()
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]} == 0)); then
    return
  fi
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      say "please have these packages installed, then run this again: ${missing[*]}"
      exit 1
    fi
    as_root=(sudo)
  fi
  say "installing ${#missing[@]} system packages with apt-get: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update -q &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    say "apt-get failed; its whole output is in $log"
    exit 1
  fi
  rm -f "$log"
}

# Blender as a Python module exists for these Python versions only.
find_python() {
  local candidate
  for candidate in /usr/bin/python3 python3.11 python3.13 python3; do
    if "$candidate" -c 'import sys, ensurepip; sys.exit(sys.version_info[:2] not in ((3, 11), (3, 13)))' 2>/dev/null; then
      echo "$candidate"
      return
    fi
  done
  say "Python 3.11 or 3.13 with its venv module is needed, because Blender's Python module exists for these two"
  exit 1
}

# Changes whenever anything that ends up in .venv changes.
fingerprint() {
  {
    echo "$extras"
    find addon cpp data CMakeLists.txt pyproject.toml LICENSE README.md examples/setup.sh -type f \
      ! -name '*.pyc' -print0 | sort -z | xargs -0 sha256sum
  } | sha256sum
}

build() {
  local stamp=.venv/firetwin.stamp want
  want=$(fingerprint)
  if [[ -f $stamp && $(<"$stamp") == "$want" ]]; then
    return
  fi
  if [[ ! -x .venv/bin/python ]]; then
    local python
    python=$(find_python)
    say "making .venv with $("$python" --version)"
    "$python" -m venv .venv
  fi
  say "installing Blender's Python module and the other Python packages (about 350 MB the first time)"
  .venv/bin/pip install --quiet --disable-pip-version-check "scikit-build-core==1.1.2" "pybind11==3.1.0"
  say "building Firetwin"
  .venv/bin/pip install --quiet --disable-pip-version-check --no-build-isolation \
    --config-settings=build-dir=build/setup ".[$extras]"
  echo "$want" >"$stamp"
}

install_packages
build
say "ready: .venv/bin/firetwin"
