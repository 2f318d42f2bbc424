"""Untrusted JSON, read within limits; errors name the file and the JSON path."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from typing import Any, NoReturn

import numpy as np

from .. import limits
from ..errors import InputError, input_error

MAX_BYTES = limits.TILE_JSON_BYTES  # of one text
DEEPEST = limits.TILE_JSON_DEPTH

_TEXT = re.compile(rb'"(?:[^"\\]|\\.)*"', re.DOTALL)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def parse(data: bytes, file: str) -> Node:
    """Parse a JSON text as UTF-8, with or without a byte order mark.

    Raises
    ------
    InputError
        It exceeds 64 MB or a depth of 256, is not UTF-8 or not JSON, or has a number that is not finite.
    """
    if len(data) > MAX_BYTES:
        raise input_error(file, f"is larger than {MAX_BYTES >> 20} MB; split the tileset")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if _depth(data) > DEEPEST:
        raise input_error(file, f"has more than {DEEPEST} JSON arrays or objects in one another")
    try:
        value = json.loads(data.decode("utf-8"), parse_constant=_no_constant)
    except UnicodeDecodeError as error:
        raise input_error(file, f"is not UTF-8 (byte {error.start + 1})") from error
    except json.JSONDecodeError as error:
        raise input_error(file, f"is not JSON: {error.msg}", line=error.lineno, column=error.colno) from error
    except (ValueError, RecursionError) as error:  # a constant; a number of too many digits
        raise input_error(file, f"is not JSON: {error}") from error
    return Node(value, file, "$")


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")


def _depth(data: bytes) -> int:
    """Compute the nesting depth of arrays and objects; 0 if it cannot exceed the limit."""
    if data.count(b"[") + data.count(b"{") <= DEEPEST:
        return 0
    text = np.frombuffer(_TEXT.sub(b"", data), np.uint8)
    opens = (text == ord("[")) | (text == ord("{"))
    closes = (text == ord("]")) | (text == ord("}"))
    return int(np.cumsum(opens.astype(np.int64) - closes).max(initial=0))


class Node:
    """A value of a JSON text, with its JSON path."""

    __slots__ = ("_above", "_path", "file", "value")

    def __init__(self, value: Any, file: str, path: str, above: Node | None = None) -> None:
        self.value, self.file, self._path, self._above = value, file, path, above

    @property
    def path(self) -> str:
        """JSON path, composed on demand."""
        if self._above is not None:
            name = self._path if _NAME.fullmatch(self._path) else f"[{self._path[:80]!r}]"
            dot = "." if name == self._path else ""
            self._path, self._above = f"{self._above.path}{dot}{name}", None
        return self._path

    def error(self, reason: str) -> InputError:
        """Make an InputError with file and JSON path."""
        return input_error(self.file, f"{self.path}: {reason}")

    def __contains__(self, name: str) -> bool:
        return isinstance(self.value, dict) and name in self.value

    def get(self, *names: str) -> Node | None:
        """Return the member by the first of these names that exists; None without one."""
        value = self.value
        if type(value) is not dict:
            raise self.error("must be an object")
        for name in names:
            found = value.get(name)
            if found is not None:
                return Node(found, self.file, name, self)
        return None

    def need(self, *names: str) -> Node:
        """Return the member by the first of these names that exists.

        Raises
        ------
        InputError
            There is none.
        """
        found = self.get(*names)
        if found is None:
            raise self.error(f"{names[0]} is missing")
        return found

    def object(self) -> dict[str, Any]:
        """Return the value, which must be an object."""
        if not isinstance(self.value, dict):
            raise self.error("must be an object")
        return self.value

    def items(self) -> Iterator[Node]:
        """List the elements of the value, which must be an array."""
        if not isinstance(self.value, list):
            raise self.error("must be an array")
        path = self.path
        return (Node(each, self.file, f"{path}[{i}]") for i, each in enumerate(self.value))

    def text(self) -> str:
        """Return the value, which must be a string."""
        if not isinstance(self.value, str):
            raise self.error("must be a string")
        return self.value

    def number(self) -> float:
        """Return the value, which must be a finite number."""
        if not _finite(self.value):
            raise self.error("must be a finite number")
        return float(self.value)

    def index(self, most: int, least: int = 0) -> int:
        """Return the value, which must be a whole number from `least` to `most`."""
        value = self.value
        whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
        if isinstance(value, bool) or not whole or not least <= value <= most:
            raise self.error(f"must be a whole number from {least} to {most:,}, not {str(value)[:40]}")
        return int(value)

    def numbers(self, count: int) -> list[float]:
        """Return the value, which must be `count` finite numbers."""
        value = self.value
        if type(value) is not list or len(value) != count:
            raise self.error(f"must be {count} numbers")
        if not all(map(_finite, value)):
            raise self.error(f"must be {count} finite numbers")
        return list(map(float, value))


def _finite(value: Any) -> bool:
    kind = type(value)  # bool is a subclass of int
    if kind is not float and kind is not int:
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond every float
        return False
