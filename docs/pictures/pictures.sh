#!/usr/bin/env bash
# Makes the film and the small pictures of README.md from renders of the synthetic sample run, and how/tiles.svg.
# The film took 26 minutes on two cores that other work shared; a second run renders only missing files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

../../examples/sample.sh
firetwin=../../.venv/bin/firetwin
out=../../examples/out

"$firetwin" render ../../examples/king_fire.toml --out "$out/film" --frames 2-48:2 --resume
"$firetwin" render forest.toml --out "$out/forest" --resume
[[ -f $out/maps/intensity.png ]] || "$firetwin" maps "$out/sample" --out "$out/maps"
../../.venv/bin/python pictures.py "$out" .
../../.venv/bin/python tile_selection.py how/tiles.svg
