"""Signs that reading goes on, for whoever waits: a damaged file can keep a library busy for ever."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_OFTEN = 1.0  # s between two signs

_to: list[Callable[[], None]] = []
_last = 0.0


@contextmanager
def to(say: Callable[[], None]) -> Iterator[None]:
    """Within, signs call this function."""
    _to.append(say)
    try:
        yield
    finally:
        _to.remove(say)


def sign() -> None:
    """A part of a file has been read, or is about to be."""
    global _last
    now = time.monotonic()
    if _to and now - _last >= _OFTEN:
        _last = now
        for say in _to:
            say()
