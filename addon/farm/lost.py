"""Attempts that ended without a last line: killed tasks, shown before the patience for heartbeats ends.

A live attempt has a heartbeat every 30 s. After 45 s without one, this module asks the machine or the
scheduler whether the attempt still runs. Without an answer the patience of `status` applies.
"""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
from collections.abc import Callable

from . import entries
from .entries import Attempt

STALE = 1.5 * entries.HEARTBEAT  # s without a heartbeat
_WAIT = 10.0  # s, longest wait for a scheduler

_RUNNING = {
    "slurm": ["squeue", "-h", "-t", "RUNNING,SUSPENDED,COMPLETING", "-o", "%A"],
    "htcondor": [
        "condor_q",
        "-allusers",
        "-nobatch",
        "-constraint",
        "JobStatus == 2",
        "-af",
        "ClusterId",
        "ProcId",
    ],
}
"""Commands that list running jobs: a number, or two, in each line."""


class Lost:
    """Reasons for which attempts are lost; it asks each scheduler once at most."""

    def __init__(self, now: float, listed: Callable[[str], set[str] | None] | None = None) -> None:
        self._now, self._ask = now, listed or list_running
        self._known: dict[str, set[str] | None] = {}

    def reason(self, attempt: Attempt) -> str:
        """Return why an attempt has ended; empty if it runs, or if nothing knows."""
        if attempt.ended is not None or self._now - attempt.last < STALE:
            return ""
        scheduler, _, job = attempt.scheduled.partition(" ")
        if scheduler in _RUNNING:
            if scheduler not in self._known:
                self._known[scheduler] = self._ask(scheduler)
            running = self._known[scheduler]
            return "" if running is None or job in running else f"{scheduler} no longer runs job {job}"
        if attempt.process and attempt.host == socket.gethostname() and not _exists(attempt.process):
            return f"its process {attempt.process} on {attempt.host} was killed"
        return ""


def list_running(scheduler: str) -> set[str] | None:
    """List the running jobs of a scheduler; None if it does not answer."""
    try:
        found = subprocess.run(_RUNNING[scheduler], capture_output=True, text=True, timeout=_WAIT)
    except (OSError, subprocess.SubprocessError):
        return None
    return None if found.returncode else {".".join(line.split()) for line in found.stdout.splitlines()}


def _exists(process: int) -> bool:
    """Return whether a process exists; True on Windows, where a signal would end it."""
    if os.name == "nt":
        return True
    with contextlib.suppress(PermissionError):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return False
    return True
