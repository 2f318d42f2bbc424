"""Who works on what: processes, also of several machines, that share the work in a folder.

- `alone`: one process at a time does a piece of work. It holds SQLite's lock of an empty database, which
  every system has and which ends with the process, however that ends.
- `Claims`: processes of several machines each take pieces of the work, in a database in the shared folder.
  An owner gives signs of life; one that gives none for `PATIENCE` seconds has lost what it held. Signs are
  counted, not dated, as clocks differ: the seconds are those of whoever waits.
- `signs`: signs of life from a thread.
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

from .database import Database
from .errors import Error, writing

BEAT = 3.0  # s between two signs of life of an owner
PATIENCE = 16.0  # s
TABLES = """
CREATE TABLE owners (owner TEXT PRIMARY KEY, beat INTEGER);
CREATE TABLE claims (name TEXT PRIMARY KEY, owner TEXT);
"""
"""Of the database that `Claims` are in."""

_LOOK = 0.5  # s between two looks of who waits
_PART = ".part-"


@contextlib.contextmanager
def signs(every: float, give: Callable[[], None]) -> Iterator[None]:
    """Call `give` from a thread every so many seconds; what it fails at is tried again the next time."""
    over = threading.Event()

    def live() -> None:
        while not over.wait(every):
            with contextlib.suppress(Error, OSError):
                give()

    thread = threading.Thread(target=live, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@contextlib.contextmanager
def alone(path: Path, done: Callable[[], bool], wait: Callable[[], None]) -> Iterator[bool]:
    """Hold the file `path`; False, and not held, if the work turns out done while another has it.

    Where a file system knows no locks, everybody works: they do the same twice.

    Parameters
    ----------
    wait
        Called now and then while another works; what it raises ends the waiting.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    with writing(path):
        path.touch()
    with contextlib.closing(sqlite3.connect(path, timeout=0.0, isolation_level=None)) as database:
        mine = _lock(database)
        while not mine and not done():
            wait()
            time.sleep(_LOOK)
            mine = _lock(database)
        yield mine


def _lock(database: sqlite3.Connection) -> bool:
    """Whether a database is ours now."""
    try:
        database.execute("BEGIN EXCLUSIVE")
    except sqlite3.Error as error:
        return getattr(error, "sqlite_errorcode", 0) != sqlite3.SQLITE_BUSY
    return True


class Claims:
    """What one process, the `owner`, holds; it gives signs of life from a thread until it is closed.

    Parameters
    ----------
    data
        With the `TABLES`; its folder is the shared one.
    """

    def __init__(self, data: Database, owner: str) -> None:
        self.data, self.owner = data, owner
        self._seen: dict[str, tuple[int, float]] = {}
        _beat(data, owner)
        sweep(data)
        self._life = contextlib.ExitStack()
        self._life.enter_context(signs(BEAT, self._sign))

    def __enter__(self) -> Claims:
        return self

    def __exit__(self, *_: object) -> None:
        self._life.close()
        leave(self.data, self.owner)

    def take(self, name: str) -> bool:
        """Claim something; False where another has it."""
        with self.data.change():
            self.data.do("INSERT OR IGNORE INTO owners VALUES (?, 0)", self.owner)
            self.data.do("INSERT OR IGNORE INTO claims VALUES (?, ?)", name, self.owner)
        return self.held(name)

    def held(self, name: str) -> bool:
        """Whether it is ours; who slept for long may have lost it."""
        return self.data.one("SELECT owner FROM claims WHERE name = ?", name) == (self.owner,)

    def give(self, name: str) -> None:
        """Give it back."""
        self.data.do("DELETE FROM claims WHERE name = ? AND owner = ?", name, self.owner)

    def of_others(self) -> set[str]:
        """What others hold; the dead are buried before."""
        self._bury()
        rows = self.data.all("SELECT name FROM claims WHERE owner != ?", self.owner)
        return {name for (name,) in rows}

    @contextlib.contextmanager
    def part_folder(self) -> Iterator[Path]:
        """A folder for files in the making, inside the shared folder so that they can be renamed."""
        part = self.data.path.parent / f"{_PART}{self.owner}"
        with writing(part):
            part.mkdir(exist_ok=True)
        try:
            yield part
        finally:
            shutil.rmtree(part, ignore_errors=True)

    def _bury(self) -> None:
        now, beats = time.monotonic(), _beats(self.data)
        for owner, beat in beats.items():
            known, since = self._seen.get(owner, (None, now))
            if known != beat:
                self._seen[owner] = (beat, now)
            elif owner != self.owner and now - since > PATIENCE:
                leave(self.data, owner, beat)

    def _sign(self) -> None:
        with contextlib.closing(self.data.again()) as data:
            _beat(data, self.owner)


def new_owner() -> str:
    """A name that no other process has."""
    return uuid.uuid4().hex[:12]


def leave(data: Database, owner: str, beat: int | None = None) -> None:
    """End an owner, unless it lived on after `beat`: what it held is free, what it left unfinished goes."""
    with data.change():
        if beat is not None and _beats(data).get(owner) != beat:
            return
        data.do("DELETE FROM claims WHERE owner = ?", owner)
        data.do("DELETE FROM owners WHERE owner = ?", owner)
    sweep(data)


def sweep(data: Database) -> None:
    """Remove what those have left unfinished that are no more."""
    left = list(data.path.parent.glob(f"{_PART}*"))
    alive = _beats(data)
    for part in left:
        if part.name.removeprefix(_PART) not in alive:
            shutil.rmtree(part, ignore_errors=True)


def _beat(data: Database, owner: str) -> None:
    with data.change():
        data.do("INSERT OR IGNORE INTO owners VALUES (?, 0)", owner)
        data.do("UPDATE owners SET beat = beat + 1 WHERE owner = ?", owner)


def _beats(data: Database) -> dict[str, int]:
    return dict(data.all("SELECT owner, beat FROM owners"))
