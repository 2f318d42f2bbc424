"""Shell functions that the scripts of several schedulers share."""

from __future__ import annotations

RUN = """\
child=
ended=
forward() {{
  ended=1
  [ -z "$child" ] || kill -TERM "$child" 2>/dev/null
}}
trap forward TERM
run() {{ # runs a command and forwards SIGTERM to it; returns its exit status
  local status
  "$@" &
  child=$!
  wait "$child"
  status=$?
  while kill -0 "$child" 2>/dev/null; do # a signal interrupts wait, not the child
    wait "$child"
    status=$?
  done
  child=
  return "$status"
}}
"""
"""Template for `str.format`, which only unescapes the braces."""
