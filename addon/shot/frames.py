"""Frame times: frames of a shot and the model times that they show."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..run import times

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from .sections import Time


# Times real time, above which smoke has a long exposure by default, and that exposure in frame intervals.
TIME_LAPSE = 30.0, 2.0


@dataclass(frozen=True)
class Frames:
    """Frames 1 to `count` at even steps from model time `first` to `last` (s since the run began)."""

    first: float
    last: float
    count: int

    @property
    def step(self) -> float:
        """Model seconds per frame."""
        return (self.last - self.first) / max(self.count - 1, 1)

    @property
    def span(self) -> tuple[float, float]:
        """Model times of the first and the last frame, s."""
        return self.first, self.last

    @property
    def middle(self) -> float:
        """Model time at the middle of the shot, s."""
        return 0.5 * (self.first + self.last)

    @property
    def times(self) -> NDArray[np.float64]:
        """Model times (count,) of all frames, s."""
        return self.first + np.arange(self.count) * self.step

    def time(self, frame: float) -> float:
        """Model time of a frame, s: first + (frame - 1) (last - first) / (count - 1)."""
        return self.first + (frame - 1.0) * self.step


def resolve(time: Time, run: Run) -> Frames:
    """Frame times from the scene file's [time] in a run; a still has one time, its start."""
    time = time.resolved()
    first = float(run.times[0]) if time.start is None else times.seconds(run, time.start)
    if time.frames == 1:
        return Frames(first, first, 1)
    last = float(run.times[-1]) if time.end is None else times.seconds(run, time.end)
    return Frames(first, last, time.frames)


def parts(listed: list[int], chunk: int) -> dict[int, list[int]]:
    """Chunks: frames that are built together, by chunk number. A `chunk` of 0 builds all frames at once."""
    return {k: list(part) for k, part in itertools.groupby(listed, lambda frame: part_of(frame, chunk))}


def part_of(frame: int, chunk: int) -> int:
    """Chunk number of a frame."""
    return (frame - 1) // chunk if chunk else 0
