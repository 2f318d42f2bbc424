"""SQLite files that processes on several machines write at the same time."""

from __future__ import annotations

import contextlib
import errno
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .errors import disk_is_full, input_error, writing

_WAIT = 60.0  # s for another process that writes
_FORMAT = 1
BROKEN = "is not {} of Firetwin; move it away, or render to another folder"


class Database:
    """One file; each thread has one of its own.

    Parameters
    ----------
    tables
        SQL that makes them.
    create
        Make the file where there is none; otherwise an empty one in memory stands in for it.
    journal
        Of a new file. ``WAL`` is quicker, but for processes of one machine alone.

    Raises
    ------
    InputError
        The file is something else, or the disk is full.
    """

    def __init__(self, path: Path, tables: str, create: bool, journal: str = "DELETE") -> None:
        self.path = path
        there = path.exists()
        if create:
            with writing(path):
                path.parent.mkdir(parents=True, exist_ok=True)
        with self._told():
            place = path if there or create else ":memory:"
            self._data = sqlite3.connect(place, timeout=_WAIT, isolation_level=None)
        try:
            self._prepare(tables, journal)
        except BaseException:
            self._data.close()
            raise

    def again(self) -> Database:
        """The same file for another thread."""
        return Database(self.path, "", create=False)

    def close(self) -> None:
        """Let go of the file."""
        self._data.close()

    @contextlib.contextmanager
    def change(self) -> Iterator[None]:
        """What is done within happens as a whole or not at all."""
        self.do("BEGIN IMMEDIATE")
        try:
            yield
            self.do("COMMIT")
        except BaseException:
            with contextlib.suppress(sqlite3.Error):
                self._data.execute("ROLLBACK")
            raise

    def do(self, command: str, *values: Any) -> None:
        """Run a command; one by itself is a change."""
        with self._told():
            self._data.execute(command, values)

    def one(self, command: str, *values: Any) -> tuple[Any, ...] | None:
        """First row of what a query finds."""
        with self._told():
            return self._data.execute(command, values).fetchone()

    def all(self, command: str, *values: Any) -> list[tuple[Any, ...]]:
        """Every row of what a query finds."""
        with self._told():
            return self._data.execute(command, values).fetchall()

    def _prepare(self, tables: str, journal: str) -> None:
        if self._format() == 0:
            self.do(f"PRAGMA journal_mode = {journal}")
            with self.change():
                if self._format() == 0 and not self.one("SELECT 1 FROM sqlite_master"):
                    for command in tables.strip().rstrip(";").split(";"):
                        self.do(command)
                    self.do(f"PRAGMA user_version = {_FORMAT}")
        if self._format() != _FORMAT:
            raise input_error(self.path, BROKEN.format("a store"))

    def _format(self) -> int:
        (number,) = self.one("PRAGMA user_version") or (0,)
        return number

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        """Errors of SQLite in the words of ours."""
        try:
            yield
        except sqlite3.OperationalError as error:
            if disk_is_full(error):
                with writing(self.path):
                    raise OSError(errno.ENOSPC, str(error)) from error
            reason = f"cannot be used ({error}); choose a folder that can be written and, if shared, locked"
            raise input_error(self.path, reason) from error
        except sqlite3.DatabaseError as error:
            raise input_error(self.path, BROKEN.format("a store")) from error
