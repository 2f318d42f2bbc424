#!/usr/bin/env bash
# Installs the extension in the real Blender 5.2 and uses it in its window, as an artist does, and takes pictures.
#
#   tests/system/window.sh                  everything
#   tests/system/window.sh panel build      only these steps of use.sh's list; it is always installed before and
#                                    uninstalled after
#
# Debian's development release has that Blender, with Python 3.14. It is kept in build/debian/sid, or in
# $FIRETWIN_DEBIAN/sid (tests/system/in_debian.sh); the core is built there, and a zip made that carries it. The pictures
# and the logs are then in build/shared/window, those of the artists' page in page/ there (they belong into
# docs/pictures/). No display is needed. $FIRETWIN_PATIENCE is how many seconds it waits
# for any one thing (1800).
# Exit status 1: something is not as it should be; 77: there is no such folder, and what was skipped is said.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${FIRETWIN_DEBIAN:-build/debian}/sid
out=build/shared/window

say() { echo "window: $*" >&2; }

# What runs in the folder; no folder is no failure.
inside() {
  local status=0
  tests/system/in_debian.sh sid "$folder" "$@" || status=$?
  if ((status == 77)); then
    say "SKIPPED: installing and using the extension in the window of Blender 5.2; why is said above"
  fi
  return "$status"
}

rm -rf "$out"
mkdir -p "$out/wheels"
inside tests/system/window/prepare.sh "$out/wheels"
if ! .venv/bin/python -c 'import importlib.util as u, sys; sys.exit(u.find_spec("bpy") is None)' 2>/dev/null; then
  examples/setup.sh
fi
.venv/bin/python cpp/portable/extension.py "$out/zip" "$out/wheels"
cp "$out"/zip/firetwin-*.zip "$out/firetwin.zip"
rm -rf "$out/zip"
inside env FIRETWIN_PATIENCE="${FIRETWIN_PATIENCE:-1800}" tests/system/window/use.sh "$out" "$@"
say "all is as it should be; pictures and logs are in $out"
