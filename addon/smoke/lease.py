"""One process at a time does a piece of work; the others wait until it is done, or take it over. No Blender.

Who works holds SQLite's lock of an empty database, which every system has and which ends with the process,
however that ends. Where a file system knows no locks, everybody works: they do the same twice.
"""

from __future__ import annotations

import contextlib
import sqlite3
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from ..errors import writing

_LOOK = 0.5  # s between two looks of who waits


@contextlib.contextmanager
def held(path: Path, done: Callable[[], bool], wait: Callable[[], None]) -> Iterator[bool]:
    """Hold the file `path`; False, and not held, if the work turns out done while another has it.

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
