"""Watch of a folder: reads it in a thread every few seconds, never while a panel is drawn."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

import bpy

from . import working

SHORT = 0.5  # s between checks of the thread
State = TypeVar("State")


class FolderWatch(Generic[State]):
    """Reads the state of a folder until it is final, and redraws the panels after each reading.

    Attributes
    ----------
    folder
        The watched folder; None: none.
    states
        Last state of each folder of this session.
    """

    def __init__(
        self,
        read: Callable[[Path], State],
        is_final: Callable[[State], bool],
        period: float,
        persistent: bool = False,
    ) -> None:
        """Make a watch that reads every `period` s; a persistent one goes on when another file is opened."""
        self.folder: Path | None = None
        self.states: dict[Path, State] = {}
        self.thread: threading.Thread | None = None
        self._read, self._is_final, self._period, self._persistent = read, is_final, period, persistent
        self._timer = self.tick  # one object: Blender knows timers by their address

    def start(self, folder: Path, state: State) -> None:
        """Watch a folder, of which this state was read, instead of the last one."""
        self.folder, self.states[folder] = folder, state
        if self._is_final(state):
            self.stop()
            return
        if not bpy.app.background and not bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.register(self._timer, first_interval=self._period, persistent=self._persistent)

    def stop(self) -> None:
        """Watch nothing."""
        self.folder = None
        if bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.unregister(self._timer)

    def clear(self) -> None:
        """Watch nothing, and forget all states."""
        self.stop()
        self.states.clear()

    def tick(self) -> float | None:
        """Start or check the thread; return the seconds until the next call, or None at the end."""
        if self.thread is None:
            if self.folder is None:
                return None
            self.thread = threading.Thread(target=self._look, args=(self.folder,), daemon=True)
            self.thread.start()
            return SHORT
        if self.thread.is_alive():
            return SHORT
        self.thread = None
        working.redraw()
        final = self.folder is None or self._is_final(self.states[self.folder])
        return None if final else self._period

    def _look(self, folder: Path) -> None:
        self.states[folder] = self._read(folder)
