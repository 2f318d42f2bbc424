"""Height of the geoid above the WGS84 ellipsoid, from a grid of EGM96 on this machine.

EGM96 is the geoid of most elevation models (Lemoine et al. 1998, NASA/TP-1998-206861). Its grid of 4 MB comes
with PROJ and GeographicLib, not with Firetwin. Heights are interpolated bilinearly.
"""

from __future__ import annotations

import os
import re
import struct
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core import geo
from numpy.typing import ArrayLike, NDArray

from ..errors import input_error

Array = NDArray[np.float64]
REMEDY = (
    "this machine has no grid of EGM96: write the geoid's height as a number (m; -24.9 at the King Fire), or "
    "install egm96_15.gtx of PROJ (Debian: proj-data) or egm96-5.pgm of GeographicLib; folders named by "
    "PROJ_DATA or GEOGRAPHICLIB_GEOID_PATH are searched too"
)
_PROJ = ("egm96_15.gtx",)
_GEOGRAPHICLIB = ("egm96-5.pgm", "egm96-15.pgm")
_SHARES = ("/usr/share", "/usr/local/share", "/opt/homebrew/share")
_HEADER = struct.Struct(">4d2i")  # of .gtx: first latitude, longitude, their steps, rows, columns
_STEP = 1.0e4  # m, over which the slope is measured


@dataclass(frozen=True)
class Geoid:
    """Heights of a geoid above the ellipsoid on a global grid.

    Attributes
    ----------
    value
        (ny, nx) heights as stored.
    first, step
        Latitude and longitude of the first point, and degrees from row to row and column to column.
    scale, offset
        m of a stored unit, and m added.
    """

    value: NDArray
    first: tuple[float, float]
    step: tuple[float, float]
    scale: float = 1.0
    offset: float = 0.0

    def height(self, latitude: ArrayLike, longitude: ArrayLike) -> Array:
        """Interpolate heights above the ellipsoid, m, at places in degrees."""
        rows, columns = self.value.shape
        row = np.clip((np.asarray(latitude, float) - self.first[0]) / self.step[0], 0, rows - 1)
        column = (np.asarray(longitude, float) - self.first[1]) / self.step[1]
        y, x = np.minimum(row.astype(int), rows - 2), np.floor(column).astype(int)
        v, u = row - y, column - x
        at = [
            [self.value[y + i, (x + j) % columns].astype(float) * self.scale + self.offset for j in (0, 1)]
            for i in (0, 1)
        ]
        (low, east), (north, far) = at
        return (1.0 - v) * ((1.0 - u) * low + u * east) + v * ((1.0 - u) * north + u * far)

    def plane(self, frame: geo.LocalFrame) -> tuple[float, float, float]:
        """Compute the height at a frame's origin, m, and its rise per metre to the east and north."""
        ways = np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)]) * _STEP
        latitude, longitude, _ = frame.reverse(np.column_stack([ways, np.zeros(len(ways))]))
        middle, *sides = self.height(latitude, longitude).tolist()
        return middle, (sides[0] - sides[1]) / (2.0 * _STEP), (sides[2] - sides[3]) / (2.0 * _STEP)


def find() -> Geoid | None:
    """Find and read a grid of EGM96 on this machine; None without one.

    Raises
    ------
    InputError
        The file is damaged.
    """
    path = next(filter(Path.is_file, _candidates()), None)
    return read(path) if path else None


def read(path: Path) -> Geoid:
    """Read a grid of PROJ (.gtx) or GeographicLib (.pgm).

    Raises
    ------
    InputError
        The file is damaged, or its grid is not global.
    """
    try:
        found = _gtx(path) if path.suffix == ".gtx" else _pgm(path)
    except (OSError, ValueError, LookupError, TypeError, struct.error) as error:
        raise input_error(path, f"is not a geoid grid ({error}); install it again") from None
    if abs(found.value.shape[1] * found.step[1] - 360.0) > 1.0e-6:
        raise input_error(path, "is not a global grid; install the complete grid")
    return found


def _gtx(path: Path) -> Geoid:
    """Read GTX, the format of NOAA's VDatum: rows from the south, float32, big-endian."""
    with path.open("rb") as stream:
        south, west, up, across, rows, columns = _HEADER.unpack(stream.read(_HEADER.size))
    value = np.memmap(path, ">f4", "r", _HEADER.size, (rows, columns))
    return Geoid(value, (south, west), (up, across))


def _pgm(path: Path) -> Geoid:
    """Read GeographicLib's "Geoid height" format: from the North Pole and Greenwich, 16 bits, big-endian."""
    with path.open("rb") as stream:
        head = stream.read(4096)
    found = re.match(rb"P5\s(?:#[^\n]*\n)*\s*(\d+)\s+(\d+)\s+65535\s", head)
    if not found:
        raise ValueError("not as GeographicLib writes it")
    about = dict(re.findall(r"^# (Offset|Scale)\s+(\S+)$", found[0].decode("latin-1"), re.MULTILINE))
    columns, rows = int(found[1]), int(found[2])
    value = np.memmap(path, ">u2", "r", found.end(), (rows, columns))
    step = -180.0 / (rows - 1), 360.0 / columns
    return Geoid(value, (90.0, 0.0), step, float(about["Scale"]), float(about["Offset"]))


def _candidates() -> Iterator[Path]:
    """List possible files by the variables and folders of PROJ and GeographicLib."""
    named = [part for key in ("PROJ_DATA", "PROJ_LIB") for part in os.environ.get(key, "").split(os.pathsep)]
    usual = [f"{share}/proj" for share in (*_SHARES, f"{sys.prefix}/share", f"{sys.prefix}/Library/share")]
    for folder in filter(None, (*named, *usual)):
        yield from (Path(folder, name) for name in _PROJ)
    own = os.environ.get("GEOGRAPHICLIB_DATA", "")
    folders = [os.environ.get("GEOGRAPHICLIB_GEOID_PATH", ""), f"{own}/geoids" if own else ""]
    folders += [
        *(f"{share}/GeographicLib/geoids" for share in _SHARES),
        "C:/ProgramData/GeographicLib/geoids",
    ]
    for folder in filter(None, folders):
        yield from (Path(folder, name) for name in _GEOGRAPHICLIB)
