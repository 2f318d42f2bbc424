#!/usr/bin/env bash
# Checks format and lint of all files, or of those named.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Checks the import contracts in pyproject.toml, on the package as it is installed, with data/ in it. Features are the folders
# with a command.py.
check_floors() {
  local staged rooms status=0
  rooms=$(cd addon && printf '%s | ' */command.py | sed 's#/command.py##g; s/ | $//')
  staged=$(mktemp -d)
  cp -r addon "$staged/firetwin"
  cp -r data "$staged/firetwin/data"
  sed "s/{rooms}/$rooms/" pyproject.toml >"$staged/contracts.toml"
  PYTHONPATH=$staged .venv/bin/lint-imports "$staged/contracts.toml" --no-logo --no-cache >"$staged/log" || status=$?
  if ((status)); then
    cat "$staged/log"
  fi
  rm -r "$staged"
  return "$status"
}

files=("$@")
if ((${#files[@]} == 0)); then
  mapfile -t files < <(find .ci addon cpp data docs examples tests ./*.md -type f ! -path '*/out/*')
fi
python=() cpp=() shell=()
for file in "${files[@]}"; do
  case $file in
    *.py) python+=("$file") ;;
    *.cpp | *.hpp) cpp+=("$file") ;;
    *.sh | .ci/run) shell+=("$file") ;;
  esac
done
.venv/bin/codespell "${files[@]}"
if (($# == 0)); then
  .venv/bin/zizmor --offline --quiet .github/workflows
  if [[ -e .git ]]; then # otherwise it would read .venv and build too
    .venv/bin/reuse lint --quiet || .venv/bin/reuse lint
  fi
fi
.venv/bin/python tests/prose # all files: the rate is by folder
if ((${#python[@]})); then
  .venv/bin/ruff format --check "${python[@]}"
  .venv/bin/ruff check "${python[@]}"
  check_floors
  # Type hints of the package, with NumPy of Blender 4.5 (Python 3.11): types of NumPy 2 differ.
  if .venv/bin/python -c 'import sys, numpy; sys.exit(not numpy.__version__.startswith("1."))'; then
    .venv/bin/mypy --no-error-summary
  else
    echo "skipped: mypy, which needs NumPy 1 (Python 3.11)" >&2
  fi
fi
if ((${#cpp[@]})); then
  printf '%s\0' "${cpp[@]}" | xargs -0 -n 40 -P "$(nproc)" .venv/bin/clang-format --dry-run --Werror
fi
if ((${#shell[@]})); then
  shellcheck -x "${shell[@]}"
fi
