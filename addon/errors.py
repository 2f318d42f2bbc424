"""Errors for people: made here so that Python and C++ raise the very same type."""

from __future__ import annotations

from os import PathLike

from firetwin_core import Error, InputError

__all__ = ["Error", "InputError", "UsageError", "input_error"]


def input_error(path: str | PathLike[str], line: int, column: int, reason: str) -> InputError:
    """An InputError at 1-based `line` and `column` (0: none applies), worded as the core words its own."""
    place = str(path)
    if line > 0:
        place += f":{line}" + (f":{column}" if column > 0 else "")
    error = InputError(f"{place}: {reason}")
    error.path, error.line, error.column, error.reason = str(path), line, column, reason
    return error


class UsageError(Exception):
    """The command line asks for something that is not there."""
