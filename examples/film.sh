#!/usr/bin/env bash
# Sets up, writes the sample run and renders example scenes with their films into out/NAME, as in
# `film.sh satellite vr`; a second run renders only missing and outdated files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

[[ $# -gt 0 ]] || { echo "film.sh: name scene files of this folder, such as drone_feed" >&2 && exit 2; }
for name in "$@"; do
  [[ -f $name.toml ]] || { echo "film.sh: there is no $name.toml here" >&2 && exit 2; }
done
./sample.sh
for name in "$@"; do
  ../.venv/bin/firetwin render "$name.toml" --out "out/$name" --resume
done
