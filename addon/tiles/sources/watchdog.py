"""Watchdog of downloads: it ends connections that send too slowly.

A socket's own timeout restarts with each byte, so a server that sends a byte a second would never be left.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

from ... import limits


@dataclass(frozen=True)
class Pace:
    """Time limits of downloads, s.

    Attributes
    ----------
    piece
        For the head of a response, and for each 64 kB of its body.
    file
        For a file, from the request to its last byte.
    host, job
        For all requests to the server of a tileset, and for all requests of a job; concurrent ones are added.
    """

    piece: float = limits.DOWNLOAD_PIECE
    file: float = limits.DOWNLOAD_FILE
    host: float = limits.DOWNLOAD_HOST
    job: float = limits.DOWNLOAD_JOB


PACE = Pace()


@dataclass
class Spent:
    """Seconds of requests, added by several threads."""

    seconds: float = 0.0
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def add(self, seconds: float) -> None:
        """Add the seconds of a request."""
        with self._lock:
            self.seconds += seconds


class Watch:
    """Time limits of one request; its connection is shut when they end.

    Attributes
    ----------
    expired
        A limit ended the request.
    """

    def __init__(self, pace: Pace) -> None:
        self.expired = False
        self.began = time.monotonic()
        self._pace, self._last = pace, self.began + pace.file
        self.until = self._last
        self._handle: socket.socket | None = None
        self.step()

    def step(self) -> None:
        """Start the time of the next piece."""
        self.until = min(time.monotonic() + self._pace.piece, self._last)

    def attach(self, handle: socket.socket) -> None:
        """Shut the connection of a handle when the time is over."""
        self._handle = handle
        if self.expired:
            self.shut()

    def shut(self) -> None:
        """End the request: a blocked read returns at once."""
        self.expired = True
        if self._handle is not None:
            with contextlib.suppress(OSError):
                self._handle.shutdown(socket.SHUT_RDWR)


class Watchdog:
    """Thread that ends requests whose time is over; it runs while there are requests."""

    def __init__(self) -> None:
        self._watches: set[Watch] = set()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None

    @contextlib.contextmanager
    def watching(self, watch: Watch) -> Iterator[None]:
        """Watch a request during the block."""
        with self._changed:
            self._watches.add(watch)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, daemon=True)
                self._thread.start()
            self._changed.notify()
        try:
            yield
        finally:
            with self._changed:
                self._watches.discard(watch)
                self._changed.notify()

    def _run(self) -> None:
        with self._changed:
            while self._watches:
                left = min(watch.until for watch in self._watches) - time.monotonic()
                if left > 0.0:
                    self._changed.wait(left)
                    continue
                for watch in [each for each in self._watches if each.until <= time.monotonic()]:
                    self._watches.discard(watch)
                    watch.shut()
            self._thread = None
