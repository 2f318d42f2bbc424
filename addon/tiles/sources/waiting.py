"""Pauses of a whole source: after a server asked for one, or failed."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from email.utils import parsedate_to_datetime

TRIES = 5  # repetitions of one request
LONGEST = 600.0  # s that a server may ask for
_FIRST = 0.5  # s
_MOST = 60.0  # s, of our own accord


@dataclass
class Clock:
    """Time and chance; tests have their own.

    Attributes
    ----------
    now
        Seconds since 1970.
    sleep
        Waits some seconds.
    chance
        A number in 0..1.
    """

    now: Callable[[], float] = time.time
    sleep: Callable[[float], None] = time.sleep
    chance: Callable[[], float] = field(default_factory=lambda: random.Random().random)


class Pause:
    """No request of a source starts before the pause is over, of whatever thread."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self._until = 0.0
        self._lock = threading.Lock()

    def wait(self) -> None:
        """Wait until the source may be asked."""
        while True:
            with self._lock:
                left = self._until - self.clock.now()
            if left <= 0.0:
                return
            self.clock.sleep(left)

    def ask_for(self, seconds: float) -> None:
        """Let nobody ask for some seconds."""
        with self._lock:
            self._until = max(self._until, self.clock.now() + seconds)


def seconds(asked: str | None, number: int, clock: Clock) -> float:
    """Seconds to wait before repetition `number` (from 0).

    Parameters
    ----------
    asked
        Header Retry-After: seconds or a date. Without it the time doubles each time, half of it by chance.
    """
    if asked is not None:
        text = asked.strip()
        if text.isdecimal():
            return float(text)
        try:
            return max(parsedate_to_datetime(text).timestamp() - clock.now(), 0.0)
        except (ValueError, TypeError):
            pass
    most = min(_FIRST * 2.0**number, _MOST)
    return most * (0.5 + 0.5 * clock.chance())
