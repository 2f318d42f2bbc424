#!/usr/bin/env bash
# To be sourced by tests/system/wheels.sh and tests/system/extension.sh, in the root of the checkout.

# The Pythons with Blender's module that this machine has.
blenders() {
  local python
  for python in ${FIRETWIN_BLENDERS:-.venv/bin/python build/versions/bpy-5.0/bin/python}; do
    if [[ -x $python ]] && "$python" -c 'import importlib.util, sys; sys.exit(importlib.util.find_spec("bpy") is None)'; then
      echo "$python"
    else
      echo "skipped: $python has no Blender (examples/setup.sh, tests/system/versions.sh)" >&2
    fi
  done
}

for_each_blender() { # function; called with each Python
  local python found=()
  mapfile -t found < <(blenders)
  if ((${#found[@]} == 0)); then
    echo "there is no Python with Blender's module here; examples/setup.sh makes one" >&2
    exit 1
  fi
  for python in "${found[@]}"; do
    "$1" "$python"
  done
}

# The same script in the Debian folder with the missing Python; files below build/shared are the same in it.
in_other_python() { # script --option folder-or-file
  local folder=${FIRETWIN_DEBIAN:-build/debian}/trixie shared
  if [[ -n ${FIRETWIN_INSIDE:-} ]]; then
    return
  fi
  if [[ ! -x tests/system/in_debian.sh || ! -x $folder/firetwin/.venv/bin/python ]]; then
    echo "skipped: Blender 5.2, because there is no $folder with it (tests/system/versions.sh 5.2 makes it)" >&2
    return
  fi
  shared=build/shared/$(basename "$3")
  mkdir -p build/shared
  rm -rf "$shared"
  cp -r "$3" "$shared"
  tests/system/in_debian.sh trixie "$folder" env FIRETWIN_INSIDE=1 FIRETWIN_BLENDERS=.venv/bin/python "$1" "$2" "$shared"
}
