#!/usr/bin/env bash
# Installs the extension in the real Blender 5.2 and uses it in its window, as an artist does, and takes pictures.
#
#   tests/system/window.sh                  everything
#   tests/system/window.sh panel build      only these steps of use.sh's list; it is always installed before and
#                                    uninstalled after
#
# Debian's development release has that Blender, with Python 3.14. Its folder is build/debian/sid, or
# $FIRETWIN_DEBIAN/sid (tests/system/in_debian.sh); the core and a zip with it are built there. Pictures and logs go to
# build/shared/window, pictures of the artists' page to page/ in it (copy them to docs/pictures/). No display is needed.
# $FIRETWIN_PATIENCE is the longest wait for any event, s (1800).
# Exit status 1: a check failed; 77: there is no such folder, and the skipped steps are listed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${FIRETWIN_DEBIAN:-build/debian}/sid
out=build/shared/window

say() { echo "window: $*" >&2; }

# Runs a command in the folder; a missing folder does not fail.
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
