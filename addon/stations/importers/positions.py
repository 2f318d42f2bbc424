"""Positions of a table in degrees: from degrees, Web Mercator, or a reference system that the user names."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...errors import input_error
from ...run.observations.projection import to_degrees
from .. import import_rows
from ..import_rows import Batch, Draft

WEB_MERCATOR = "EPSG:3857"
_EDGE = 20_037_509.0  # m, half the width of Web Mercator
_AMERICA = -3.0e6
"""Limit of x (m) below which coordinates are Web Mercator: UTM, state planes and Albers' grids of North
America (EPSG:5070 begins at -2.4e6) have larger values."""


class Row(NamedTuple):
    """Coordinates of a row as in the file, and its station."""

    x: Any
    y: Any
    draft: Draft


def add_rows(path: Path, batch: Batch, rows: Sequence[Row], crs: str) -> None:
    """Add stations of a table to a batch.

    If most coordinates are in degrees, all are; otherwise they are in `crs`, or in Web Mercator if this is
    certain.

    Raises
    ------
    InputError
        The reference system is unknown.
    """
    numbers = [_numbers(row) for row in rows]
    pairs = [each for each in numbers if each is not None]
    beyond = [each for each in pairs if not _is_degrees(*each)]
    if 2 * len(beyond) <= len(pairs):
        for row in rows:
            import_rows.add(batch, row.y, row.x, row.draft)
        return
    system = crs or _guess(path, beyond)
    if not crs:
        batch.notes.append(f"coordinates are read as Web Mercator ({WEB_MERCATOR}) for their size; see --crs")
    degrees = iter(to_degrees(path, system, np.array(pairs)).tolist())
    for row, each in zip(rows, numbers, strict=True):
        longitude, latitude = (None, None) if each is None else next(degrees)
        import_rows.add(batch, latitude, longitude, row.draft)


def _numbers(row: Row) -> tuple[float, float] | None:
    try:
        x, y = float(row.x), float(row.y)
    except (TypeError, ValueError, OverflowError):
        return None
    return (x, y) if math.isfinite(x) and math.isfinite(y) and (x, y) != (0.0, 0.0) else None


def _is_degrees(x: float, y: float) -> bool:
    return abs(x) <= 180.0 and abs(y) <= 90.0


def _guess(path: Path, beyond: Sequence[tuple[float, float]]) -> str:
    if all(-_EDGE <= x <= _AMERICA and abs(y) <= _EDGE for x, y in beyond):
        return WEB_MERCATOR
    x, y = beyond[0]
    raise input_error(
        path,
        f"has coordinates such as {x:.10g}, {y:.10g}, which are not degrees; name their reference system, "
        "such as --crs EPSG:26910 (UTM zone 10 north, NAD83) or --crs EPSG:3857 (Web Mercator)",
    )
