#!/usr/bin/env bash
# Checks the changes of the working tree: lints changed files, compiles C++ and runs the nearest tests (tests/touched.py).
#
#   tests/quick.sh             changes since the last commit, untracked files included
#   tests/quick.sh REVISION    changes since this revision
#
# At most a minute of tests; tests/run.sh runs all tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mapfile -t changed < <({
  git diff --name-only --relative "${1:-HEAD}"
  git ls-files --others --exclude-standard
} | sort -u)
if ((${#changed[@]} == 0)); then
  echo "quick: nothing has changed" >&2
  exit
fi
examples/setup.sh --with-tests
present=()
for file in "${changed[@]}"; do
  if [[ -f $file ]]; then
    present+=("$file")
  fi
done
if ((${#present[@]})); then
  tests/lint.sh "${present[@]}"
fi
mapfile -t tests < <(.venv/bin/python tests/touched.py "${changed[@]}")
if ((${#tests[@]} == 0)); then
  echo "quick: no test is near what has changed" >&2
  exit
fi
printf 'quick: %s\n' "${tests[@]}" >&2
.venv/bin/python -m pytest -q -n "$(nproc)" --dist worksteal --max-worker-restart 0 --hypothesis-profile quick "${tests[@]}"
