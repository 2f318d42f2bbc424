"""Status of farm jobs, read in a thread every few seconds, never while a panel is drawn."""

from __future__ import annotations

import threading
from pathlib import Path

import bpy

from ...ui import job, working
from .. import status
from ..status import Status

_PERIOD = 10.0  # s between readings
_SHORT = 0.5  # s between checks of the thread

_known: dict[Path, Status | str] = {}
_thread: threading.Thread | None = None
_out: Path | None = None


def last_status(out: Path) -> Status | str | None:
    """Return the last status of the job in a folder, or an error message; None before the first reading."""
    return _known.get(out)


def read_status(out: Path) -> Status:
    """Read the files of a job.

    Raises
    ------
    InputError
        The folder has no job, or its file is damaged.
    """
    found = _known[out] = status.gather(out)
    return found


def start_watch(out: Path) -> None:
    """Read the status of a job periodically, until its tasks are done or another file is opened."""
    global _out
    _out = out
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_PERIOD)


def stop_watch() -> None:
    """Stop reading, and clear all cached states."""
    global _out
    _out = None
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _known.clear()


def is_unfinished(found: Status | str | None) -> bool:
    """Return whether tasks are running or waiting."""
    return isinstance(found, Status) and bool(found.running or found.waiting)


def _tick() -> float | None:
    global _thread
    if _thread is None:
        if _out is None:
            return None
        _thread = threading.Thread(target=_read_in_thread, args=(_out,), name="Firetwin farm", daemon=True)
        _thread.start()
        return _SHORT
    if _thread.is_alive():
        return _SHORT
    _thread = None
    working.redraw()
    return _PERIOD if _out is not None and is_unfinished(last_status(_out)) else None


def _read_in_thread(out: Path) -> None:
    try:
        read_status(out)
    except Exception as error:
        _known[out] = job.describe_error(error)
