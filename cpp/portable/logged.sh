#!/usr/bin/env bash
# To be sourced.

# Runs a function in a subshell that stops at the first error, and writes its output to a log; on failure, prints the end of
# the log and exits. Not for conditions: after `if` or before `||` bash does not stop at errors.
logged() { # what log function argument...
  local what=$1 log=$2 status
  mkdir -p "$(dirname "$log")"
  set +e
  (
    set -e
    "${@:3}"
  ) >"$log" 2>&1
  status=$?
  set -e
  if ((status)); then
    tail -n 40 "$log" | cut -c 1-400 >&2
    echo "$what was not built; the complete output is in $log" >&2
    exit 1
  fi
}
