"""Error types and messages, shared by Python and C++."""

from __future__ import annotations

import errno
import os
import shutil
import sqlite3
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, strerror
from pathlib import Path

from firetwin_core import Error, InputError

__all__ = [
    "DISK_FULL",
    "Error",
    "FullDiskError",
    "InputError",
    "TryAgainError",
    "UnavailableError",
    "UsageError",
    "disk_is_full",
    "full_disk_error",
    "input_error",
    "is_nearly_full",
    "is_worth_another_try",
    "read_fault",
    "reading",
    "refuse_odd",
    "writing",
]

DISK_FULL = (
    "the disk is full; free some space or choose another folder, then run it again; finished files stay"
)
_LONGEST = 300  # characters of a message of another library
_LITTLE = 1 << 22  # bytes, below which a disk counts as full
_OPEN = (5, 32)  # Windows' errors for files that a program has open
_NO_ROOM = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))


class TryAgainError(Error):
    """Temporary or local failure: the same command may succeed later or on another machine."""


class UnavailableError(InputError, TryAgainError):
    """Temporary or local failure of a request at a known file, line and column."""


class FullDiskError(UnavailableError):
    """A file cannot be written because the disk is full."""


def input_error(
    path: str | PathLike[str],
    reason: str,
    *,
    line: int = 0,
    column: int = 0,
    kind: type[InputError] = InputError,
) -> InputError:
    """Create an InputError whose message has the format of the core: `path:line:column: reason`.

    `line` and `column` count from 1; 0 leaves them out.
    """
    place = str(path)
    if line > 0:
        place += f":{line}" + (f":{column}" if column > 0 else "")
    error = kind(f"{place}: {reason}")
    error.path, error.line, error.column, error.reason = str(path), line, column, reason
    return error


def full_disk_error(path: str | PathLike[str]) -> InputError:
    """Create the FullDiskError for a file."""
    return input_error(path, DISK_FULL, kind=FullDiskError)


@contextmanager
def writing(path: str | PathLike[str]) -> Iterator[None]:
    """Convert errors during the writing of `path` to messages that name the file and a remedy.

    Raises
    ------
    InputError
        Replaces an OSError, and an OperationalError of SQLite.
    FullDiskError
        Replaces an error due to a full disk, including errors of the core.
    """
    try:
        yield
    except OSError as error:
        if disk_is_full(error):
            raise full_disk_error(path) from error
        remedy = "close programs that show it, or " if getattr(error, "winerror", 0) in _OPEN else ""
        reason = f"cannot be written ({_reason(error)}); {remedy}choose another folder"
        raise input_error(path, reason) from error
    except sqlite3.OperationalError as error:
        silent = "disk I/O error" in str(error) and is_nearly_full(Path(path))
        if silent or disk_is_full(error):
            raise full_disk_error(path) from error
        raise input_error(path, f"cannot be written ({error}); choose another folder") from error
    except FullDiskError:
        raise
    except Error as error:
        silent = "cannot be written" in str(error) and is_nearly_full(Path(path))
        if silent or disk_is_full(error):
            raise full_disk_error(path) from error
        raise


@contextmanager
def reading(path: str | PathLike[str], kind: str = "") -> Iterator[None]:
    """Convert errors during the reading of `path` to messages that name the file and a remedy.

    It surrounds every reader of a user's file. A reader itself names the place of a fault that it expects.

    Parameters
    ----------
    path
        The file, or a folder; an error of the system names the file in it.
    kind
        Format of the file for the message, such as "GeoTIFF".

    Raises
    ------
    InputError
        The file is a pipe or a device. Replaces other exceptions of the system, SQLite, Python and libraries.
        NameError and ImportError pass: these are faults of the code.
    """
    refuse_odd(path)
    try:
        yield
    except (Error, UsageError, NameError, ImportError):  # the last two are faults of the code
        raise
    except Exception as error:
        if disk_is_full(error):  # of temporary files
            raise full_disk_error(path) from error
        if isinstance(error, OSError) and isinstance(error.filename, str):
            path = error.filename
        reason = read_fault(error, kind).replace(f"'{path}' not", "it is not").replace(f"'{path}'", "it")
        raise input_error(path, reason) from error


def refuse_odd(path: str | PathLike[str]) -> None:
    """Refuse a pipe, a device or a socket, also behind a link: reading it may wait or never end.

    Raises
    ------
    InputError
        It is one. A missing file is left to its reader.
    """
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):
        return
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        raise input_error(path, "is a pipe or a device; name a file")


def read_fault(error: Exception, kind: str = "") -> str:
    """Describe why a file of a `kind`, such as "GeoTIFF", cannot be read, and the remedy."""
    text = getattr(error, "strerror", None) or str(error.__cause__ or error)
    why = " ".join(text.split())[:_LONGEST].rstrip(".") or type(error).__name__
    if isinstance(error, PermissionError) and error.filename and Path(error.filename).is_dir():
        error = IsADirectoryError()  # which Windows does not tell from a lack of permission
    for fault, text in _FAULTS.items():
        if isinstance(error, fault):
            return text
    if isinstance(error, UnicodeDecodeError):
        return f"is not UTF-8 text (byte {error.start + 1:,}); save it as UTF-8"
    if isinstance(error, OSError) and (error.errno or 0) > 0:  # libraries raise others
        return f"cannot be read ({_reason(error).lower()}); copy it to a local folder"
    if type(error).__module__.startswith("sqlite3"):
        kind = "GeoPackage"
    if kind:
        return f"cannot be read as a {kind}: {why}; export it again"
    return f"is damaged or incomplete: {why}; export it again"


def disk_is_full(error: BaseException) -> bool:
    """Check whether an error of Python, NumPy, the core or SQLite is due to a full disk."""
    if isinstance(error, FullDiskError):
        return True
    if isinstance(error, OSError) and error.errno is not None:
        return error.errno in _NO_ROOM
    text = str(error)
    return any(words in text for words in (strerror(errno.ENOSPC), "disk is full", " requested and "))


def is_worth_another_try(error: BaseException) -> bool:
    """Check whether a repetition may succeed later or on another machine."""
    full = isinstance(error, OSError) and error.errno in _NO_ROOM
    return full or isinstance(error, TryAgainError)


def is_nearly_full(path: Path) -> bool:
    """Check whether the disk of a written file is almost full, which Blender does not always report."""
    try:
        return shutil.disk_usage(path.parent).free < _LITTLE
    except OSError:
        return False


def _reason(error: OSError) -> str:
    return error.strerror or " ".join(str(error).split())


class UsageError(Exception):
    """Invalid command line arguments."""


_FAULTS: dict[type[Exception], str] = {
    FileNotFoundError: "there is no such file; check the path",
    IsADirectoryError: "is a folder; name a file",
    PermissionError: "cannot be read (permission denied); change its permissions, or copy it",
    RecursionError: "has parts that are nested too deeply; export it without nesting",
    MemoryError: "does not fit into the memory; use a part of it",
}
