"""Cost of a frame by part: seconds by the clock, which a render reports. Needs no Blender."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from ..progress import count

FRAME = "frame"
SMOKE, SURFACES, MARCH = "smoke", "surfaces in Cycles", "ray march"


class FrameCost:
    """Seconds of the frames of a render, and of their parts."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.frames = 0

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the duration of the block to a part, or to whole frames (`FRAME`)."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - began
            self.frames += name == FRAME

    def sentence(self) -> str:
        """Return the mean seconds of a frame and of its parts, in words; empty without frames."""
        if not self.frames:
            return ""
        mean = {name: total / self.frames for name, total in self.seconds.items()}
        whole = mean.pop(FRAME)
        mean["the rest"] = max(whole - sum(mean.values()), 0.0)
        parts = ", ".join(f"{name} {_seconds(value)}" for name, value in mean.items())
        head = "the first frame took" if self.frames == 1 else f"mean of {count(self.frames, 'frame')}:"
        return f"{head} {_seconds(whole)} s ({parts})"


def _seconds(value: float) -> str:
    return f"{value:.1f}" if value < 10.0 else f"{value:.0f}"
