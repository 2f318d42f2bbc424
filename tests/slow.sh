#!/usr/bin/env bash
# Runs the tests that tests/run.sh does not run, and lists those that did not fit into the time. Farms come first.
# Fuzzers and chaos.py run only if a file that they test has changed since yesterday; each night they run in any case.
# Libraries and Debian folders are cached in $FIRETWIN_CACHE (~/.cache/firetwin), so that more tests fit the next time.
#
#   tests/slow.sh                      as much as fits into 25 minutes
#   tests/slow.sh SECONDS              as much as fits into so many seconds
#   tests/slow.sh --release            what only a release and each night need: wheels, extension, Blender 5.2, its
#                                      window, sanitizers, fuzzers, an hour of faults; within 3 hours
#   tests/slow.sh --release SECONDS    as much of that as fits into so many seconds
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

release=false
if [[ ${1:-} == --release ]]; then
  release=true
  shift
fi
limit=${1:-$($release && echo 10800 || echo 1500)}
cache=${FIRETWIN_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/firetwin}
export FIRETWIN_PORTABLE=$cache/portable FIRETWIN_DEBIAN=$cache/debian
mkdir -p "$cache"
result=0 summary=()

# Runs a command that needs about this many minutes, if that much time is left. 0: always, for at
# least 15 minutes, and it must end.
slow() { # minutes command...
  local needs=$(($1 * 60)) left=$((limit - SECONDS)) from=$SECONDS status=0
  shift
  local name="$*"
  name=${name#.venv/bin/python -m }
  if ((needs == 0 && left < 900)); then
    left=900
  fi
  if ((left < needs)); then
    summary+=("left out: $name needs about $((needs / 60)) min; $((left > 0 ? left / 60 : 0)) are left")
    return
  fi
  echo "== $name"
  timeout --kill-after=20 "$left" "$@" || status=$?
  case $status in
    0) summary+=("passed: $name, $((SECONDS - from)) s") ;;
    77) summary+=("left out: $name or a part of it cannot run here; why is said above") ;;
    124 | 137)
      summary+=("left out: $name had not ended when the time was over; what it built is kept")
      if ((needs == 0)); then
        result=1
      fi
      ;;
    *)
      summary+=("FAILED: $name ended with $status")
      result=1
      ;;
  esac
}

# A test of files that change rarely, by day: what no commit has changed since yesterday was tested last night.
daily() { # minutes files command...
  # shellcheck disable=SC2086 # a list of paths
  if ! $release && git rev-parse --quiet --verify HEAD >/dev/null && [[ -z $(git log -1 --since=1.day --format=%h -- $2) ]]; then
    summary+=("left to the night: ${*:3}; no commit since yesterday changes $2")
  else
    slow "$1" "${@:3}"
  fi
}

fuzzers() {
  local fuzz=tests/system/fuzz
  daily 2 "$fuzz cpp/base cpp/io cpp/run cpp/tiles" $fuzz/run.sh --runs 20000
  daily 1 "$fuzz/tilesets.py addon/tiles cpp/tiles" .venv/bin/python $fuzz/tilesets.py --runs 10000
  daily 2 "$fuzz/files.py addon/run addon/stations addon/camera_import addon/story" .venv/bin/python $fuzz/files.py --seconds 10
  daily 2 "$fuzz/convert.py addon/run" .venv/bin/python $fuzz/convert.py --each 200
}

pytest=(.venv/bin/python -m pytest -q -n "$(nproc)" --dist worksteal --max-worker-restart 0)
if $release; then
  slow 18 tests/system/wheels.sh # with the libraries, unless they are cached
  if [[ -d $FIRETWIN_PORTABLE/wheels ]]; then
    slow 4 tests/system/extension.sh
  else
    summary+=("left out: tests/system/extension.sh needs the wheels")
  fi
  slow 3 tests/system/dataset_oracles.sh
  slow 9 tests/system/versions.sh 5.2
  fuzzers
  slow 3 .venv/bin/python tests/system/fuzz/scenes.py --builds 20 --seconds 150
  slow 16 tests/system/window.sh
  slow 20 tests/system/sanitize.sh
  slow 65 .venv/bin/python tests/system/chaos/chaos.py --minutes 60
  title="what a release needs"
else
  done=()
  for name in passes passes_normal layers comparison; do # of tests/run.sh
    done+=("--ignore=tests/render/test_$name.py")
  done
  slow 0 "${pytest[@]}" tests/system/farm
  slow 0 "${pytest[@]}" tests/system --ignore tests/system/farm
  slow 0 "${pytest[@]}" tests/render "${done[@]}"
  slow 2 "${pytest[@]}" tests/unit -m hypothesis --hypothesis-profile thorough -o budget_factor=10
  fuzzers
  daily 1 "tests/system/fuzz/scenes.py addon/shot" .venv/bin/python tests/system/fuzz/scenes.py --builds 8 --seconds 50
  writers="addon/leases.py addon/files.py addon/output.py addon/staging.py addon/unfinished.py addon/written.py"
  jobs="addon/render addon/farm addon/tiles addon/smoke addon/export addon/delivery addon/growing addon/dataset addon/story"
  daily 8 "tests/system/chaos $writers $jobs" \
    .venv/bin/python tests/system/chaos/chaos.py --minutes 5
  title="what tests/run.sh leaves out"
fi
printf '%s\n' "== $title" "${summary[@]}"
exit "$result"
