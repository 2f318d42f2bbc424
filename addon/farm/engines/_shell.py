"""Text of shell scripts that engines share."""

from __future__ import annotations

RUN = """\
child=
ended=
forward() {{
  ended=1
  [ -z "$child" ] || kill -TERM "$child" 2>/dev/null
}}
trap forward TERM
run() {{ # runs a command, which gets SIGTERM as well; its exit status
  local status
  "$@" &
  child=$!
  wait "$child"
  status=$?
  while kill -0 "$child" 2>/dev/null; do # a signal ends wait, not the child
    wait "$child"
    status=$?
  done
  child=
  return "$status"
}}
"""
"""To be filled by `str.format`: nothing but its braces."""
