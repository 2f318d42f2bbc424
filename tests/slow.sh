#!/usr/bin/env bash
# Runs the tests that tests/run.sh does not run, slowest last, and lists those that did not fit into the time.
# Libraries and Debian folders are cached in $FIRETWIN_CACHE (~/.cache/firetwin), so that more tests fit the next time.
#
#   tests/slow.sh            as much as fits into 35 minutes
#   tests/slow.sh SECONDS    as much as fits into so many seconds
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

limit=${1:-2100}
cache=${FIRETWIN_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/firetwin}
export FIRETWIN_PORTABLE=$cache/portable FIRETWIN_DEBIAN=$cache/debian
mkdir -p "$cache"
result=0 summary=()

# Runs a command that needs about this many minutes, if that much time is left.
slow() { # minutes command...
  local needs=$(($1 * 60)) left=$((limit - SECONDS)) from=$SECONDS status=0
  shift
  local name="$*"
  name=${name#.venv/bin/python -m }
  if ((left < needs)); then
    summary+=("left out: $name needs about $((needs / 60)) min; $((left > 0 ? left / 60 : 0)) are left")
    return
  fi
  echo "== $name"
  timeout --kill-after=20 "$left" "$@" || status=$?
  case $status in
    0) summary+=("passed: $name, $((SECONDS - from)) s") ;;
    77) summary+=("left out: $name or a part of it cannot run here; why is said above") ;;
    124 | 137) summary+=("left out: $name had not ended when the time was over; what it built is kept") ;;
    *)
      summary+=("FAILED: $name ended with $status")
      result=1
      ;;
  esac
}

pytest=(.venv/bin/python -m pytest -q -n "$(nproc)" --dist worksteal --max-worker-restart 0)
slow 2 "${pytest[@]}" tests/render
slow 3 "${pytest[@]}" tests/unit -m hypothesis --hypothesis-profile thorough -o budget_factor=10
slow 3 tests/system/fuzz/run.sh --runs 20000
slow 3 .venv/bin/python tests/system/fuzz/scenes.py --builds 20 --seconds 150
slow 3 .venv/bin/python tests/system/fuzz/convert.py --each 200
slow 2 .venv/bin/python tests/system/fuzz/tilesets.py --runs 10000
slow 3 "${pytest[@]}" tests/system --ignore tests/system/farm
built=false
if [[ -d $FIRETWIN_PORTABLE/wheels ]]; then
  built=true
  slow 3 tests/system/wheels.sh
  slow 4 tests/system/extension.sh
fi
slow 9 tests/system/versions.sh 5.2
if [[ $built == false ]]; then
  slow 18 tests/system/wheels.sh # with the libraries
  if [[ -d $FIRETWIN_PORTABLE/wheels ]]; then
    slow 4 tests/system/extension.sh
  else
    summary+=("left out: tests/system/extension.sh needs the wheels")
  fi
fi
slow 20 "${pytest[@]}" tests/system/farm
slow 16 tests/system/window.sh
slow 20 tests/system/sanitize.sh
printf '%s\n' "== what tests/run.sh leaves out" "${summary[@]}"
exit "$result"
