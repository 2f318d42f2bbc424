"""Cost of a frame by part: processor seconds, and seconds by the clock. Needs no Blender."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager

from ..progress import count

FRAME, SMOKE, SHADOW, SURFACES = "frame", "smoke", "shadow of smoke", "surfaces in Cycles"
CENTRES, FLAMES, DISTANCE, MARCH = "classes in Cycles", "flames", "distance of flames", "ray march"
COMPOSITOR, FILES = "compositor", "files"
_LEAST = 0.05  # s; cheaper parts count to the rest


class FrameCost:
    """Cost of the frames of a render, and of their parts.

    Attributes
    ----------
    seconds
        Processor seconds of all threads by part. Smoke that is painted ahead counts to the part that
        runs meanwhile.
    clock
        Seconds by the clock, of whole frames.

    The first frame, for which Cycles and tables start, counts only if there is no other.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.clock, self.frames = 0.0, 0

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the duration of the block to a part, or to whole frames (`FRAME`)."""
        if name == FRAME and self.frames == 1:
            self.seconds.clear()
            self.clock = 0.0
        began, clock = time.process_time(), time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.process_time() - began
            if name == FRAME:
                self.clock, self.frames = self.clock + time.perf_counter() - clock, self.frames + 1

    def mean(self) -> dict[str, float]:
        """Return the mean processor seconds of a frame, by part; empty without frames."""
        if not self.frames:
            return {}
        mean = {name: total / self._counted for name, total in self.seconds.items()}
        whole = mean.pop(FRAME)
        mean = {name: seconds for name, seconds in mean.items() if seconds >= _LEAST}
        return mean | {"the rest": max(whole - sum(mean.values()), 0.0)}

    def sentence(self) -> str:
        """Return the mean cost of a frame and of its parts, and the busy share of cores, in words."""
        mean = self.mean()
        if not mean:
            return ""
        parts = ", ".join(f"{name} {_seconds(value)}" for name, value in mean.items())
        whole = sum(mean.values())
        further = f"mean of {count(self._counted, 'further frame')}:"
        head = "the first frame took" if self.frames == 1 else further
        clock = self.clock / self._counted
        cores = os.cpu_count() or 1
        busy = f"{whole / max(clock * cores, 1.0e-9):.0%} of {count(cores, 'core')}"
        return f"{head} {_seconds(clock)} s, of processor time {_seconds(whole)} s, {busy} ({parts})"

    @property
    def _counted(self) -> int:
        """Number of frames in the mean."""
        return max(self.frames - 1, 1)


def _seconds(value: float) -> str:
    return f"{value:.1f}" if value < 10.0 else f"{value:.0f}"
