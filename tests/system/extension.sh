#!/usr/bin/env bash
# Builds the Blender extension, build/extension/firetwin-VERSION.zip, and installs, uses and removes it in Blender.
#
#   tests/system/extension.sh                 build the wheels of the core, the zip, and try it
#   tests/system/extension.sh --zip           build the wheels of the core and the zip
#   tests/system/extension.sh --zip --windows the same for Windows, in build/windows; tests/system/windows.sh tries it
#   tests/system/extension.sh --try ZIP       only try this zip
#
# All but --try set up (examples/setup.sh --with-wheels). The libraries of the core are built once, in 10 minutes, and kept in
# build/portable or $FIRETWIN_PORTABLE.
# FIRETWIN_WHEELS names an additional folder of wheels for the zip, such as the core for another Python.
# For FIRETWIN_BLENDERS and Blender 5.2 see tests/system/wheels.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=tests/system/package/blenders.sh
source tests/system/package/blenders.sh
portable=${FIRETWIN_PORTABLE:-build/portable}

make_zip() {
  local wheels=$portable/extension-wheels core=$portable out=build/extension
  examples/setup.sh --with-wheels
  if [[ ${1:-} == --windows ]]; then
    core=$portable/windows out=build/windows/extension
  fi
  cpp/portable/build.sh "$@"
  rm -rf "$out"
  mkdir -p "$out"
  if ! sha256sum --check --status "$wheels.stamp" 2>/dev/null; then
    rm -rf "$wheels"
    "$core/tools/bin/pip" download --quiet --disable-pip-version-check --no-deps --only-binary=:all: --require-hashes \
      --requirement cpp/portable/extension-wheels.txt --dest "$wheels"
    sha256sum cpp/portable/extension-wheels.txt >"$wheels.stamp"
  fi
  .venv/bin/python cpp/portable/extension.py "$out" "$core/wheels" "$wheels" ${FIRETWIN_WHEELS:+"$FIRETWIN_WHEELS"}
}

try() { # python
  local log=build/extension/install.log
  mkdir -p build/extension
  if ! "$1" tests/system/package/install.py "$zip" >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    echo "extension: FAILED: $1; see $log" >&2
    exit 1
  fi
  grep -E '^(Blender|STATUS|firetwin_core|astral|tomlkit|tqdm|uninstalled)' "$log"
}

case ${1:-} in
  --try) zip=${2:?usage: tests/system/extension.sh [--zip | --try ZIP]} ;;
  --zip)
    make_zip "${@:2}"
    exit
    ;;
  *)
    make_zip
    zip=$(echo build/extension/firetwin-*.zip)
    ;;
esac
for_each_blender try
in_other_python tests/system/extension.sh --try "$zip"
