"""Run times that repeat: tools take turns, so that what disturbs the machine disturbs all of them alike."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import firetwin_core as core

LEAST = 5
"""Repetitions that are measured at least, however long one takes."""
SAMPLE = 2e-3
"""s that a repetition lasts at least: what is quicker is called several times and the mean kept."""


@dataclass(frozen=True)
class Runner:
    """One tool of a race: what to call, on how many threads of the core, and the error it makes.

    `before` gets things ready for each call, while no clock runs.
    """

    tool: str
    call: Callable[[], Any]
    threads: int = 1
    error: float | None = None
    before: Callable[[], Any] | None = None

    @property
    def label(self) -> str:
        """Name in tables: ``firetwin, 2 threads``."""
        return label(self.tool, self.threads)


def label(tool: str, threads: int) -> str:
    """``NumPy``, or ``firetwin, 2 threads``."""
    return tool + (f", {threads} threads" if threads > 1 else "")


@dataclass(frozen=True)
class Times:
    """Seconds of each repetition of one tool, in order."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The one to report: half of the repetitions were quicker."""
        return statistics.median(self.seconds)

    def speed(self, items: float) -> tuple[float, ...]:
        """Items a second of each repetition."""
        return tuple(items / seconds for seconds in self.seconds)

    def faster_than(self, other: Times) -> tuple[float, ...]:
        """How many times as fast this was in each round as `other` was in the same round."""
        return tuple(b / a for a, b in zip(self.seconds, other.seconds, strict=True))


class threads:  # noqa: N801 - reads as a statement
    """``with threads(2):`` limits the worker threads of the core."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __enter__(self) -> None:
        core.set_threads(self.number)

    def __exit__(self, *_: object) -> None:
        core.set_threads(0)


def race(runners: Sequence[Runner], most: int, budget: float) -> list[Times]:
    """Call every runner once unmeasured, then all in turn, LEAST to `most` times, as `budget` (s) allows."""
    often = [_often(runner) for runner in runners]
    found: list[list[float]] = [[] for _ in runners]
    begun = time.perf_counter()
    for done in range(most):
        if done >= LEAST and time.perf_counter() - begun > budget:
            break
        for runner, number, seconds in zip(runners, often, found, strict=True):
            seconds.append(_sample(runner, number))
    return [Times(tuple(seconds)) for seconds in found]


def _often(runner: Runner) -> int:
    """How many calls make a sample; the first call of all meets cold caches and does not count."""
    seconds = _sample(runner, 1)
    if runner.before:
        return 1
    if seconds < 50 * SAMPLE:
        seconds = _sample(runner, 1)
    return max(1, math.ceil(SAMPLE / max(seconds, 1e-9)))


def _sample(runner: Runner, number: int) -> float:
    if runner.before:
        runner.before()
    with threads(runner.threads):
        start = time.perf_counter()
        for _ in range(number):
            runner.call()
        return (time.perf_counter() - start) / number
