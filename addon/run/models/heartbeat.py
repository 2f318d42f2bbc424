"""Heartbeat of a reader process: a damaged file can keep a library busy without end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_OFTEN = 1.0  # s between heartbeats

_to: list[Callable[[], None]] = []
_last = 0.0


@contextmanager
def to(say: Callable[[], None]) -> Iterator[None]:
    """Call this function for heartbeats within the context."""
    _to.append(say)
    try:
        yield
    finally:
        _to.remove(say)


def sign() -> None:
    """Send a heartbeat: a part of a file was read, or is next."""
    global _last
    now = time.monotonic()
    if _to and now - _last >= _OFTEN:
        _last = now
        for say in _to:
            say()
