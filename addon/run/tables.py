"""Text tables: a header line, then rows with commas, semicolons or tabs between values."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from ..errors import input_error

_HEADER = 100_000  # characters


def read_header(path: Path, lines: Iterator[str]) -> str:
    """Read the first line of a table.

    Raises
    ------
    InputError
        It is longer than any line of names.
    """
    header = next(lines, "")
    if len(header) > _HEADER:
        reason = f"its first line has {len(header):,} characters; name the columns in it"
        raise input_error(path, reason, line=1)
    return header


def rows(
    path: Path, lines: Iterator[str], names: Mapping[str, set[str]], needed: Collection[str], help: str
) -> Iterator[tuple[int, dict[str, str]]]:
    """Read non-empty rows: line number, and values by the meaning of their column.

    Parameters
    ----------
    names
        Accepted column names in lower case, by meaning; a unit in brackets is ignored.
    needed
        Required meanings.
    help
        Ends the error message about a missing column.

    Raises
    ------
    InputError
        A column is missing, or the file is no such table.
    """
    header = read_header(path, lines)
    comma = max(",;\t", key=header.count)
    try:
        columns = _columns(next(csv.reader([header], delimiter=comma), []), names)
        for what in needed:
            if what not in columns:
                raise input_error(path, f"the first line names no column {what}; name {help}", line=1)
        reader = csv.reader(lines, delimiter=comma)
        for row in reader:
            if any(text.strip() for text in row):
                yield reader.line_num + 1, {n: row[k] if k < len(row) else "" for n, k in columns.items()}
    except csv.Error as error:
        raise input_error(path, f"not a CSV file: {error}") from None


def _columns(header: list[str], names: Mapping[str, set[str]]) -> dict[str, int]:
    """Index of the first column of each meaning in the header."""
    plain = [name.partition("(")[0].partition("[")[0].strip().lower() for name in header]
    known = {what: next((k for k, n in enumerate(plain) if n in of), -1) for what, of in names.items()}
    return {what: k for what, k in known.items() if k >= 0}
