"""Tables of text: a line of names, then one for each row, with commas, semicolons or tabs between values."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from ..errors import input_error


def rows(
    path: Path, lines: Iterator[str], names: Mapping[str, set[str]], needed: Collection[str], help: str
) -> Iterator[tuple[int, dict[str, str]]]:
    """Number of the line, and values by what they are, of each row that holds anything.

    Parameters
    ----------
    names
        Names that a column may have, small letters, by what is in it; a unit in brackets is no part of one.
    needed
        What there must be columns of.
    help
        Ends the message where there are none.

    Raises
    ------
    InputError
        A column lacks, or it is no such table.
    """
    header = next(lines, "")
    comma = max(",;\t", key=header.count)
    try:
        columns = _columns(next(csv.reader([header], delimiter=comma), []), names)
        for what in needed:
            if what not in columns:
                raise input_error(path, 1, 0, f"the first line names no column {what}; name {help}")
        reader = csv.reader(lines, delimiter=comma)
        for row in reader:
            if any(text.strip() for text in row):
                yield reader.line_num + 1, {n: row[k] if k < len(row) else "" for n, k in columns.items()}
    except csv.Error as error:
        raise input_error(path, 0, 0, f"is no CSV: {error}") from None


def _columns(header: list[str], names: Mapping[str, set[str]]) -> dict[str, int]:
    """Number of the first column of each kind that is there."""
    plain = [name.partition("(")[0].partition("[")[0].strip().lower() for name in header]
    known = {what: next((k for k, n in enumerate(plain) if n in of), -1) for what, of in names.items()}
    return {what: k for what, k in known.items() if k >= 0}
