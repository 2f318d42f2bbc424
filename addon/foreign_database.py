"""SQLite files of others, such as GeoPackages: read only, within the limits of `limits`.

A value of a plain column is stored in the file. Generated columns, views and virtual tables compute values,
so that a small file can fill the memory: they are not read.
"""

from __future__ import annotations

import contextlib
import sqlite3
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from . import limits
from .errors import InputError, input_error

_STEPS = 100_000  # of SQLite's virtual machine between two checks of the time
_ROW = 4  # bytes that a row takes at least
_GENERATED = (2, 3)  # `hidden` of pragma_table_xinfo: virtual and stored generated columns
_CAPS = {
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: limits.SQLITE_SQL,
    sqlite3.SQLITE_LIMIT_COLUMN: limits.SQLITE_COLUMNS,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: limits.SQLITE_DEPTH,
    sqlite3.SQLITE_LIMIT_COMPOUND_SELECT: 10,
    sqlite3.SQLITE_LIMIT_VDBE_OP: 1_000_000,
    sqlite3.SQLITE_LIMIT_FUNCTION_ARG: 100,
    sqlite3.SQLITE_LIMIT_ATTACHED: 0,
    sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 1000,
    sqlite3.SQLITE_LIMIT_VARIABLE_NUMBER: 100,
    sqlite3.SQLITE_LIMIT_TRIGGER_DEPTH: 10,
    sqlite3.SQLITE_LIMIT_WORKER_THREADS: 0,
}


class ForeignDatabase:
    """A SQLite file of someone else.

    Raises
    ------
    sqlite3.Error
        The file is not a database, or is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._size = path.stat().st_size
        with contextlib.suppress(OSError):
            self._size += path.with_name(f"{path.name}-wal").stat().st_size
        self._room = limits.SQLITE_GROWTH * self._size + limits.SQLITE_FREE
        self._until = time.thread_time() + limits.SQLITE_SECONDS + self._size / 1e7
        self._late = False
        self._base = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
        for category, most in _CAPS.items():
            self._base.setlimit(category, most)
        self._base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, min(self._room, limits.SQLITE_LENGTH))
        self._base.set_progress_handler(self._stop_if_late, _STEPS)
        self._base.execute("PRAGMA trusted_schema = OFF")
        self._base.execute("PRAGMA query_only = ON")

    def close(self) -> None:
        """Close the file."""
        self._base.close()

    def tables(self) -> set[str]:
        """Return the names of the tables that store their rows in this file."""
        command = "SELECT name FROM sqlite_master WHERE type = 'table' AND sql NOT LIKE 'CREATE VIRTUAL%'"
        return {name for (name,) in self._rows(command)}

    def columns(self, table: str) -> list[str]:
        """Return the names of the stored columns of a table; empty without such a table."""
        if table not in self.tables():
            return []
        found = self._rows("SELECT name, hidden FROM pragma_table_xinfo(?)", table)
        return [name for name, hidden in found if hidden not in _GENERATED]

    def rows(self, table: str, columns: Sequence[str] = (), order: str = "") -> Iterator[tuple[Any, ...]]:
        """Read the rows of a table.

        Parameters
        ----------
        columns
            Stored columns to read; all without any.
        order
            Column by which rows are sorted.

        Raises
        ------
        InputError
            The table or a column is missing or computed, or the rows exceed a limit.
        """
        stored = self.columns(table)
        if not stored:
            raise input_error(
                self.path, f"has no table {table} with stored rows (views are not read); export it as a table"
            )
        if missing := [name for name in (*columns, *([order] if order else [])) if name not in stored]:
            reason = f"table {table} has no stored column {missing[0]} (generated columns are not read)"
            raise input_error(self.path, f"{reason}; add it as a plain column")
        listed = ", ".join(map(_quoted, columns or stored))
        sort = f" ORDER BY {_quoted(order)}" if order else ""
        yield from self._rows(f"SELECT {listed} FROM {_quoted(table)}{sort}")

    def _rows(self, command: str, *values: Any) -> Iterator[tuple[Any, ...]]:
        """Run a query; its rows may hold about as many bytes as the file."""
        left = self._room
        try:
            for row in self._base.execute(command, values):
                left -= _ROW + sum(len(each) for each in row if isinstance(each, str | bytes))
                if left < 0:
                    raise self._too_large()
                yield row
        except sqlite3.DataError as error:
            raise self._too_large() from error
        except sqlite3.OperationalError as error:
            if self._late:
                reason = f"takes more than {limits.SQLITE_SECONDS} s to read; copy its tables to a new file"
                raise input_error(self.path, reason) from error
            raise
        except MemoryError:  # the limits bound what sound files need
            raise input_error(self.path, "is damaged or incomplete; export it again") from None

    def _too_large(self) -> InputError:
        reason = f"a table has more data than a file of {self._size:,} bytes can store; it may be an attack"
        return input_error(self.path, f"{reason}: copy its tables to a new file")

    def _stop_if_late(self) -> bool:
        self._late = time.thread_time() > self._until
        return self._late


@contextlib.contextmanager
def opened(path: Path) -> Iterator[ForeignDatabase]:
    """Open a SQLite file of someone else, and close it at the end."""
    with contextlib.closing(ForeignDatabase(path)) as base:
        yield base


def _quoted(name: str) -> str:
    escaped = name.replace('"', '""')
    return f'"{escaped}"'
