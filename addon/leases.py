"""Leases: mutual exclusion and work sharing between processes, on one or several machines.

`lock` gives one process at a time exclusive access. It uses SQLite's lock of an empty database, which all
systems support and release when the process ends.

`Leases` divide pieces of work among processes on several machines, by a database in the shared folder. An
owner sends heartbeats; its leases expire after `PATIENCE` seconds without one. Clocks of machines differ, so
heartbeats are counters without dates, and the waiting process measures the time.

`heartbeats` calls a function periodically from a thread.
"""

from __future__ import annotations

import contextlib
import shutil
import sqlite3
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path

from . import files
from .database import Database
from .errors import Error, writing

HEARTBEAT = 3.0  # s between heartbeats of an owner
PATIENCE = 16.0  # s without a heartbeat after which leases expire
TABLES = """
CREATE TABLE owners (owner TEXT PRIMARY KEY, beat INTEGER);
CREATE TABLE claims (name TEXT PRIMARY KEY, owner TEXT);
"""
"""Tables of the database that holds `Leases`."""

_POLL_INTERVAL = 0.5  # s between polls of a waiting process
_PART = ".part-"


@contextlib.contextmanager
def heartbeats(every: float, send: Callable[[], None]) -> Iterator[None]:
    """Call `send` from a thread every `every` seconds; failures are ignored until the next call."""
    ended = threading.Event()

    def repeat() -> None:
        while not ended.wait(every):
            with contextlib.suppress(Error, OSError):
                send()

    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@contextlib.contextmanager
def lock(path: Path, done: Callable[[], bool], wait: Callable[[], None]) -> Iterator[bool]:
    """Lock the file `path`; yields False, without the lock, if another process completes the work meanwhile.

    On a file system without locks all processes proceed: the work is done twice with the same result.

    Parameters
    ----------
    wait
        Called periodically while another process works; an exception from it ends the waiting.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    with writing(path):
        path.touch()
    with contextlib.closing(sqlite3.connect(path, timeout=0.0, isolation_level=None)) as database:
        mine = _lock(database) or not _can_lock(path)
        while not mine and not done():
            wait()
            time.sleep(_POLL_INTERVAL)
            mine = _lock(database)
        yield mine


def _lock(database: sqlite3.Connection) -> bool:
    """Try to lock a database; returns whether the lock was acquired."""
    try:
        database.execute("BEGIN EXCLUSIVE")
    except sqlite3.Error as error:
        return getattr(error, "sqlite_errorcode", 0) != sqlite3.SQLITE_BUSY
    return True


def _can_lock(path: Path) -> bool:
    """Check if the file system of `path` has locks: SQLite reports a missing lock server (ENOLCK) as busy."""
    probe = files.temporary_path(path)
    try:
        with contextlib.closing(sqlite3.connect(probe, timeout=0.0, isolation_level=None)) as database:
            return _lock(database)
    finally:
        with contextlib.suppress(OSError):
            probe.unlink(missing_ok=True)


class Leases:
    """Leases of one process, the `owner`; a thread sends heartbeats until it is closed.

    Parameters
    ----------
    data
        Database with the `TABLES`, in the shared folder.
    """

    def __init__(self, data: Database, owner: str) -> None:
        self.data, self.owner = data, owner
        self._seen: dict[str, tuple[int, float]] = {}
        _beat(data, owner)
        sweep(data)
        self._life = contextlib.ExitStack()
        self._life.enter_context(heartbeats(HEARTBEAT, self._send_heartbeat))

    def __enter__(self) -> Leases:
        return self

    def __exit__(self, *_: object) -> None:
        self._life.close()
        leave(self.data, self.owner)

    def take(self, name: str) -> bool:
        """Acquire a lease; False if another owner has it."""
        with self.data.change():
            self.data.execute("INSERT OR IGNORE INTO owners VALUES (?, 0)", self.owner)
            self.data.execute("INSERT OR IGNORE INTO claims VALUES (?, ?)", name, self.owner)
        return self.is_held(name)

    def is_held(self, name: str) -> bool:
        """Check whether this process still has the lease, which can expire while the machine sleeps."""
        return self.data.fetch_one("SELECT owner FROM claims WHERE name = ?", name) == (self.owner,)

    def release(self, name: str) -> None:
        """Release a lease."""
        self.data.execute("DELETE FROM claims WHERE name = ? AND owner = ?", name, self.owner)

    def of_others(self) -> set[str]:
        """Return the leases of other owners, after removing expired ones."""
        self._expire()
        rows = self.data.fetch_all("SELECT name FROM claims WHERE owner != ?", self.owner)
        return {name for (name,) in rows}

    @contextlib.contextmanager
    def part_folder(self) -> Iterator[Path]:
        """Create a temporary folder in the shared folder, from which files can be renamed to their paths."""
        part = self.data.path.parent / f"{_PART}{self.owner}"
        with writing(part):
            part.mkdir(exist_ok=True)
        try:
            yield part
        finally:
            shutil.rmtree(part, ignore_errors=True)

    def _expire(self) -> None:
        now, beats = time.monotonic(), _beats(self.data)
        for owner, beat in beats.items():
            known, since = self._seen.get(owner, (None, now))
            if known != beat:
                self._seen[owner] = (beat, now)
            elif owner != self.owner and now - since > PATIENCE:
                leave(self.data, owner, beat)

    def _send_heartbeat(self) -> None:
        with contextlib.closing(self.data.reopen()) as data:
            _beat(data, self.owner)


def new_owner() -> str:
    """Create a unique owner name."""
    return uuid.uuid4().hex[:12]


def leave(data: Database, owner: str, beat: int | None = None) -> None:
    """Remove an owner, its leases and its unfinished files, unless it sent a heartbeat after `beat`."""
    with data.change():
        if beat is not None and _beats(data).get(owner) != beat:
            return
        data.execute("DELETE FROM claims WHERE owner = ?", owner)
        data.execute("DELETE FROM owners WHERE owner = ?", owner)
    sweep(data)


def sweep(data: Database) -> None:
    """Remove unfinished files of owners that no longer exist."""
    left = list(data.path.parent.glob(f"{_PART}*"))
    alive = _beats(data)
    for part in left:
        if part.name.removeprefix(_PART) not in alive:
            shutil.rmtree(part, ignore_errors=True)


def _beat(data: Database, owner: str) -> None:
    with data.change():
        data.execute("INSERT OR IGNORE INTO owners VALUES (?, 0)", owner)
        data.execute("UPDATE owners SET beat = beat + 1 WHERE owner = ?", owner)


def _beats(data: Database) -> dict[str, int]:
    return dict(data.fetch_all("SELECT owner, beat FROM owners"))
