#!/usr/bin/env bash
# Installs what is needed and runs every test: formatting and lint, the core, and Blender.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
examples/setup.sh --with-tests

echo "== format and lint"
.venv/bin/ruff format --check addon data tests cpp/portable
.venv/bin/ruff check addon data tests cpp/portable
find cpp tests/fuzz \( -name '*.cpp' -o -name '*.hpp' \) -print0 | xargs -0 .venv/bin/clang-format --dry-run --Werror
shellcheck examples/*.sh tests/*.sh tests/fuzz/*.sh tests/package/*.sh tests/window/*.sh cpp/portable/*.sh .ci/run

echo "== core"
.venv/bin/python -m pytest tests/core -q -n 2 --dist loadfile --max-worker-restart 0
echo "== fuzz"
tests/fuzz/run.sh --runs 20000
echo "== blender"
.venv/bin/python -m pytest tests/blender -q -n 2 --dist loadfile --max-worker-restart 0
