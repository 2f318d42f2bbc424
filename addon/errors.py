"""Error types and messages, shared by Python and C++."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, strerror
from pathlib import Path
from typing import Any

from firetwin_core import Error, InputError

__all__ = [
    "FULL",
    "Error",
    "FullDiskError",
    "InputError",
    "TryAgainError",
    "UnavailableError",
    "UsageError",
    "disk_is_full",
    "full_disk_error",
    "input_error",
    "is_worth_another_try",
    "no_room",
    "plain",
    "restored",
    "writing",
]

FULL = "the disk is full; free some room or choose another place, then run it again: what is finished is kept"
_LITTLE = 1 << 22  # bytes
_NO_ROOM = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))


class TryAgainError(Error):
    """This machine cannot do now what is asked for; the same may succeed later or elsewhere."""


class UnavailableError(InputError, TryAgainError):
    """The same, with the place of what asks for it: a file, line and column."""


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
    """FullDiskError of a file."""
    return input_error(path, FULL, kind=FullDiskError)


def plain(error: Error) -> dict[str, Any]:
    """An error as JSON carries it to another process; `restored` is the reverse."""
    kind = next(name for each in type(error).__mro__ if (name := each.__name__) in _KINDS)
    if isinstance(error, InputError):
        return {"kind": kind, "place": [error.path, error.line, error.column, error.reason]}
    return {"kind": kind, "text": " ".join(str(error).split())}


def restored(found: dict[str, Any], more: str = "") -> Error:
    """An error of another process.

    Parameters
    ----------
    more
        To append to the message of an error without a place.
    """
    kind = _KINDS[found["kind"]]
    if "place" in found:
        path, line, column, reason = found["place"]
        return input_error(path, reason, line=line, column=column, kind=kind)
    return kind(found["text"] + more)


_KINDS: dict[str, Any] = {
    kind.__name__: kind for kind in (FullDiskError, UnavailableError, InputError, TryAgainError, Error)
}


@contextmanager
def writing(path: str | PathLike[str]) -> Iterator[None]:
    """Convert errors while `path` is written to messages that name it and the remedy.

    Raises
    ------
    InputError
        Replaces an OSError.
    FullDiskError
        Replaces those of a full disk, also the core's own.
    """
    try:
        yield
    except OSError as error:
        if disk_is_full(error):
            raise full_disk_error(path) from error
        reason = f"cannot be written ({_words(error)}); choose another place"
        raise input_error(path, reason) from error
    except FullDiskError:
        raise
    except Error as error:
        silent = "cannot be written" in str(error) and no_room(Path(path))
        if silent or disk_is_full(error):
            raise full_disk_error(path) from error
        raise


def disk_is_full(error: BaseException) -> bool:
    """Whether an error of Python, NumPy, the core or SQLite means that the disk is full."""
    if isinstance(error, FullDiskError):
        return True
    if isinstance(error, OSError) and error.errno is not None:
        return error.errno in _NO_ROOM
    text = str(error)
    return any(words in text for words in (strerror(errno.ENOSPC), "disk is full", " requested and "))


def is_worth_another_try(error: BaseException) -> bool:
    """Whether the same may succeed later or on another machine."""
    full = isinstance(error, OSError) and error.errno in _NO_ROOM
    return full or isinstance(error, TryAgainError)


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
