"""Scheduling of updates of the station list and map: shortly after a change, never while a panel draws."""

from __future__ import annotations

from collections.abc import Callable

import bpy

_SOON = 0.2  # delay after a change, s; changes within it are handled together

_work: Callable[[], bool] | None = None


def start(work: Callable[[], bool]) -> None:
    """Call `work` shortly after each change, and again as long as it returns True."""
    global _work
    _work = work
    for handlers in _watched():
        handlers.append(wake)


def stop() -> None:
    """Stop the calls."""
    global _work
    _work = None
    for handlers in _watched():
        if wake in handlers:
            handlers.remove(wake)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)


@bpy.app.handlers.persistent
def wake(*_: object) -> None:
    """Schedule a call after a change of a filter, the selection, the frame or the file."""
    if _work is None or bpy.app.background or bpy.app.is_job_running("RENDER"):
        return
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_SOON)


def _watched() -> tuple[list[Callable], ...]:
    handlers = bpy.app.handlers
    return handlers.frame_change_post, handlers.undo_post, handlers.redo_post, handlers.load_post


def _tick() -> float | None:
    return _SOON if _work is not None and _work() else None
