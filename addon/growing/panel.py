"""Growing run in the window: state and new times, read in a thread every few seconds, never while drawing."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import bpy

from ..progress import count
from ..ui.folder_watch import FolderWatch
from ..ui.text import draw_paragraph
from . import watched

_PERIOD = 5.0  # s between readings


@dataclass(frozen=True)
class Growth:
    """State of a watched folder.

    Attributes
    ----------
    state
        As in ``status.json``.
    revision
        Generation of the run, and its number of times.
    newest
        Newest model time; "" before the first.
    """

    state: str
    revision: tuple[int, int]
    newest: str


_read: dict[Path, Growth] = {}
"""State of each folder when its run was read."""


def start(folder: Path, read: Growth) -> None:
    """Note the state of a run that was read, and look for new times until the model has ended.

    Parameters
    ----------
    read
        State from before the run was read (`look`), as times come meanwhile.
    """
    if not watched.is_watched(folder):
        _watch.stop()
        return
    _read[folder] = read
    _watch.start(folder, read)


def unregister() -> None:
    """Stop looking, and forget all states."""
    _watch.clear()
    _read.clear()


def draw_run(context: bpy.types.Context, layout: bpy.types.UILayout, folder: Path) -> None:
    """Draw the state of a growing run, and a button to read its new times."""
    growth, read = _watch.states.get(folder), _read.get(folder)
    if growth is None:
        return
    text = f"The model is {growth.state}; newest time {growth.newest}" if growth.newest else "No time yet"
    draw_paragraph(context, layout.column(align=True), text, "TIME")
    if read is not None and growth.revision != read.revision:
        before = read.revision[1] if read.revision[0] == growth.revision[0] else 0  # 0: a restarted model
        label = f"Read {count(growth.revision[1] - before, 'new time')}"
        layout.operator("firetwin.inspect", text=label, icon="FILE_REFRESH")


def look(folder: Path) -> Growth:
    """Read the state of a watched folder."""
    accepted = watched.times(folder)
    state = str(watched.status(folder).get("state", "unknown"))
    if not accepted:
        return Growth(state, (0, 0), "")
    last = accepted[-1]
    return Growth(state, (last.generation, last.revision), f"{last.moment:%Y-%m-%d %H:%M} UTC")


def _look_again(folder: Path) -> Growth:
    try:
        return look(folder)
    except Exception:  # such as a folder that was removed
        return _watch.states[folder]


_watch = FolderWatch(_look_again, lambda growth: growth.state in watched.FINAL, _PERIOD, persistent=True)
