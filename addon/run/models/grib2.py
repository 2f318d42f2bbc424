"""Fields of weather models in GRIB2, such as HRRR: read by GDAL, placed on their projected grid.

HRRR has a Lambert grid of 3 km on a sphere of 6371229 m; degrees on this sphere are taken as they are, as
the model does. GDAL gives element, level, unit and times of each band, but not whether wind follows the axes
of the grid: flag 0x08 of section 3 does (WMO Manual on Codes, flag table 3.3).
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Collection
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error, reading, refuse_odd
from . import heartbeat, optional_packages

Array = NDArray[np.float64]
Box = tuple[float, float, float, float]
"""South, west, north and east, degrees."""

_MARGIN = 2  # cells around a box
_STEP = 1e-3  # degrees, step towards east in which the turn of the axes is measured


@dataclass(frozen=True, eq=False)
class GribField:
    """Field (ny, nx) at x (nx,) and y (ny,), m, around a box; NaN without data.

    Attributes
    ----------
    element, level, unit
        As in GRIB: ``MASSDEN``, ``8-HTGL``, ``kg/(m^3)``.
    issued, valid
        Issue time and valid time.
    largest
        Largest absolute value of the complete field.
    along_grid
        Wind components follow the axes of the grid, not east and north.
    """

    path: Path
    element: str
    level: str
    unit: str
    issued: datetime
    valid: datetime
    x: Array
    y: Array
    values: Array
    largest: float
    along_grid: bool
    projection: Any = field(repr=False)

    @cached_property
    def side(self) -> float:
        """Side of a cell, m."""
        return float(abs(self.x[1] - self.x[0]))

    def at(self, latitude: Array, longitude: Array) -> Array:
        """Interpolate bilinearly to places in degrees."""
        x, y = self.projection(longitude, latitude)
        column, row = ((at - axis[0]) / (axis[1] - axis[0]) for at, axis in ((x, self.x), (y, self.y)))
        j, i = (
            np.clip(np.floor(at), 0, n - 2).astype(np.int64)
            for at, n in ((column, len(self.x)), (row, len(self.y)))
        )
        a, b = column - j, row - i
        upper = self.values[i, j] * (1 - a) + self.values[i, j + 1] * a
        lower = self.values[i + 1, j] * (1 - a) + self.values[i + 1, j + 1] * a
        return upper * (1 - b) + lower * b

    def east_north(self, u: Array, v: Array, latitude: Array, longitude: Array) -> tuple[Array, Array]:
        """Turn wind at places from the axes of the grid to east and north, if it follows them."""
        if not self.along_grid:
            return u, v
        ends = [np.stack(self.projection(longitude + step, latitude)) for step in (-_STEP, _STEP)]
        cosine, sine = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
        return u * cosine + v * sine, v * cosine - u * sine


def is_grib(path: Path) -> bool:
    """Check for a GRIB file of edition 2 by its first bytes."""
    try:
        refuse_odd(path)
        with path.open("rb") as file:
            head = file.read(8)
    except OSError:
        return False
    return head[:4] == b"GRIB" and head[7:] == b"\2"


def read(paths: list[Path], elements: Collection[str], levels: Collection[str], box: Box) -> list[GribField]:
    """Read the fields of some elements and levels around a box, by valid time.

    Raises
    ------
    InputError
        A file is not GRIB2 or damaged, its grid is not projected or does not contain the box, or two fields
        have one valid time.
    """
    fields: list[GribField] = []
    for path in paths:
        heartbeat.sign()
        if not is_grib(path):
            raise input_error(path, "is not a GRIB2 file; give files such as hrrr.t21z.wrfsfcf03.grib2")
        with reading(path, "GRIB2 file"):
            fields += _fields(path, elements, levels, box)
    fields.sort(key=lambda each: (each.element, each.valid))
    for one, other in itertools.pairwise(fields):
        if (one.element, one.valid) == (other.element, other.valid):
            reason = f"has {one.element} for {one.valid:%Y-%m-%d %H:%M} UTC, as {one.path.name} has"
            raise input_error(other.path, f"{reason}; give one file for each valid time")
    return fields


def _fields(path: Path, elements: Collection[str], levels: Collection[str], box: Box) -> list[GribField]:
    rasterio = optional_packages.package("rasterio")
    pyproj = optional_packages.package("pyproj")
    fields = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(path, driver="GRIB") as source:
            if source.crs is None or not source.crs.is_projected:
                raise input_error(path, "is not on a projected grid; give fields of HRRR, which is Lambert")
            projection = pyproj.Proj(pyproj.CRS.from_wkt(source.crs.to_wkt()))
            rows, columns, x, y = _window(path, source, projection, box)
            along_grid = _along_grid(path)
            for band in source.indexes:
                tags = source.tags(band)
                element, level = tags.get("GRIB_ELEMENT", ""), tags.get("GRIB_SHORT_NAME", "")
                if element not in elements or level not in levels:
                    continue
                values = source.read(band).astype(np.float64)
                if source.nodata is not None:
                    values[values == source.nodata] = np.nan
                largest = float(np.nanmax(np.abs(values), initial=0.0))
                issued, valid = (_moment(path, tags, f"GRIB_{name}_TIME") for name in ("REF", "VALID"))
                unit = tags.get("GRIB_UNIT", "").strip("[]")
                values = values[rows, columns]
                made = GribField(
                    path, element, level, unit, issued, valid, x, y, values, largest, along_grid, projection
                )
                fields.append(made)
    return fields


def _window(path: Path, source: Any, projection: Any, box: Box) -> tuple[slice, slice, Array, Array]:
    """Return rows and columns around a box, and their x and y."""
    south, west, north, east = box
    along = np.linspace(0.0, 1.0, 17)
    latitude, longitude = (
        each.ravel() for each in np.meshgrid(south + (north - south) * along, west + (east - west) * along)
    )
    places = projection(longitude, latitude)
    parts, axes = [], []
    a, _, c, _, e, f = source.transform[:6]
    for at, first, step, count in ((places[1], f, e, source.height), (places[0], c, a, source.width)):
        index = (np.asarray(at) - first) / step - 0.5
        low, high = int(np.floor(index.min())) - _MARGIN, int(np.ceil(index.max())) + _MARGIN
        if not np.isfinite(index).all() or low < 0 or high >= count:
            raise input_error(path, "does not contain the grid of the run with two cells around it")
        parts.append(slice(low, high + 1))
        axes.append(first + step * (np.arange(low, high + 1) + 0.5))
    return parts[0], parts[1], axes[1], axes[0]


def _moment(path: Path, tags: dict[str, str], name: str) -> datetime:
    try:
        return datetime.fromtimestamp(int(tags[name].split()[0]), UTC)
    except (KeyError, IndexError, ValueError, OverflowError, OSError):
        raise input_error(path, f"has no time {name}; it is damaged") from None


def _along_grid(path: Path) -> bool:
    """Read from section 3 whether wind follows the axes of a Lambert grid (template 3.30)."""
    with path.open("rb") as file:
        at = 16
        for _ in range(3):  # sections 1 to 3; section 2 may be missing
            file.seek(at)
            head = file.read(64)
            if len(head) < 64:
                break
            if head[4] == 3:
                if int.from_bytes(head[12:14], "big") != 30:
                    break
                return bool(head[46] & 0x08)
            at += int.from_bytes(head[:4], "big")
    raise input_error(path, "is not on a Lambert grid; give fields of HRRR")
