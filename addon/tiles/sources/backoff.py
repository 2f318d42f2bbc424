"""Exponential back-off: pauses all requests to a source after a failure, or as the server demands."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from email.utils import parsedate_to_datetime

MAX_RETRIES = 5  # per request
MAX_RETRY_AFTER = 600.0  # s; a longer Retry-After is an error
_FIRST_DELAY = 0.5  # s
_MAX_DELAY = 60.0  # s, without Retry-After


@dataclass
class Clock:
    """Time and random numbers; tests substitute others.

    Attributes
    ----------
    now
        Seconds since 1970.
    sleep
        Waits some seconds.
    jitter
        Random number in 0..1.
    """

    now: Callable[[], float] = time.time
    sleep: Callable[[float], None] = time.sleep
    jitter: Callable[[], float] = field(default_factory=lambda: random.Random().random)


class Backoff:
    """Pause of a source, shared by its threads: no request starts before it ends."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self._until = 0.0
        self._lock = threading.Lock()

    def wait(self) -> None:
        """Wait until requests may start."""
        while True:
            with self._lock:
                left = self._until - self.clock.now()
            if left <= 0.0:
                return
            self.clock.sleep(left)

    def extend(self, seconds: float) -> None:
        """Extend the pause to at least this many seconds from now."""
        with self._lock:
            self._until = max(self._until, self.clock.now() + seconds)


def retry_delay(retry_after: str | None, attempt: int, clock: Clock) -> float:
    """Compute the seconds to wait before retry `attempt` (from 0).

    Parameters
    ----------
    retry_after
        Header Retry-After: seconds or a date. Without it: exponential from 0.5 s to 60 s, with 50 % jitter.
    """
    if retry_after is not None:
        text = retry_after.strip()
        if text.isdecimal():
            return float(text)
        try:
            return max(parsedate_to_datetime(text).timestamp() - clock.now(), 0.0)
        except (ValueError, TypeError):
            pass
    longest = min(_FIRST_DELAY * 2.0**attempt, _MAX_DELAY)
    return longest * (0.5 + 0.5 * clock.jitter())
