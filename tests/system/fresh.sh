#!/usr/bin/env bash
# Runs the two commands of the README in fresh Debian folders, as a new user does.
#
#   tests/system/fresh.sh                       in Debian 12 and 13: an hour or more
#   tests/system/fresh.sh trixie                in this release only
#   tests/system/fresh.sh trixie tests/run.sh   this command only
#
# A folder is removed if all commands passed. Exit status 77: such folders cannot be made here.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

suites=(bookworm trixie)
if (($#)); then
  suites=("$1")
  shift
fi
commands=(tests/run.sh examples/king_fire.sh)
if (($#)); then
  commands=("$@")
fi

for suite in "${suites[@]}"; do
  folder=build/fresh/$suite
  rm -rf --one-file-system "$folder"
  for command in "${commands[@]}"; do
    echo "fresh: $suite: $command" >&2
    tests/system/in_debian.sh "$suite" "$folder" "$command"
  done
  if [[ " ${commands[*]} " == *" examples/king_fire.sh "* ]]; then
    ls -l "$folder"/firetwin/examples/out/film/drone/*.mp4
  fi
  rm -rf --one-file-system "$folder"
  echo "fresh: $suite: all commands passed" >&2
done
