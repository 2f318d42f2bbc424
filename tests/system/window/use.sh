#!/usr/bin/env bash
# Inside the Debian folder: uses the extension in Blender's command line, then in its window on a virtual screen.
# Blender's settings and extensions are in a separate folder.
# usage: tests/system/window/use.sh OUT [STEP ...], a folder with firetwin.zip
set -euo pipefail
cd "${1:?usage: tests/system/window/use.sh OUT [STEP ...]}"
shift
steps=("$@")
if ((${#steps[@]} == 0)); then
  steps=(commands panel quality build sections dialogs look parts scrub render)
  steps+=(manual find pie shortcuts german preferences assets allocate
    by_hand undo beside file drop tiles page cache headset)
fi
here=/firetwin/tests/system/window
export LIBGL_ALWAYS_SOFTWARE=1 BLENDER_USER_RESOURCES=$PWD/user

say() { echo "window: $*" >&2; }

# blender without the lines that Debian's prints about this folder's missing devices
firetwin() { # status arguments...
  local want=$1 status=0
  shift
  echo "\$ blender --command firetwin $*" >>commands.log
  blender --disable-autoexec --command firetwin "$@" >>commands.log 2>&1 || status=$?
  if ((status != want)); then
    tail -n 20 commands.log >&2
    say "FAILED: blender --command firetwin $* ended with $status, not $want"
    exit 1
  fi
}

# Monado with a headset that only the step `headset` moves; without a compositor that needs a GPU.
headset() {
  if ! command -v monado-service >/dev/null; then
    say "SKIPPED: the step headset, because Monado is missing (Debian: apt-get install monado-service libopenxr1-monado)"
    return
  fi
  export XDG_RUNTIME_DIR=/tmp/firetwin-headset XR_RUNTIME_JSON=/usr/share/openxr/1/openxr_monado.json
  rm -rf "$XDG_RUNTIME_DIR"
  mkdir -m 700 "$XDG_RUNTIME_DIR"
  VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json P_OVERRIDE_ACTIVE_CONFIG=remote XRT_COMPOSITOR_NULL=1 \
    XRT_NO_STDIN=1 monado-service >monado.log 2>&1 &
  trap 'kill %1 2>/dev/null || true' EXIT
  until [[ -S $XDG_RUNTIME_DIR/monado_comp_ipc ]] || ! kill -0 %1 2>/dev/null; do sleep 0.2; done
}

prepare() {
  say "Blender's command line; all it says is in commands.log"
  blender --command extension install-file --repo user_default --enable firetwin.zip >commands.log 2>&1
  firetwin 0 sample sample --frames 61
  if [[ " ${steps[*]} " == *" allocate "* ]]; then
    firetwin 0 stations exercise sample --out exercise.gpkg
  fi
  if [[ " ${steps[*]} " == *" tiles "* ]]; then
    firetwin 0 tiles make scene.toml --out tileset --levels 2 --geoid -24.9 --credit Sample
  fi
}

commands() {
  firetwin 0 --version
  firetwin 0 info sample
  firetwin 1 info nowhere
  firetwin 2 render scene.toml
  firetwin 0 build scene.toml -o scene.blend
  firetwin 0 render scene.toml --out film --frames 2 --passes rgb
  firetwin 1 render broken.toml --out film
  firetwin 0 render scene.toml --out film --frames 2 --passes rgb --resume
}

leave() {
  blender --command extension remove firetwin >>commands.log 2>&1
  if [[ -n $(find user/extensions -iname '*firetwin*' -print -quit) ]]; then
    find user/extensions -iname '*firetwin*' >&2
    say "FAILED: the command line leaves this behind"
    exit 1
  fi
  rm -rf user
}

session() {
  say "the window; a picture of every step is taken"
  # A first start asks for language and theme.
  blender --background --python-expr 'import bpy
bpy.context.preferences.view.show_splash = False
bpy.ops.wm.save_userpref()' >window.log 2>&1
  Xvfb -displayfd 1 -screen 0 1280x800x24 >display 2>/dev/null &
  local screen=$! status=0
  until [[ -s display ]]; do sleep 0.2; done
  DISPLAY=:$(<display) blender --window-geometry 0 0 1280 800 --python "$here/session.py" -- "$PWD" "${steps[@]}" \
    >>window.log 2>&1 || status=$?
  kill "$screen"
  cat session.log
  if ((status != 0)); then
    tail -n 30 window.log >&2
    say "FAILED: the session ended with $status"
    exit 1
  fi
  if grep -q Traceback window.log; then
    grep -A 20 Traceback window.log >&2
    say "FAILED: Blender printed a traceback"
    exit 1
  fi
}

cp "$here"/*.toml .
sed 's/^\[smoke\]$/&\nenabled = false/' scene.toml >plain.toml
prepare
if [[ " ${steps[*]} " == *" commands "* ]]; then
  commands
fi
leave
if [[ " ${steps[*]} " == *" headset "* ]]; then
  headset
fi
session
