#!/usr/bin/env bash
# Checks format and lint of all files, or of those named.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

files=("$@")
if ((${#files[@]} == 0)); then
  mapfile -t files < <(find .ci addon cpp data docs examples tests -type f ! -path '*/out/*')
fi
python=() cpp=() shell=()
for file in "${files[@]}"; do
  case $file in
    *.py) python+=("$file") ;;
    *.cpp | *.hpp) cpp+=("$file") ;;
    *.sh | .ci/run) shell+=("$file") ;;
  esac
done
if ((${#python[@]})); then
  .venv/bin/ruff format --check "${python[@]}"
  .venv/bin/ruff check "${python[@]}"
fi
if ((${#cpp[@]})); then
  printf '%s\0' "${cpp[@]}" | xargs -0 -n 40 -P "$(nproc)" .venv/bin/clang-format --dry-run --Werror
fi
if ((${#shell[@]})); then
  shellcheck -x "${shell[@]}"
fi
