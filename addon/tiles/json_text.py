"""JSON of others, read within limits; errors name the file and the JSON path."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from typing import Any, NoReturn

import numpy as np

from ..errors import InputError, input_error

MOST_BYTES = 64 << 20  # of one text
DEEPEST = 256  # arrays and objects in one another

_TEXT = re.compile(rb'"(?:[^"\\]|\\.)*"', re.DOTALL)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def parse(data: bytes, file: str) -> Node:
    """Parse a JSON text as UTF-8, with or without a byte order mark.

    Raises
    ------
    InputError
        It is larger than 64 MB, deeper than 256, not UTF-8, not JSON, or has a number that is not finite.
    """
    if len(data) > MOST_BYTES:
        raise input_error(file, 0, 0, f"is larger than {MOST_BYTES >> 20} MB; split the tileset")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if _depth(data) > DEEPEST:
        raise input_error(file, 0, 0, f"has more than {DEEPEST} JSON arrays or objects in one another")
    try:
        value = json.loads(data.decode("utf-8"), parse_constant=_no_constant)
    except UnicodeDecodeError as error:
        raise input_error(file, 0, 0, f"is not UTF-8 (byte {error.start + 1})") from error
    except json.JSONDecodeError as error:
        raise input_error(file, error.lineno, error.colno, f"is not JSON: {error.msg}") from error
    except (ValueError, RecursionError) as error:  # a constant; a number of too many digits
        raise input_error(file, 0, 0, f"is not JSON: {error}") from error
    return Node(value, file, "$")


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number of JSON")


def _depth(data: bytes) -> int:
    """Most arrays and objects in one another; 0 where there cannot be too many."""
    if data.count(b"[") + data.count(b"{") <= DEEPEST:
        return 0
    text = np.frombuffer(_TEXT.sub(b"", data), np.uint8)
    opens = (text == ord("[")) | (text == ord("{"))
    closes = (text == ord("]")) | (text == ord("}"))
    return int(np.cumsum(opens.astype(np.int64) - closes).max(initial=0))


class Node:
    """A value of a JSON text, with its place."""

    __slots__ = ("file", "path", "value")

    def __init__(self, value: Any, file: str, path: str) -> None:
        self.value, self.file, self.path = value, file, path

    def error(self, reason: str) -> InputError:
        """InputError with file and JSON path."""
        return input_error(self.file, 0, 0, f"{self.path}: {reason}")

    def __contains__(self, name: str) -> bool:
        return isinstance(self.value, dict) and name in self.value

    def get(self, *names: str) -> Node | None:
        """Member by the first of these names that is there; None without one."""
        self.object()
        for name in names:
            if self.value.get(name) is not None:
                return self._member(name)
        return None

    def need(self, *names: str) -> Node:
        """Member by the first of these names that is there.

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
        """The value, which must be an object."""
        if not isinstance(self.value, dict):
            raise self.error("must be an object")
        return self.value

    def items(self) -> Iterator[Node]:
        """Elements of the value, which must be an array."""
        if not isinstance(self.value, list):
            raise self.error("must be an array")
        return (Node(each, self.file, f"{self.path}[{i}]") for i, each in enumerate(self.value))

    def text(self) -> str:
        """The value, which must be a string."""
        if not isinstance(self.value, str):
            raise self.error("must be a string")
        return self.value

    def number(self) -> float:
        """The value, which must be a finite number."""
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not _finite(value):
            raise self.error("must be a finite number")
        return float(value)

    def index(self, most: int, least: int = 0) -> int:
        """The value, which must be a whole number from `least` to `most`."""
        value = self.value
        whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
        if isinstance(value, bool) or not whole or not least <= value <= most:
            raise self.error(f"must be a whole number from {least} to {most:,}, not {str(value)[:40]}")
        return int(value)

    def numbers(self, count: int) -> list[float]:
        """The value, which must be `count` finite numbers."""
        value = self.value
        if not isinstance(value, list) or len(value) != count:
            raise self.error(f"must be {count} numbers")
        for each in value:
            if isinstance(each, bool) or not isinstance(each, int | float) or not _finite(each):
                raise self.error(f"must be {count} finite numbers")
        return [float(each) for each in value]

    def _member(self, name: str) -> Node:
        path = f"{self.path}.{name}" if _NAME.fullmatch(name) else f"{self.path}[{name[:80]!r}]"
        return Node(self.value[name], self.file, path)


def _finite(value: int | float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond every float
        return False
