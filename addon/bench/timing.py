"""Reproducible run times: tools run in turns, so that disturbances of the machine affect all equally."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import firetwin_core as core

LEAST = 5
"""Minimum number of repetitions, however long one takes."""
MOST, SECONDS = 9, 0.5
"""Maximum number of repetitions, and total time in s of all tools after which only the minimum is run."""
SAMPLE = 2e-3
"""s, minimum duration of a repetition: a faster call is repeated and its mean is recorded."""


@dataclass(frozen=True)
class Runner:
    """One tool of a race: the function to call, its number of threads, and its error."""

    tool: str
    call: Callable[[], Any]
    threads: int = 1
    error: float | None = None

    @property
    def label(self) -> str:
        """Name in tables: ``firetwin, 2 threads``."""
        return label(self.tool, self.threads)


def label(tool: str, threads: int) -> str:
    """Return the name in tables: ``NumPy``, or ``firetwin, 2 threads``."""
    return tool + (f", {threads} threads" if threads > 1 else "")


@dataclass(frozen=True)
class Times:
    """Wall-clock seconds of each repetition of one tool, in order."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """Median of the repetitions, for reports."""
        return statistics.median(self.seconds)

    def speed(self, items: float) -> tuple[float, ...]:
        """Return the items per second in each repetition."""
        return tuple(items / seconds for seconds in self.seconds)

    def faster_than(self, other: Times) -> tuple[float, ...]:
        """Return the speed-up over `other` in each round."""
        return tuple(b / a for a, b in zip(self.seconds, other.seconds, strict=True))


@dataclass(frozen=True)
class Spent:
    """Wall-clock seconds, and CPU seconds of this process."""

    seconds: float
    processor: float


class Stopwatch:
    """Stopwatch that starts when it is created."""

    def __init__(self) -> None:
        self._seconds, self._processor = time.perf_counter(), time.process_time()

    def read(self) -> Spent:
        """Return the time since the start."""
        return Spent(time.perf_counter() - self._seconds, time.process_time() - self._processor)


class threads:  # noqa: N801 - reads as a statement
    """Context manager that limits the worker threads of the core: ``with threads(2):``."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __enter__(self) -> None:
        core.set_threads(self.number)

    def __exit__(self, *_: object) -> None:
        core.set_threads(0)


def race(runners: Sequence[Runner], most: int, budget: float) -> list[Times]:
    """Call every runner once to warm up, then all in turns, LEAST to `most` times, as `budget` (s) allows."""
    often = [_often(runner) for runner in runners]
    measured: list[list[float]] = [[] for _ in runners]
    begun = time.perf_counter()
    for done in range(most):
        if done >= LEAST and time.perf_counter() - begun > budget:
            break
        for runner, number, spent in zip(runners, often, measured, strict=True):
            spent.append(_sample(runner, number))
    return [Times(tuple(spent)) for spent in measured]


def _often(runner: Runner) -> int:
    """Choose the number of calls in a sample; the first call has cold caches and does not count."""
    seconds = _sample(runner, 1)
    if seconds < 50 * SAMPLE:
        seconds = _sample(runner, 1)
    return max(1, math.ceil(SAMPLE / max(seconds, 1e-9)))


def _sample(runner: Runner, number: int) -> float:
    with threads(runner.threads):
        watch = Stopwatch()
        for _ in range(number):
            runner.call()
        return watch.read().seconds / number
