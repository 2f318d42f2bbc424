#!/usr/bin/env bash
# Runs tests/blender and tests/render in every Blender that Firetwin supports, and compares their pictures.
#
#   tests/system/versions.sh                    tests in Blender 4.5, 5.0 and 5.2
#   tests/system/versions.sh --picture          the drone frame of the example in each version, compared by FLIP
#   tests/system/versions.sh --files 4.5 5.2    a scene saved by each version, opened and used by the others, and back
#   tests/system/versions.sh 5.2                this version only
#   tests/system/versions.sh 5.2 -- -k smoke    arguments for pytest
#
# Blender as a Python module needs Python 3.11 up to 5.0, and 3.13 from 5.1. A version without its Python on this
# machine runs in a folder with a Debian that has it (tests/system/in_debian.sh), in build/debian or $FIRETWIN_DEBIAN.
# If the folder cannot be made, the version is skipped, and the last lines report it.
# Exit status 1: a test or a comparison failed; 77: nothing failed and something was skipped.
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

known=(4.5 5.0 5.2)
declare -A suite=([4.5]=bookworm [5.0]=bookworm [5.2]=trixie)
declare -A python=([4.5]=3.11 [5.0]=3.11 [5.2]=3.13)
debian=${FIRETWIN_DEBIAN:-build/debian}
shared=build/shared # the same inside and outside a folder

say() { echo "versions: $*" >&2; }
usage() {
  sed -n '4,8s/^# *//p' "$0" >&2
  exit 2
}

picture=false here=false files='' versions=()
while (($#)); do
  case $1 in
    --picture) picture=true ;;
    --files) files=save ;;
    --open) files=open ;; # after --files has saved them
    --here) here=true ;; # run these versions with this machine's Python; used inside a folder
    --)
      shift
      break
      ;;
    4.5 | 5.0 | 5.2) versions+=("$1") ;;
    *) usage ;;
  esac
  shift
done
if ((${#versions[@]} == 0)); then
  versions=("${known[@]}")
fi

# The module that setup.sh puts in .venv is the newest long-term release for its Python; others get a venv.
interpreter() {
  if [[ $1 != 5.0 ]]; then
    echo .venv/bin/python
    return
  fi
  local venv=build/versions/bpy-5.0
  if [[ ! -f $venv/stamp || $(<"$venv/stamp") != $(<.venv/firetwin.stamp) ]]; then
    say "installing Blender 5.0 in $venv"
    if [[ ! -x $venv/bin/python ]]; then
      .venv/bin/python -m venv "$venv"
    fi
    "$venv/bin/pip" install --quiet --disable-pip-version-check "scikit-build-core==1.1.2" "pybind11==3.1.0" >&2
    "$venv/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation --config-settings=wheel.cmake=false \
      ".[test]" bpy==5.0.1 >&2
    cp .venv/firetwin.stamp "$venv/stamp"
  fi
  cp -r .venv/lib/python3.*/site-packages/{firetwin_core*,*firetwin_checkout*} "$venv"/lib/python3.*/site-packages/
  echo "$venv/bin/python"
}

# One version with this machine's Python.
run_here() {
  local version=$1 python
  shift
  examples/setup.sh --with-tests
  python=$(interpreter "$version")
  if $picture; then
    "$python" tests/system/picture.py render "$shared/sample" "$shared/picture/$version"
  elif [[ $files == save ]]; then
    "$python" tests/system/between.py save "$shared/sample" "$shared/files"
  elif [[ $files == open ]]; then
    "$python" tests/system/between.py open "$shared/files"
  else
    "$python" -m pytest tests/blender tests/render -q -n 2 --dist worksteal "$@"
  fi
}

has_python() {
  local candidate
  for candidate in .venv/bin/python /usr/bin/python3; do
    if [[ -x $candidate ]]; then
      "$candidate" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$1')"
      return
    fi
  done
  return 1
}

# The pictures show the same run; it gets its name when it is complete.
sample() {
  if [[ ! -d $shared/sample ]]; then
    examples/setup.sh --with-tests
    rm -rf "$shared/sample.part"
    .venv/bin/firetwin sample "$shared/sample.part" >/dev/null
    mv "$shared/sample.part" "$shared/sample"
  fi
}

flip=build/versions/flip
install_flip() {
  if [[ ! -f $flip/stamp ]]; then
    .venv/bin/python -m venv "$flip"
    "$flip/bin/pip" install --quiet --disable-pip-version-check "flip-evaluator==1.7" numpy >&2
    touch "$flip/stamp"
  fi
}

mkdir -p build/versions "$shared"
if $here; then
  for version in "${versions[@]}"; do
    run_here "$version" "$@"
  done
  exit
fi

options=()
if $picture; then
  options=(--picture)
  sample
  install_flip
fi
if [[ $files == save ]]; then
  sample
  rm -rf "$shared/files"
  options=(--files)
  # Twice: earlier versions also open files that a later version has saved.
  versions=("${versions[@]}" open "${versions[@]}" "${versions[0]}")
fi
passed=() failed=() skipped=()
for version in "${versions[@]}"; do
  if [[ $version == open ]]; then
    options=(--open)
    continue
  fi
  say "Blender $version"
  status=0
  folder=()
  if ! has_python "${python[$version]}"; then
    folder=(tests/system/in_debian.sh "${suite[$version]}" "$debian/${suite[$version]}")
  fi
  "${folder[@]}" tests/system/versions.sh "${options[@]}" --here "$version" -- "$@" || status=$?
  case $status in
    0) passed+=("$version") ;;
    77) skipped+=("$version") ;;
    *) failed+=("$version") ;;
  esac
done
if $picture && ((${#passed[@]} > 1)); then
  "$flip/bin/python" tests/system/picture.py compare "${passed[@]/#/$shared/picture/}" || failed+=(comparison)
fi

say "passed: ${passed[*]:-none}; failed: ${failed[*]:-none}; skipped: ${skipped[*]:-none}"
for version in "${skipped[@]}"; do
  say "Blender $version needs Python ${python[$version]}; the reason why there is no folder with it is above"
done
if ((${#failed[@]})); then
  exit 1
fi
if ((${#skipped[@]})); then
  exit 77
fi
