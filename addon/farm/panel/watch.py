"""Status of farm jobs, read in a thread every few seconds, never while a panel is drawn."""

from __future__ import annotations

from pathlib import Path

from ...ui import job
from ...ui.folder_watch import FolderWatch
from .. import status
from ..status import Status

_PERIOD = 10.0  # s between readings

_known: dict[Path, Status | str] = {}


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


def stop_watch() -> None:
    """Stop reading, and clear all cached states."""
    status_watch.stop()
    _known.clear()


def is_unfinished(found: Status | str | None) -> bool:
    """Return whether tasks are running or waiting."""
    return isinstance(found, Status) and bool(found.running or found.waiting)


def _try_to_read(out: Path) -> None:
    try:
        read_status(out)
    except Exception as error:
        _known[out] = job.describe_error(error)


status_watch = FolderWatch(_try_to_read, lambda out: not is_unfinished(last_status(out)), _PERIOD)
"""Watch of the job of the open file."""
