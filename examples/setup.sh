#!/usr/bin/env bash
# Makes this checkout ready to run: system packages, a virtual environment in .venv, and a build of Firetwin.
# Safe to run again: installed packages and finished builds stay, and an unchanged checkout takes about a second.
#
#   examples/setup.sh                  what the command line needs
#   examples/setup.sh --with-wheels    also what cpp/portable/build.sh needs
#   examples/setup.sh --with-tests     also what the tests need
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build_packages=(
  g++ cmake ninja-build pkg-config python3 python3-dev python3-venv
  libopenvdb-dev libboost-dev libimath-dev libblosc-dev libtbb-dev libopenimageio-dev libopenexr-dev
  libgeographiclib-dev libfast-float-dev libfftw3-dev
  nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev
)
run_packages=(
  # Libraries that Blender loads.
  libegl1 libgl1 libgl1-mesa-dri libxi6 libxrender1 libxkbcommon0 libxxf86vm1 libxfixes3 libsm6 libice6 libgomp1
)
wheel_packages=(g++-12 make curl bzip2 xz-utils)
test_packages=(
  geographiclib-tools libopenvdb-tools openimageio-tools proj-bin ffmpeg shellcheck
  debootstrap # folders with other Debians
)
extras="blender" test_extras="blender,test,lint,docs"

for argument in "$@"; do
  case $argument in
    --with-wheels) run_packages+=("${wheel_packages[@]}") ;;
    --with-tests)
      run_packages+=("${wheel_packages[@]}" "${test_packages[@]}")
      extras=$test_extras
      ;;
    *)
      echo "usage: examples/setup.sh [--with-wheels | --with-tests]" >&2
      exit 2
      ;;
  esac
done

say() { echo "setup: $*" >&2; }

missing_packages() { # package...
  local package
  for package in "$@"; do
    if [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
      echo "$package"
    fi
  done
}

install_packages() { # package...
  if ! command -v apt-get >/dev/null; then
    say "this system has no apt-get; install these packages, which have these names on Debian:"
    say "  $*"
    say "continuing; the build reports missing packages"
    return
  fi
  local missing as_root=()
  mapfile -t missing < <(missing_packages "$@")
  if ((${#missing[@]} == 0)); then
    return
  fi
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      say "root or sudo is needed to install packages; install these and run this again: ${missing[*]}"
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
    say "apt-get failed; see $log"
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
  say "install Python 3.11 or 3.13 with its venv module; Blender's Python module exists only for these two"
  exit 1
}


# Changes if pip has to install packages. addon/ and data/ are used in place, and ninja checks C++.
fingerprint() { # extras
  {
    echo "$PWD $1"
    sha256sum pyproject.toml examples/setup.sh
  } | sha256sum
}

make_venv() {
  if [[ ! -x .venv/bin/python ]]; then
    local python
    python=$(find_python)
    say "creating .venv with $("$python" --version)"
    "$python" -m venv .venv
    rm -rf build/setup # may belong to another Python
  fi
  # Builders of packages that have no wheel for this system: Firetwin, and reuse.
  "${pip[@]}" "scikit-build-core==1.1.2" "pybind11==3.1.0" "poetry-core==2.5.0"
}

# With uv, which takes a fifth of pip's processor time; with pip if uv cannot be installed or cannot reach the packages.
install_python_packages() {
  say "installing Blender's Python module and the other Python packages (about 350 MB the first time)"
  local options=(--quiet --no-build-isolation --config-settings=wheel.cmake=false ".[$extras]")
  if ! { "${pip[@]}" uv && .venv/bin/uv pip install --system-certs --python .venv/bin/python "${options[@]}"; } >build/uv.log 2>&1; then
    "${pip[@]}" "${options[@]}"
  fi
}

compile() {
  if [[ ! -f build/setup/build.ninja || $stale == true ]]; then
    cmake -S . -B build/setup -G Ninja -DCMAKE_BUILD_TYPE=Release -DFIRETWIN_QUICK_BUILD=ON \
      -DFIRETWIN_VERSION="$(sed -n 's/^version = "\(.*\)"/\1/p' pyproject.toml)" \
      -DPython_EXECUTABLE="$PWD/.venv/bin/python" -Dpybind11_DIR="$(.venv/bin/python -m pybind11 --cmakedir)" || return
  fi
  cmake --build build/setup
}

# addon/ of this checkout is the package `firetwin`, and data/ is a part of it.
use_in_place() { # site-packages
  echo "import _firetwin_checkout" >"$1/firetwin_checkout.pth"
  cat >"$1/_firetwin_checkout.py" <<PYTHON
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import spec_from_loader


class Checkout:
    root = "$PWD"

    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name != "firetwin":
            return None
        loader = SourceFileLoader(name, f"{cls.root}/addon/__init__.py")
        spec = spec_from_loader(name, loader, is_package=True)
        spec.submodule_search_locations = [f"{cls.root}/addon", cls.root]
        return spec


sys.meta_path.append(Checkout)  # last: a copy of the package that PYTHONPATH names comes first
PYTHON
}

# Runs a step whose output matters only if it fails.
quietly() { # name command...
  local log=build/$1.log
  shift
  if ! "$@" >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    say "failed; see $log"
    return 1
  fi
}

pip=(.venv/bin/python -m pip install --quiet --disable-pip-version-check)
mkdir -p build
install_packages "${build_packages[@]}"
stamp=.venv/firetwin.stamp
background=() stale=false
if [[ -f $stamp && $(<"$stamp") == "$(fingerprint "$test_extras")" ]]; then
  extras=$test_extras # they stay
fi
if [[ ! -f $stamp || $(<"$stamp") != "$(fingerprint "$extras")" ]]; then
  stale=true
  make_venv
  install_python_packages &
  background+=($!)
fi
install_packages "${run_packages[@]}" &
background+=($!)
if [[ ! -d build/setup ]]; then
  say "compiling the core (a minute or two)"
fi
quietly compile compile
for process in "${background[@]}"; do
  wait "$process"
done
site=$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
quietly install cmake --install build/setup --component core --prefix "$site"
use_in_place "$site"
fingerprint "$extras" >"$stamp"
say "ready: .venv/bin/firetwin"
