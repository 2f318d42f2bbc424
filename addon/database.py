"""SQLite files to which processes on several machines write at the same time."""

from __future__ import annotations

import contextlib
import errno
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .errors import disk_is_full, input_error, writing

_WAIT = 60.0  # s of waiting for another writer
_FORMAT = 1
BROKEN = "is not {} of Firetwin; move it away, or choose another output folder"


class Database:
    """Connection to one SQLite file; each thread needs a separate connection.

    Parameters
    ----------
    tables
        SQL commands that create the tables.
    create
        Create a missing file. If False, an empty database in memory replaces a missing file.
    journal
        Journal mode of a new file. ``WAL`` is faster, but requires that all processes run on one machine.

    Raises
    ------
    InputError
        The file is not such a database, or the disk is full.
    """

    def __init__(self, path: Path, tables: str, create: bool, journal: str = "DELETE") -> None:
        self.path = path
        there = path.exists()
        if create:
            with writing(path):
                path.parent.mkdir(parents=True, exist_ok=True)
        with self._convert_errors():
            place = path if there or create else ":memory:"
            self._data = sqlite3.connect(place, timeout=_WAIT, isolation_level=None)
        try:
            self._prepare(tables, journal)
        except BaseException:
            self._data.close()
            raise

    def reopen(self) -> Database:
        """Open the same file for another thread."""
        return Database(self.path, "", create=False)

    def close(self) -> None:
        """Close the file."""
        self._data.close()

    @contextlib.contextmanager
    def change(self) -> Iterator[None]:
        """Group commands into one transaction, which is rolled back on an exception."""
        self.execute("BEGIN IMMEDIATE")
        try:
            yield
            self.execute("COMMIT")
        except BaseException:
            with contextlib.suppress(sqlite3.Error):
                self._data.execute("ROLLBACK")
            raise

    def execute(self, command: str, *values: Any) -> None:
        """Run a command; outside `change` it is a transaction."""
        with self._convert_errors():
            self._data.execute(command, values)

    def fetch_one(self, command: str, *values: Any) -> tuple[Any, ...] | None:
        """Return the first row of a query, or None."""
        with self._convert_errors():
            return self._data.execute(command, values).fetchone()

    def fetch_all(self, command: str, *values: Any) -> list[tuple[Any, ...]]:
        """Return all rows of a query."""
        with self._convert_errors():
            return self._data.execute(command, values).fetchall()

    def _prepare(self, tables: str, journal: str) -> None:
        if self._format() == 0:
            self.execute(f"PRAGMA journal_mode = {journal}")
            with self.change():
                if self._format() == 0 and not self.fetch_one("SELECT 1 FROM sqlite_master"):
                    for command in tables.strip().rstrip(";").split(";"):
                        self.execute(command)
                    self.execute(f"PRAGMA user_version = {_FORMAT}")
        if self._format() != _FORMAT:
            raise input_error(self.path, BROKEN.format("a store"))

    def _format(self) -> int:
        (number,) = self.fetch_one("PRAGMA user_version") or (0,)
        return number

    @contextlib.contextmanager
    def _convert_errors(self) -> Iterator[None]:
        """Convert errors of SQLite to errors that name the file and a remedy."""
        try:
            yield
        except sqlite3.OperationalError as error:
            if disk_is_full(error):
                with writing(self.path):
                    raise OSError(errno.ENOSPC, str(error)) from error
            reason = f"cannot be used ({error}); choose a writable folder, and if shared, one with file locks"
            raise input_error(self.path, reason) from error
        except sqlite3.DatabaseError as error:
            raise input_error(self.path, BROKEN.format("a store")) from error
