"""CSV of stations: of the user, of a county, or of a federal service, with any usual column names."""

from __future__ import annotations

import csv
from pathlib import Path

from ...errors import input_error
from .. import import_rows
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch
from . import column_names, drafts, positions, tables

NAME, ORDER = "CSV of stations", 70


def sniff(path: Path, head: bytes) -> bool:
    """Return True for a table with at least two columns."""
    return len(tables.columns(head)) > 1


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read all stations; their origin is ``user``, unless a column gives another.

    Raises
    ------
    InputError
        A column is missing, or the reference system is unknown.
    """
    header = list(tables.read_header(path).values())
    column_of = column_names.find_columns(path, header, options.columns)
    column_names.check_needed(path, header, column_of, position=True)
    batch = Batch(name=path.stem, dropped=import_rows.private_columns(header))
    in_degrees = {"latitude", "longitude"} <= set(column_of)
    if in_degrees and not {"x", "y"} & set(options.columns):
        column_of = {meaning: name for meaning, name in column_of.items() if meaning not in ("x", "y")}
        x, y = column_of["longitude"], column_of["latitude"]
    else:
        column_of = {
            meaning: name for meaning, name in column_of.items() if meaning not in ("latitude", "longitude")
        }
        x, y = column_of["x"], column_of["y"]
    rows = []
    try:
        with path.open(encoding="utf-8-sig", newline=None) as file:
            first = file.readline()
            comma = max(",;\t", key=first.count)
            names = [name.strip() for name in next(csv.reader([first], delimiter=comma), [])]
            reader = csv.reader(file, delimiter=comma)
            for values in reader:
                if any(each.strip() for each in values):
                    row = dict(zip(names, values, strict=False))
                    line = reader.line_num + 1
                    draft = drafts.make_draft(path, batch, row.get, column_of, f"line {line}")
                    rows.append(positions.Row(row.get(x), row.get(y), draft))
    except csv.Error as error:
        raise input_error(path, f"not a CSV file: {error}") from None
    positions.add_rows(path, batch, rows, options.crs)
    batch.notes += drafts.describe_columns(column_of)
    return batch
