"""Text of tables: the columns that a file names, and its rows by their meaning."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from ...run import tables


def columns(head: bytes) -> set[str]:
    """Names of the columns in the first line of a CSV, in lower case; none of what is no text."""
    line = "\n".join(head.decode("utf-8-sig", "replace").splitlines()[:1]).strip()
    if not line or line[0] in "{[" or "\0" in line:
        return set()
    return set(named(line))


def named(line: str) -> dict[str, str]:
    """Names of the columns of a first line, by their name in lower case without a unit in brackets."""
    comma = max(",;\t", key=line.count)
    found = next(csv.reader([line], delimiter=comma), [])
    return {name.partition("(")[0].partition("[")[0].strip().lower(): name.strip() for name in found}


def header(path: Path) -> dict[str, str]:
    """Names of the columns of a file, by their name in lower case."""
    with path.open(encoding="utf-8-sig") as file:
        return named(file.readline().strip())


def rows(
    path: Path, names: Mapping[str, set[str]], needed: Collection[str], help: str
) -> Iterator[tuple[int, dict[str, str]]]:
    """Rows of a file: number of the line, and values by their meaning, as `run.tables.rows`."""
    with path.open(encoding="utf-8-sig", newline=None) as file:
        yield from tables.rows(path, iter(file), names, needed, help)
