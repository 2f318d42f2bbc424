"""Progress on stderr: a bar on a terminal, otherwise plain lines with the remaining time."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from .escaped import escaped, message

if TYPE_CHECKING:
    from tqdm import tqdm

Progress = Callable[..., None]
"""Called as ``progress(done, total, "name of the work", "a note")``; the texts are optional."""

READING = "reading the scene file and its run"

MessageCallback = Callable[[str], None]
"""Called with a sentence for the user."""


def say(text: str) -> None:
    """Print a message on stderr; stdout is reserved for results."""
    print(f"firetwin: {message(text)}", file=sys.stderr, flush=True)


def result(text: object) -> None:
    """Print results on stdout; file names are escaped only on a terminal."""
    lines = str(text).split("\n")
    print("\n".join(map(escaped, lines)) if sys.stdout.isatty() else "\n".join(lines))


@contextlib.contextmanager
def notify_if_slow(text: str, seconds: float = 1.0) -> Iterator[None]:
    """Print `text` if the block takes longer than `seconds`."""
    timer = threading.Timer(seconds, say, [text])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def silent(done: int, total: int, what: str = "", note: str = "") -> None:
    """Ignore progress."""


def share(progress: Progress, before: int, of: int, work: str) -> Progress:
    """Create a callback for a part of `work`: `before` of `of` steps are done; other work is passed on."""

    def counted(here: int, total: int, what: str = "", note: str = "") -> None:
        progress(*((before + here, of) if what == work else (here, total)), what, note)

    return counted


class Reporter:
    """Progress display; each new name of the work starts a new bar."""

    def __init__(self, what: str = "working") -> None:
        self.what = what
        self.shown: _Bar | _Lines | None = None

    def __call__(self, done: int, total: int, what: str = "", note: str = "") -> None:
        what, note = escaped(what or self.what), escaped(note)
        if self.shown is None or self.shown.what != what:
            self.close()
            self.shown = _Bar(what) if sys.stderr.isatty() else _Lines(what)
        self.shown.update(done, total, note)

    def close(self) -> None:
        """End the last bar at its present state."""
        if isinstance(self.shown, _Bar):
            self.shown.close()
        self.shown = None


class _Bar:
    def __init__(self, what: str) -> None:
        self.what = what
        self.bar: tqdm | None = None

    def update(self, done: int, total: int, note: str = "") -> None:
        if self.bar is None:
            from tqdm import tqdm

            count = "{n_fmt}/{total_fmt} [{elapsed}, {remaining} left{postfix}]"
            shape = "{desc}: {percentage:3.0f}%|{bar}| " + count
            self.bar = tqdm(total=total, desc=self.what, initial=done, bar_format=shape, dynamic_ncols=True)
        self.bar.set_postfix_str(note, refresh=False)  # tqdm prefixes a comma
        self.bar.update(done - self.bar.n)
        if done >= total:
            self.bar.close()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


class _Lines:
    """One line at the start, at most one every two seconds, and one at the end."""

    def __init__(self, what: str) -> None:
        self.what = what
        self.started: float | None = None
        self.first = 0
        self.last = -10.0

    def update(self, done: int, total: int, note: str = "") -> None:
        now = time.monotonic()
        if self.started is None:
            self.started, self.first = now, done
        if done < total and now - self.last < 2.0:
            return
        self.last = now
        line = self.what if total == 1 else f"{self.what}: {done} of {total}"
        if done >= total:
            line += f", took {duration(now - self.started)}"
        elif done > self.first:
            line += f", {duration((now - self.started) / (done - self.first) * (total - done))} left"
        say(f"{line}, {note}" if note else line)


def no_message(text: str) -> None:
    """Ignore a message."""


def count(number: int, noun: str) -> str:
    """Format a count: ``1 picture``, ``1,200 pictures``."""
    return f"{number:,} {noun}" + ("" if number == 1 else "s")


def size(count: float) -> str:
    """Format bytes: ``120 MB``, ``1.2 GB``."""
    return f"{count / 1e9:.1f} GB" if count >= 0.9995e9 else f"{count / 1e6:.0f} MB"


def duration(seconds: float) -> str:
    """Format a duration: ``8 s``, ``2 min 5 s``, ``1 h 20 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    if whole < 48 * 3600:
        return f"{whole // 3600} h {whole % 3600 // 60} min"
    return f"{whole // 86400} days"
