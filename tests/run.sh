#!/usr/bin/env bash
# Sets up, then runs the checks that every change must pass: format and lint, the documentation, tests/unit,
# tests/blender, and a frame of each pass.
# On 2 cores it takes about 11 minutes on a fresh machine and 9 afterwards.
#
#   tests/run.sh          these checks
#   tests/run.sh --all    these, then all others (tests/slow.sh), within 30 minutes in total
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

all=false
case ${1:-} in
  '') ;;
  --all) all=true ;;
  *)
    echo "usage: tests/run.sh [--all]" >&2
    exit 2
    ;;
esac

# One worker for each processor core. One process alone also ends: tests/system/test_handlers.py tells why.
pytest() {
  .venv/bin/python -m pytest -q -n "$(nproc)" --dist worksteal --max-worker-restart 0 "$@"
}

examples/setup.sh --with-tests
echo "== format and lint"
tests/lint.sh
if [[ -x .venv/bin/mkdocs ]]; then
  echo "== documentation"
  NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --strict --quiet
fi
echo "== unit: no Blender"
pytest tests/unit
echo "== blender: scenes"
pytest tests/blender
echo "== render: a frame of each pass"
pytest tests/render/test_passes.py tests/render/test_passes_normal.py tests/render/test_layers.py tests/render/test_comparison.py
if $all; then
  tests/slow.sh $((30 * 60 - SECONDS))
fi
