#!/usr/bin/env bash
# Renders a still of each camera of views/ into out/views: afternoon and night, from 5 m to 40 km.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

./sample.sh
for scene in views/*.toml; do
  name=$(basename "$scene" .toml)
  ../.venv/bin/firetwin render "$scene" --out "out/views/$name" --frames 1 --resume
done
