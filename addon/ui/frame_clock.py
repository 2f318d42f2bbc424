"""Time between the frames of a view that is drawn again and again."""

from __future__ import annotations

import statistics
import time
from collections import deque

HEADSET = 72.0  # frames/s that standalone headsets ask for
_LEAST, _MOST = 10, 60  # intervals


class FrameClock:
    """Begin of the last frames of one view."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=_MOST + 1)

    def note(self) -> None:
        """Note that a frame begins."""
        self._times.append(time.monotonic())

    def clear(self) -> None:
        """Forget all frames."""
        self._times.clear()

    def median(self) -> float | None:
        """Return the median time between frames, s; None before the tenth interval."""
        steps = [after - before for before, after in zip(self._times, list(self._times)[1:], strict=False)]
        return statistics.median(steps) if len(steps) >= _LEAST else None


def is_slow(seconds: float) -> bool:
    """Return whether a frame takes longer than a headset allows."""
    return seconds > 1.05 / HEADSET


def describe(seconds: float, what: str = "") -> str:
    """Return the time of a frame in ms, next to the time that a headset allows."""
    return f"{1000.0 * seconds:.1f} ms{what}; {HEADSET:.0f} Hz needs {1000.0 / HEADSET:.1f}"
