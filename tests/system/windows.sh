#!/usr/bin/env bash
# Runs Firetwin for Windows in Wine, with CPython and Blender's Python module for Windows. Wine has Windows' file names, locks of
# open files, processes and code pages. It is not Windows, and shows no window of Blender here.
#
#   tests/system/windows.sh                        everything below
#   tests/system/windows.sh unit [ARGUMENT...]     tests/unit; arguments are for pytest, such as tests/unit/run
#   tests/system/windows.sh blender [ARGUMENT...]  tests/blender
#   tests/system/windows.sh film       a film of the sample run, on drive D: with a cache on C:, and how it differs from one of Linux
#   tests/system/windows.sh names      folders with hostile names, also on a network share
#   tests/system/windows.sh locks      files that another program has open
#   tests/system/windows.sh extension  Blender installs the zip, films a frame with it, and removes it
#   tests/system/windows.sh python ARGUMENT...     this Python; `-m firetwin` is the command
#
# Needs tests/system/extension.sh --zip --windows, and Debian's wine, wine64, xvfb and xauth. Everything is in build/windows.
# FIRETWIN_PYTHON=3.13 takes Blender 5.2 instead of 4.5.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
portable=$(realpath "${FIRETWIN_PORTABLE:-build/portable}")/windows
version=${FIRETWIN_PYTHON:-3.11}
work=$PWD/build/windows
python=$work/python$version
declare -A blender=([3.11]=4.5.15 [3.13]=5.2.3)

if [[ -z ${DISPLAY:-} ]]; then
  exec xvfb-run --auto-servernum "$0" "$@"
fi
export WINEPREFIX=$work/prefix WINEDEBUG=-all WINEDLLOVERRIDES="mscoree=;mshtml=;winedbg.exe=d" PYTHONDONTWRITEBYTECODE=1
unset PYTHONPATH

# Packages that the wheels and the tests need. pip of Linux evaluates markers for Linux, so those are left out.
requirements() {
  .venv/bin/python - <<'END'
import tomllib

project = tomllib.load(open("pyproject.toml", "rb"))["project"]
extras = project["optional-dependencies"]
every = [*project["dependencies"], *extras["test"], *extras["tiles"], "flip-evaluator==1.7"]
print(*(each for each in every if ";" not in each), "colorama", "tzdata", sep="\n")
END
}

make_python() {
  local source=$portable/python$version/org/bytedeco/cpython/windows-x86_64
  rm -rf "$python"
  mkdir -p "$python"
  cp -r "$source"/{python.exe,lib} "$source"/*.dll "$source"/lib/vcruntime140*.dll "$python/"
  .venv/bin/pip install --quiet --disable-pip-version-check --target "$python/lib/site-packages" --platform win_amd64 \
    --python-version "$version" --only-binary=:all: --ignore-requires-python --requirement <(requirements) "bpy==${blender[$version]}"
  # Wine 8 lacks this library, of which packages in Rust want random numbers.
  x86_64-w64-mingw32-gcc-posix -shared -x c - -o "$python/bcryptprimitives.dll" -ladvapi32 <<'END'
int SystemFunction036(void *, unsigned);
int ProcessPrng(void *bytes, unsigned long long count) { return SystemFunction036(bytes, count); }
END
}

install_wheels() {
  local site=$python/lib/site-packages wheel
  rm -rf "$site"/firetwin*
  for wheel in "$portable"/wheels/firetwin-*.whl "$portable"/wheels/firetwin_core-*-"cp${version/./}"-*.whl; do
    python3 -m zipfile --extract "$wheel" "$site"
  done
}

# Wine gives Python no standard streams that are files; pipes work.
run() { wine "$python/python.exe" "$@" </dev/null 2>&1 | cat; }

prepare() {
  local stamp
  stamp=$({ declare -f requirements make_python; cat pyproject.toml; } | sha256sum)
  if [[ ! -f $python.stamp || $(<"$python.stamp") != "$stamp" ]]; then
    make_python
    echo "$stamp" >"$python.stamp"
  fi
  install_wheels
  if [[ ! -d $WINEPREFIX ]]; then
    wineboot --init 2>/dev/null
    mkdir -p "$work/drive_d"
    ln -s "$work/drive_d" "$WINEPREFIX/dosdevices/d:"
  fi
}

# Two processes. Tests read their own files without naming UTF-8, which is Linux' default.
test_room() { # folder pytest-argument...
  run -X utf8 -m pytest -q -p no:cacheprovider -p no:zarr -o addopts="-ra --strict-markers --import-mode=importlib" \
    --dist worksteal --tx "2*popen//python=Z:$python/python.exe -X utf8" "$@"
}

try() { run tests/system/package/windows.py "$@"; }

film() {
  local folder=$work/drive_d/film linux=$work/linux
  rm -rf "$folder" "$linux" "$WINEPREFIX/drive_c/firetwin_cache"
  try film 'D:\film'
  .venv/bin/python tests/system/package/windows.py film "$linux"
  try compare 'D:\film' "$(winepath --windows "$linux")"
}

names() {
  rm -rf "$work/drive_d/names"
  mkdir -p "$work/drive_d/names" "$WINEPREFIX/dosdevices/unc/farm"
  ln -sfn "$work/drive_d/names" "$WINEPREFIX/dosdevices/unc/farm/films"
  try names 'D:\names\first'
  try names '\\farm\films\second'
}

locks() {
  rm -rf "$work/drive_d/locks"
  try locks 'D:\locks'
}

extension() { run tests/system/package/install.py "$(echo build/windows/extension/firetwin-*-windows-x64.zip)"; }

prepare
case ${1:-all} in
  python) run "${@:2}" ;;
  unit | blender)
    if (($# == 1)); then
      set -- "$1" "tests/$1"
    fi
    test_room "${@:2}"
    ;;
  film | names | locks | extension) "$1" ;;
  all)
    test_room tests/unit
    test_room tests/blender
    film
    names
    locks
    extension
    ;;
  *)
    sed -n '5,13s/^# *//p' "$0" >&2
    exit 2
    ;;
esac
