#!/usr/bin/env bash
# Sets up, and writes the sample run to out/sample if it does not exist.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

./setup.sh
mkdir -p out
# The run gets its name when it is complete, so an existing run is complete.
if [[ ! -d out/sample ]]; then
  rm -rf out/sample.part
  ../.venv/bin/firetwin sample out/sample.part
  mv out/sample.part out/sample
fi
