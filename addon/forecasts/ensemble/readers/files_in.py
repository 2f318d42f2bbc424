"""Files that a user names: files, the files in folders, the files of members, and tables of members."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import TypeVar

from ....errors import input_error, reading
from ....files import check_text_size

Key = TypeVar("Key", str, int)


def files_in(paths: Iterable[Path]) -> list[Path]:
    """Collect these files and the files in these folders, in the order of their names."""
    inner = [sorted(path.iterdir()) if path.is_dir() else [path] for path in paths]
    return [each for files in inner for each in files if each.is_file()]


def add_member(files: dict[Key, Path], key: Key, path: Path) -> None:
    """Add the file of a member.

    Raises
    ------
    InputError
        A file of another folder is the same member.
    """
    other = files.setdefault(key, path)
    if other.absolute() != path.absolute():
        raise input_error(path, f"is the same member as {other}; convert one folder, or rename a file")


def read_table(path: Path, columns: tuple[str, ...]) -> list[tuple[int, list[str]]]:
    """Read columns of a CSV file, by the beginnings of their names in lower case: number of line, and words.

    Raises
    ------
    InputError
        The file has no such columns, or a line is too short.
    """
    with reading(path):
        check_text_size(path)
        with path.open(encoding="utf-8", newline="") as file:
            lines = [(number, row) for number, row in enumerate(csv.reader(file), 1) if row]
    names = [name.strip().lower() for name in lines[0][1]] if lines else []
    at = [next((i for i, name in enumerate(names) if name.startswith(key)), -1) for key in columns]
    if min(at) < 0:
        raise input_error(path, f"has no columns {', '.join(columns)}", line=1)
    for number, row in lines[1:]:
        if len(row) <= max(at):
            raise input_error(path, f"has no numbers {', '.join(columns)}", line=number)
    return [(number, [row[i].strip() for i in at]) for number, row in lines[1:]]
