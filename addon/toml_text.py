"""TOML texts: values by tomllib, and the line and column of each key for error messages."""

from __future__ import annotations

import re
import tomllib
from os import PathLike
from typing import Any

from .errors import InputError, input_error

Where = tuple[str | int, ...]

_PARTS = 8
_DOTS = re.compile(rf"(?:\.[^.\n]*){{{_PARTS}}}")
_TOKEN = re.compile(
    r'"""(?:[^\\]|\\.)*?(?:"{3,5}|\Z)|\'\'\'.*?(?:\'{3,5}|\Z)'
    r'|"(?:[^"\\\n]|\\.)*"?|\'[^\'\n]*\'?|#[^\n]*|[.\n=,]',
    re.DOTALL,
)

_GAP = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_BASIC = re.compile(r'"(?:[^"\\]|\\.)*"')
_LITERAL = re.compile(r"'[^']*'")
_LONG_BASIC = re.compile(r'"""(?:[^\\]|\\.)*?"{3,5}', re.DOTALL)
_LONG_LITERAL = re.compile(r"'''.*?'{3,5}", re.DOTALL)
_PLAIN = re.compile(r"[^,\]}#\n]+")


class _Scan:
    """Scanner of a text that tomllib has accepted; it does not validate."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.offsets: dict[Where, int] = {}
        self.spans: list[tuple[Where, int, int]] = [((), 0, 0)]
        self._tables: dict[Where, int] = {}  # tables in each array of tables up to here

    def document(self) -> None:
        table: Where = ()
        self._skip()
        while self.at < len(self.text):
            start = self.at
            if self.text[start] == "[":
                array = self.text.startswith("[[", start)
                table = self._header(1 + array, array)
                self.spans.append((table, start, self.at))
            else:
                self._pair(table)
                self.spans[-1] = (*self.spans[-1][:2], self.at)
            self._skip()

    def _skip(self) -> None:
        self._take(_GAP)

    def _take(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self.text, self.at)
        assert match
        self.at = match.end()
        return match.group()

    def _name(self) -> str:
        if self.text[self.at] == '"':
            return tomllib.loads(f"key = {self._take(_BASIC)}")["key"]
        if self.text[self.at] == "'":
            return self._take(_LITERAL)[1:-1]
        return self._take(_BARE)

    def _key(self, table: Where) -> Where:
        """Read a dotted key and record the position of each part."""
        path = table
        while True:
            start = self.at
            path = (*path, self._name())
            self.offsets.setdefault(path, start)
            self._skip()
            if self.text[self.at] != ".":
                return path
            self.at += 1
            self._skip()

    def _inside(self, path: Where) -> Where:
        """Resolve the name of an array of tables to its last table."""
        return (*path, self._tables[path] - 1) if path in self._tables else path

    def _header(self, brackets: int, array: bool) -> Where:
        self.at += brackets
        start = self.at
        self._skip()
        names = [self._name()]
        self._skip()
        while self.text[self.at] == ".":
            self.at += 1
            self._skip()
            names.append(self._name())
            self._skip()
        self.at += brackets
        path: Where = ()
        for name in names[:-1]:
            path = self._inside((*path, name))
        path = (*path, names[-1])
        self.offsets.setdefault(path, start)
        if array:
            self._tables[path] = self._tables.get(path, 0) + 1
            path = self._inside(path)
            self.offsets[path] = start
        return path

    def _pair(self, table: Where) -> None:
        path = self._key(table)
        self.at += 1  # the equals sign
        self._skip()
        self._value(path)

    def _value(self, path: Where) -> None:
        text, at = self.text, self.at
        if text.startswith('"""', at):
            self._take(_LONG_BASIC)
        elif text.startswith("'''", at):
            self._take(_LONG_LITERAL)
        elif text[at] == '"':
            self._take(_BASIC)
        elif text[at] == "'":
            self._take(_LITERAL)
        elif text[at] == "[":
            self._array(path)
        elif text[at] == "{":
            self._inline_table(path)
        else:
            self._take(_PLAIN)

    def _array(self, path: Where) -> None:
        self.at += 1
        self._skip()
        index = 0
        while self.text[self.at] != "]":
            self.offsets[(*path, index)] = self.at
            self._value((*path, index))
            index += 1
            self._next()
        self.at += 1

    def _inline_table(self, path: Where) -> None:
        self.at += 1
        self._skip()
        while self.text[self.at] != "}":
            self._pair(path)
            self._next()
        self.at += 1

    def _next(self) -> None:
        self._skip()
        if self.text[self.at] == ",":
            self.at += 1
            self._skip()


def loads(path: str | PathLike[str], text: str) -> dict[str, Any]:
    """Parse TOML as if it were the file `path`.

    Raises
    ------
    InputError
        It is not valid TOML, or a key has more than eight parts: tomllib's time grows with their square.
    """
    if _DOTS.search(text):
        _check_keys(path, text)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _syntax_error(path, text, str(error)) from None


def _check_keys(path: str | PathLike[str], text: str) -> None:
    dots = 0
    for token in _TOKEN.finditer(text):
        dots = dots + 1 if token[0] == "." else 0 if token[0] in "\n=," else dots
        if dots == _PARTS:
            line, column = _line_and_column(text, token.start())
            reason = "has a key of more than eight parts; write keys like units.elevation"
            raise input_error(path, reason, line=line, column=column)


def _syntax_error(path: str | PathLike[str], text: str, message: str) -> InputError:
    """Syntax error; tomllib's messages end in "(at line 3, column 7)" or "(at end of document)"."""
    match = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    reason = re.sub(r" \(at .*\)$", "", message)
    line, column = (int(match[1]), int(match[2])) if match else (max(1, len(text.splitlines())), 0)
    remedy = "; write / in place of \\" if re.match(r"Unescaped|Invalid hex", reason) else ""  # C:\Users
    reason = f"not valid TOML: {reason[:1].lower()}{reason[1:]}{remedy}"
    return input_error(path, reason, line=line, column=column)


def places(text: str) -> dict[Where, tuple[int, int]]:
    """Line and column (1-based) of every key and array element in a valid TOML text.

    A path is the names and indices that lead to a value: ``("cameras", 0, "keys", 2, "at")``.
    """
    scan = _Scan(text)
    scan.document()
    return {path: _line_and_column(text, offset) for path, offset in scan.offsets.items()}


def place(text: str, where: Where) -> tuple[int, int]:
    """Line and column (1-based) of a key, or of the nearest enclosing table; (0, 0) without one."""
    scan = _Scan(text)
    scan.document()
    while where and where not in scan.offsets:
        where = where[:-1]
    return _line_and_column(text, scan.offsets[where]) if where else (0, 0)


def tables(text: str) -> list[tuple[Where, int, int]]:
    """Tables of a valid TOML text in order: path, offset of the header, and offset after the last value.

    The first one holds the keys above all headers.
    """
    scan = _Scan(text)
    scan.document()
    return scan.spans


def _line_and_column(text: str, offset: int) -> tuple[int, int]:
    return text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)
