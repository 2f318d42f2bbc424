#!/usr/bin/env bash
# Fuzzes the readers: text grids, .npy files, complete run folders, and the content of 3D Tiles. Builds into build/fuzz.
#
#   tests/system/fuzz/run.sh                   200,000 executions of each
#   tests/system/fuzz/run.sh --runs 10000000   as many of each
#   tests/system/fuzz/run.sh --seconds 60      a minute of each
#   tests/system/fuzz/run.sh --jobs 2 ...      in this many processes, which share runs and findings
#   tests/system/fuzz/run.sh ... text npy      these only
#
# An input that breaks a reader is left in build/fuzz/findings; exit status 1.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

all="text npy run b3dm i3dm cmpt pnts gltf"
say() { echo "fuzz: $*" >&2; }
usage() {
  echo "usage: tests/system/fuzz/run.sh [--runs N | --seconds N] [--jobs N] [${all// /|} ...]" >&2
  exit 2
}

runs=200000
seconds=
jobs=1
readers=()
while (($#)); do
  case $1 in
    --runs | --seconds | --jobs)
      [[ ${2-} =~ ^[1-9][0-9]*$ ]] || usage
      printf -v "${1#--}" %s "$2"
      shift 2
      ;;
    *)
      [[ $1 =~ ^(${all// /|})$ ]] || usage
      readers+=("$1")
      shift
      ;;
  esac
done
if ((${#readers[@]} == 0)); then
  read -ra readers <<<"$all"
fi

find_clang() {
  local candidate
  for candidate in clang++ clang++-19 clang++-17 clang++-16 clang++-14; do
    if command -v "$candidate" >/dev/null && echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
      "$candidate" -fsanitize=fuzzer,address -x c++ - -o /dev/null 2>/dev/null; then
      echo "$candidate"
      return
    fi
  done
}

compiler=$(find_clang)
if [[ -z $compiler ]]; then
  command -v apt-get >/dev/null || { say "needs clang with its libFuzzer and sanitizer runtimes"; exit 1; }
  as_root=()
  ((EUID == 0)) || as_root=(sudo)
  say "installing clang with apt-get"
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install \
    -y -q --no-install-recommends clang libclang-rt-dev; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    say "apt-get failed; see $log"
    exit 1
  fi
  rm -f "$log"
  compiler=$(find_clang)
fi

build=build/fuzz
cmake -S tests/system/fuzz -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=None >/dev/null
cmake --build "$build" -j 2 --target "${readers[@]/#/fuzz_}" >&2
python3 tests/system/fuzz/seeds.py "$build/seeds"

limit=-runs=$(((runs + jobs - 1) / jobs))
[[ -z $seconds ]] || limit=-max_total_time=$seconds

# Becomes a fuzzer, with a separate log for each job.
fuzz() {
  local words=tests/system/fuzz/$1.dict
  [[ -f $words ]] || words=tests/system/fuzz/tiles.dict
  # Short stacks of allocations and no weights of rare features, which cost more than the readers do.
  export ASAN_OPTIONS=quarantine_size_mb=16:malloc_context_size=4
  exec "$build/fuzz_$1" "$limit" \
    -max_len=1024 -timeout=60 -rss_limit_mb=1024 -entropic=0 -print_final_stats=1 \
    -dict="$words" -artifact_prefix="$build/findings/$1-" \
    "$build/corpus/$1" "$build/seeds/$1" >"$build/$1.$2.log" 2>&1
}

for reader in "${readers[@]}"; do
  say "$reader: $limit in each of $jobs"
  mkdir -p "$build/corpus/$reader" "$build/findings"
  processes=()
  for ((job = 1; job <= jobs; job++)); do
    fuzz "$reader" "$job" &
    processes+=($!)
  done
  for ((job = 1; job <= jobs; job++)); do
    if ! wait "${processes[job - 1]}"; then
      kill "${processes[@]}" 2>/dev/null || true
      tail -n 40 "$build/$reader.$job.log" >&2
      say "$reader: a finding; the input is in $build/findings"
      exit 1
    fi
  done
  for ((job = 1; job <= jobs; job++)); do
    grep -a number_of_executed_units "$build/$reader.$job.log"
  done | awk -v reader="$reader" '{ sum += $2 } END { print "fuzz: " reader ": no finding, executions: " sum }'
done
