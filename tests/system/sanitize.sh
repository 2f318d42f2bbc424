#!/usr/bin/env bash
# Builds the core with AddressSanitizer and UndefinedBehaviourSanitizer and runs tests/unit with it.
# Arguments go to pytest. Needs .venv (examples/setup.sh --with-tests), or PYTHON set to another one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
python=${PYTHON:-.venv/bin/python}
build=build/sanitize

cmake --preset asan -B "$build" -DPython_EXECUTABLE="$(realpath --no-symlinks "$python")" >/dev/null
cmake --build "$build" -j 2 >&2

# The package as it is installed, and the sanitized module.
package=$build/package
rm -rf "$package"
mkdir -p "$package"
cp -r addon "$package/firetwin"
cp -r data "$package/firetwin/data"
cp "$build"/firetwin_core*.so "$package"

libraries="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libubsan.so) $(g++ -print-file-name=libstdc++.so.6)"
# Leaks are not checked: Python leaves many when it ends.
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export PYTHONMALLOC=malloc PYTHONPATH=$package LD_PRELOAD=$libraries
# Tests that measure memory would measure the memory of the sanitizer. Processes that limit their address space, such
# as decoders of tiles, cannot start with its shadow memory; tests/system/fuzz/run.sh runs their code with sanitizers.
dense=tests/unit/smoke/test_volume_dense.py
exec "$python" -m pytest tests/unit -q -n "$(nproc)" --dist worksteal -p no:cacheprovider "$@" \
  -o longest_s=600 -o budget_factor=50 \
  --deselect "$dense::test_memory_does_not_grow_with_the_grid" \
  --deselect "$dense::test_levels_without_smoke_need_no_memory" \
  --deselect "$dense::test_air_without_smoke_needs_no_memory" \
  --deselect tests/unit/commands/test_memory.py::test_what_is_free_between_what_is_used_goes_back \
  --deselect tests/unit/commands/test_memory.py::test_the_peak_stays_when_memory_is_free_again \
  --deselect tests/unit/models/test_convert.py::test_damaged_files_are_a_run_or_one_line \
  --deselect tests/unit/tiles/servers/test_tiles_chain.py::test_a_decoder_that_dies_loses_its_tile_alone \
  --deselect tests/unit/tiles/servers/test_tiles_chain.py::test_a_decoder_over_its_memory_loses_its_tile_alone \
  --deselect tests/unit/tiles/content/test_tiles_decode.py
