"""GRIB2 files on the Lambert grid of HRRR, written by GDAL with known values."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

LAMBERT = "+proj=lcc +lat_1=38.5 +lat_2=38.5 +lat_0=38.5 +lon_0=-97.5 +R=6371229 +units=m"
ISSUED = datetime(2014, 9, 17, 0, tzinfo=UTC)
CENTRE = 38.78, -120.6  # degrees
SIDE = 3000.0
CELLS = 40
PARAMETERS = {  # category and number of discipline 0, type and value of the level
    "MASSDEN": (20, 0, 103, 8),
    "COLMD": (20, 1, 10, 0),
    "MASSMR": (20, 2, 103, 8),
    "UGRD": (2, 2, 103, 10),
    "VGRD": (2, 3, 103, 10),
}
Values = Callable[[NDArray, NDArray], NDArray]
"""Values (ny, nx) from latitude and longitude (ny, nx), degrees."""


def write(path: Path, fields: dict[str, Values], hours: int = 0, along_grid: bool = True) -> Path:
    """Write one message for each field, valid `hours` after the issue time, around `CENTRE`."""
    import pyproj
    import rasterio
    from rasterio.transform import from_origin

    projection = pyproj.Proj(LAMBERT)
    x0, y0 = projection(CENTRE[1], CENTRE[0])
    half = SIDE * CELLS / 2
    axis = SIDE * (np.arange(CELLS) + 0.5) - half
    longitude, latitude = projection(*np.meshgrid(x0 + axis, y0 - axis), inverse=True)
    messages = b""
    for name, values in fields.items():
        category, number, kind, value = PARAMETERS[name]
        forecast, level = (list(each.to_bytes(4, "big")) for each in (hours, value))
        template = [category, number, 2, 0, 83, 0, 0, 0, 1, *forecast, kind, 0, *level, *[255] * 6]
        part = path.with_suffix(".part")
        with rasterio.open(
            part, "w", driver="GRIB", width=CELLS, height=CELLS, count=1, dtype="float64",
            crs=LAMBERT, transform=from_origin(x0 - half, y0 + half, SIDE, SIDE), IDS_CENTER=7,
            IDS_REF_TIME=f"{ISSUED:%Y-%m-%dT%H:%M:%SZ}", DISCIPLINE=0, PDS_PDTN=0,
            PDS_TEMPLATE_NUMBERS=" ".join(map(str, template)), DATA_ENCODING="IEEE_FLOATING_POINT",
        ) as file:  # fmt: skip
            file.write(np.broadcast_to(values(latitude, longitude), latitude.shape).astype(np.float64), 1)
        messages += _flagged(part.read_bytes(), along_grid)
        part.unlink()
    path.write_bytes(messages)
    return path


def _flagged(data: bytes, along_grid: bool) -> bytes:
    """Set the flag of wind along the axes of the grid, which HRRR has and GDAL does not write."""
    at = 16
    while data[at + 4] != 3:
        at += int.from_bytes(data[at : at + 4], "big")
    flags = data[at + 46] | 0x08 if along_grid else data[at + 46] & ~0x08
    return data[: at + 46] + bytes([flags]) + data[at + 47 :]


def valid(hours: float) -> datetime:
    """Return the valid time of a forecast hour."""
    return ISSUED + timedelta(hours=hours)
