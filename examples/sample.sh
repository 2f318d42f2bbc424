#!/usr/bin/env bash
# Sets up and writes the sample run into out/sample, unless it is there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

./setup.sh
mkdir -p out
# The run takes its name when it is complete, so a run that is there is whole.
if [[ ! -d out/sample ]]; then
  rm -rf out/sample.part
  ../.venv/bin/firetwin sample out/sample.part
  mv out/sample.part out/sample
fi
