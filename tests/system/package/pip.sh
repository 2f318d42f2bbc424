#!/usr/bin/env bash
# Installs the wheels of a folder as users do, and renders a frame with the command: pip.sh WHEELS
# The other packages, and Blender's module (350 MB), come from pip's cache or its index.
set -euo pipefail
wheels=$(realpath "${1:?usage: pip.sh WHEELS}")
python=${FIRETWIN_PYTHON:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" # not in a checkout

"$python" -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check --prefer-binary --find-links "$wheels" 'firetwin[blender]'
venv/bin/pip check
venv/bin/pip list --disable-pip-version-check | grep -E '^(firetwin|bpy)'
cat >scene.toml <<'END'
run = "run"
time = { start = 2014-09-17T23:12:00Z, frames = 1 }
forest = { draw_distance = 500.0 }
smoke = { enabled = false }
render = { resolution = [64, 36], samples = 1 }
cameras = [{ name = "drone", keys = [{ latitude = 38.977, longitude = -120.572, height = 150.0, target = "head" }] }]
END
venv/bin/firetwin --version
venv/bin/firetwin sample run --frames 3
venv/bin/firetwin render scene.toml --out film --passes rgb
picture=$(find film -name '*.png' | head -n 1)
[[ -n $picture ]] || { echo "pip: no picture was rendered" >&2; exit 1; }
echo "ok: pip installed $(basename "$wheels"), $(basename "$picture") has $(stat --format=%s "$picture") bytes"
