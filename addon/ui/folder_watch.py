"""Watch of a folder: reads it in a thread every few seconds, never while a panel is drawn."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import bpy

from . import working

SHORT = 0.5  # s between checks of the thread


class FolderWatch:
    """Reads a folder by `read` until `is_final`, and redraws the panels after each reading.

    Attributes
    ----------
    folder
        The watched folder; None: none.
    """

    def __init__(
        self,
        read: Callable[[Path], object],
        is_final: Callable[[Path], bool],
        period: float,
        persistent: bool = False,
    ) -> None:
        """Make a watch that reads every `period` s; a persistent one goes on when another file is opened."""
        self.folder: Path | None = None
        self.thread: threading.Thread | None = None
        self._read, self._is_final, self._period, self._persistent = read, is_final, period, persistent
        self._timer = self.tick  # one object: Blender knows timers by their address

    def start(self, folder: Path) -> None:
        """Watch a folder instead of the last one."""
        self.folder = folder
        if not bpy.app.background and not bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.register(self._timer, first_interval=self._period, persistent=self._persistent)

    def stop(self) -> None:
        """Watch nothing."""
        self.folder = None
        if bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.unregister(self._timer)

    def tick(self) -> float | None:
        """Start or check the thread; return the seconds until the next call, or None at the end."""
        if self.thread is None:
            if self.folder is None:
                return None
            self.thread = threading.Thread(target=self._read, args=(self.folder,), daemon=True)
            self.thread.start()
            return SHORT
        if self.thread.is_alive():
            return SHORT
        self.thread = None
        working.redraw()
        return self._period if self.folder is not None and not self._is_final(self.folder) else None
