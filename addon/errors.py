"""Error types and messages, shared by Python and C++."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, strerror
from pathlib import Path

from firetwin_core import Error, InputError

__all__ = ["FULL", "Error", "InputError", "UsageError", "disk_is_full", "input_error", "no_room", "writing"]

FULL = "the disk is full; free some room or choose another place, then run it again: what is finished is kept"
_LITTLE = 1 << 22  # bytes
_NO_ROOM = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))


def input_error(path: str | PathLike[str], line: int, column: int, reason: str) -> InputError:
    """InputError at 1-based `line` and `column` (0: none), in the format of the core's messages."""
    place = str(path)
    if line > 0:
        place += f":{line}" + (f":{column}" if column > 0 else "")
    error = InputError(f"{place}: {reason}")
    error.path, error.line, error.column, error.reason = str(path), line, column, reason
    return error


@contextmanager
def writing(path: str | PathLike[str]) -> Iterator[None]:
    """Convert errors while `path` is written to messages that name it and the remedy.

    Raises
    ------
    InputError
        Replaces an OSError, and the core's own error of a full disk.
    """
    try:
        yield
    except OSError as error:
        reason = FULL if disk_is_full(error) else f"cannot be written ({_words(error)}); choose another place"
        raise input_error(path, 0, 0, reason) from error
    except Error as error:
        silent = "cannot be written" in str(error) and no_room(Path(path))
        if (silent or disk_is_full(error)) and FULL not in str(error):
            raise input_error(path, 0, 0, FULL) from error
        raise


def disk_is_full(error: BaseException) -> bool:
    """Whether an error of Python, NumPy, the core or SQLite means that the disk is full."""
    if isinstance(error, OSError) and error.errno is not None:
        return error.errno in _NO_ROOM
    text = str(error)
    return any(words in text for words in (strerror(errno.ENOSPC), "disk is full", " requested and "))


def no_room(path: Path) -> bool:
    """Whether the disk of a written file is almost full, which Blender does not always report."""
    try:
        return shutil.disk_usage(path.parent).free < _LITTLE
    except OSError:
        return False


def _words(error: OSError) -> str:
    return error.strerror or " ".join(str(error).split())


class UsageError(Exception):
    """Invalid command line arguments."""
