#!/usr/bin/env bash
# Makes the film and the small pictures of README.md from renders of the synthetic sample run, and how/tiles.svg.
# A second run renders only missing files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

../../examples/sample.sh
firetwin=../../.venv/bin/firetwin
out=../../examples/out

"$firetwin" render ../../examples/king_fire.toml --out "$out/film" --frames 25-48 --resume
"$firetwin" render forest.toml --out "$out/forest" --resume
[[ -f $out/maps/intensity.png ]] || "$firetwin" maps "$out/sample" --out "$out/maps"
"$firetwin" story "$out/sample" --out "$out/story" --resume
../../.venv/bin/python pictures.py "$out" .
../../.venv/bin/python tile_selection.py how/tiles.svg
