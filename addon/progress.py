"""Progress on stderr: a bar on a terminal, plain lines with the time left everywhere else."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

Progress = Callable[[int, int], None]
"""Called with (done, total) as work goes on."""


def say(text: str) -> None:
    """Tell the person at the keyboard; stdout is kept for results."""
    print(f"firetwin: {text}", file=sys.stderr, flush=True)


def silent(done: int, total: int) -> None:
    """Report nothing."""


def reporter(what: str, unit: str = "frame") -> Progress:
    """A callback that shows how far `what` is."""
    return _Bar(what, unit) if sys.stderr.isatty() else _Lines(what, unit)


class _Bar:
    def __init__(self, what: str, unit: str) -> None:
        self.what, self.unit = what, unit
        self.bar = None

    def __call__(self, done: int, total: int) -> None:
        if self.bar is None:
            from tqdm import tqdm

            self.bar = tqdm(total=total, desc=self.what, unit=self.unit, dynamic_ncols=True, leave=True)
        self.bar.update(done - self.bar.n)
        if done >= total:
            self.bar.close()


class _Lines:
    """One line at the start, at most one every two seconds, and one at the end."""

    def __init__(self, what: str, unit: str) -> None:
        self.what, self.unit = what, unit
        self.started: float | None = None
        self.first = 0
        self.last = -10.0

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if self.started is None:
            self.started, self.first = now, done
        if done < total and now - self.last < 2.0:
            return
        self.last = now
        plural = "" if total == 1 else "s"
        line = f"{self.what}: {done} of {total} {self.unit}{plural}"
        if done >= total:
            line += f", took {duration(now - self.started)}"
        elif done > self.first:
            line += f", {duration((now - self.started) / (done - self.first) * (total - done))} left"
        say(line)


def duration(seconds: float) -> str:
    """Time in words: ``8 s``, ``2 min 5 s``, ``1 h 20 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
