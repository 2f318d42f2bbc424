"""CSV tables: column names of a file, and its rows by meaning."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from ...run import tables


def columns(head: bytes) -> set[str]:
    """Return the column names in the first line of a CSV, in lower case; empty if it is not text."""
    line = "\n".join(head.decode("utf-8-sig", "replace").splitlines()[:1]).strip()
    if not line or line[0] in "{[" or "\0" in line:
        return set()
    return set(column_names(line))


def column_names(line: str) -> dict[str, str]:
    """Map column names of a first line, in lower case and without a unit in brackets, to their spelling."""
    comma = max(",;\t", key=line.count)
    found = next(csv.reader([line], delimiter=comma), [])
    return {name.partition("(")[0].partition("[")[0].strip().lower(): name.strip() for name in found}


def read_header(path: Path) -> dict[str, str]:
    """Map column names of a file, in lower case, to their spelling."""
    with path.open(encoding="utf-8-sig") as file:
        return column_names(tables.read_header(path, file).strip())


def rows(
    path: Path, names: Mapping[str, set[str]], needed: Collection[str], help: str
) -> Iterator[tuple[int, dict[str, str]]]:
    """Iterate over rows: line number, and values by meaning, as in `run.tables.rows`."""
    with path.open(encoding="utf-8-sig", newline=None) as file:
        yield from tables.rows(path, iter(file), names, needed, help)
