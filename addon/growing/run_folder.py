"""Folders of `firetwin watch` as runs: the newest revision is read (see `run.readers.folder`)."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from ..errors import input_error
from ..run import times
from . import watched
from .watched import is_watched as sniff

__all__ = ["changing_file", "newest", "sniff", "warning"]


def changing_file(folder: Path) -> Path:
    """Return the file that changes with the run."""
    return folder / watched.TIMES


def newest(folder: Path) -> Path:
    """Return the newest revision.

    Raises
    ------
    InputError
        There is none yet.
    """
    found = watched.newest(folder)
    if found is None:
        raise input_error(folder, "has no complete time yet; wait for firetwin watch")
    return found


def warning(run: Path, zone: str) -> tuple[str, str]:
    """Warn that the model had not ended: head and text; empty if it had, or the run does not grow."""
    folder = watched.of_revision(run)
    state = watched.status(folder).get("state", "unknown") if folder else "ended"
    if not folder or state == "ended":
        return "", ""
    last = watched.times(folder)[-1]
    model, read = (
        times.text(each, zone, seconds=True) for each in (last.moment, datetime.fromisoformat(last.accepted))
    )
    text = f"when this page was written (state: {state}). Newest time: {model}, read at {read}."
    return "The model had not ended", text
