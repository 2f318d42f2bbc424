"""Status of Cycles while it renders a picture for long: its samples, or the compilation of kernels."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..leases import heartbeats
from ..progress import MessageCallback, duration

_EVERY = 15.0  # s


class _Status:
    """Last status line of Cycles in this render, and when the render began."""

    def __init__(self) -> None:
        self.text, self.since = "", 0.0

    def note(self, line: object, *_: object) -> None:
        """Take up a line such as ``Fra:1 Mem:30M | Time:00:01.20 | Scene, rgb | Sample 3/6``."""
        text = line.rsplit("|", 1)[-1].strip() if isinstance(line, str) else ""
        if not self.text:
            self.since = time.monotonic()
        self.text = text or self.text

    def clear(self, *_: object) -> None:
        """Forget the status: the render has ended."""
        self.text = ""


@contextmanager
def reported(tell: MessageCallback, every: float = _EVERY) -> Iterator[None]:
    """Report the status of Cycles and the time so far, every `every` seconds of a render that takes longer.

    The handlers are removed at the end: the module `bpy` can hang at exit with handlers left in its lists.
    """
    status, handlers = _Status(), bpy.app.handlers
    lists = (
        (handlers.render_stats, status.note),
        (handlers.render_complete, status.clear),
        (handlers.render_cancel, status.clear),
    )

    def report() -> None:
        text, took = status.text, time.monotonic() - status.since
        if text and took >= every:
            tell(f"Cycles: {text}, {duration(took)} so far")

    for functions, function in lists:
        functions.append(function)
    try:
        with heartbeats(every, report):
            yield
    finally:
        for functions, function in lists:
            functions.remove(function)
