#!/usr/bin/env bash
# Builds the portable wheels of the core and tries each with Blender: imported before it, after it, and with Blender's
# libraries loaded first. Prints the speed of the core inside and outside of Blender. Installs the wheels with pip in an empty
# environment, and renders a frame there.
#
#   tests/system/wheels.sh                    build, check, try with the Blender of .venv and of build/versions/bpy-5.0
#   tests/system/wheels.sh --try FOLDER       only try the wheels in this folder
#
# FIRETWIN_BLENDERS names other Pythons with Blender's module, separated by blanks. Blender 5.2 needs Python 3.13: on a
# machine with another Python it runs in the Debian folder of tests/system/versions.sh, and is skipped without it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
# shellcheck source=tests/system/package/blenders.sh
source tests/system/package/blenders.sh

if [[ ${1:-} == --try ]]; then
  wheels=${2:?usage: tests/system/wheels.sh [--try FOLDER]}
else
  cpp/portable/build.sh
  wheels=${FIRETWIN_PORTABLE:-build/portable}/wheels
fi

try() { # python
  local tag folder order log
  tag=$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  folder=$(mktemp -d)
  log=$folder/log
  python3 -m zipfile --extract "$wheels"/firetwin_core-*-"$tag"-*.whl "$folder/wheel"
  for order in before after preloaded; do
    if ! "$1" tests/system/package/wheel.py "$folder/wheel" "$order" >"$log" 2>&1; then
      tail -n 30 "$log" >&2
      echo "wheels: FAILED: $1, $order" >&2
      exit 1
    fi
    tail -n 1 "$log"
  done
  "$1" tests/system/package/throughput.py "$folder/wheel"
  rm -rf "$folder"
}

for_each_blender try
if [[ -z ${FIRETWIN_INSIDE:-} ]] && compgen -G "$wheels/firetwin-*.whl" >/dev/null; then
  tests/system/package/pip.sh "$wheels"
fi
in_other_python tests/system/wheels.sh --try "$wheels"
