"""Georeferenced rasters: GeoTIFF and other GDAL formats, ASCII grids, and LCP landscapes."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, input_error, reading
from ...files import read_text
from ...limits import SETTINGS_BYTES, UNPACKED_BYTES
from . import heartbeat, optional_packages
from .grid import Grid, project

_LARGEST = 1 << 29  # values
_PIECE = 1 << 24  # characters of an ASCII grid that are read at a time
_ROLES = {
    "arrival": r"time[ _]*of[ _]*arrival|arrival[ _]*time|arrival|toa",
    "intensity": r"fireline[ _]*intensity|flin|fli|intensity",
    "speed": r"spread[ _]*rate|rate[ _]*of[ _]*spread|ros|vs",
    "per_area": r"heat[ _]*per[ _]*unit[ _]*area|hpua",
    "elevation": r"dem|elev|elevation",
    "category": r"fbfm40|fbfm13|f40|f13|fuel[ _]*model",
    "bulk_density": r"cbd|canopy[ _]*bulk[ _]*density",
    "base_height": r"cbh|canopy[ _]*base[ _]*height",
    "height": r"ch|canopy[ _]*height",
}


@dataclass(frozen=True, eq=False)
class Raster:
    """Values (ny, nx) float32, NaN without data, at x (nx,) and y (ny,) of a projection ("" if unknown).

    `whole` is whether the file holds integers, which indicate units in LANDFIRE's files.
    """

    path: Path
    values: NDArray[np.float32]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    projection: str
    whole: bool = False

    def grid(self, projection: str, at: tuple[float, float] | None) -> tuple[Grid, str]:
        """Return the grid of the raster, and a note on assumptions about its georeference."""
        known = projection or self.projection
        if known:
            return Grid.projected(self.x, self.y, known), ""
        return local(self.x, self.y, at)

    def difference(self, other: Raster) -> str:
        """Say how the cells of two rasters differ by more than 1 % of a cell; empty if they do not.

        A raster without a projection is taken to have the other's.
        """
        axes = (self.x, other.x), (self.y, other.y)
        limit = 0.01 * min(float(np.abs(np.diff(axis)).min(initial=np.inf)) for _, axis in axes)
        if self.values.shape != other.values.shape or (
            max(float(np.abs(one - axis).max()) for one, axis in axes) > limit
        ):
            return f"has other cells than {other.path.name}"
        if self.projection and other.projection not in ("", self.projection):
            ends = self.x[[0, -1]], self.y[[0, -1]]
            x, y = _places(Grid.projected(*ends, other.projection), self.projection)
            if not max(np.abs(x - ends[0]).max(), np.abs(y - ends[1][:, None]).max()) <= limit:
                return f"has another coordinate system than {other.path.name}"
        return ""

    def on(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Resample to another grid by nearest neighbour, NaN outside."""
        x, y = _places(grid, self.projection or projection)
        column, row = _index(self.x, x), _index(self.y, y)
        inside = (column >= 0) & (column < len(self.x)) & (row >= 0) & (row < len(self.y))
        sampled = np.full(grid.shape, np.nan, np.float32)
        sampled[inside] = self.values[row[inside], column[inside]]
        return sampled


def local(x: NDArray, y: NDArray, at: tuple[float, float] | None) -> tuple[Grid, str]:
    """Create a grid in metres with its centre at a point, and a note about it."""
    place = at or (0.0, 0.0)
    grid = Grid.metres(x - (x[0] + x[-1]) / 2, y - (y[0] + y[-1]) / 2, place)
    said = "(--at)" if at else "(assumed); set it with --at LAT,LON or --projection EPSG:..."
    return (
        grid,
        f"a grid in metres without a projection: its centre is {place[0]:g}, {place[1]:g} {said}",
    )


@lru_cache(1)  # companion layers are looked up in turn, mostly in one projection
def _places(grid: Grid, projection: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Convert a grid's cells to x and y (ny, nx) in a projection."""
    latitude, longitude = grid.latitude, grid.longitude
    if latitude.ndim == 1:
        latitude, longitude = np.meshgrid(latitude, longitude, indexing="ij")
    return project(projection, latitude, longitude)


def _index(axis: NDArray, at: NDArray) -> NDArray[np.int64]:
    step = (axis[-1] - axis[0]) / max(len(axis) - 1, 1) or 1.0
    return np.rint(np.clip((at - axis[0]) / step, -9.0, 1e9)).astype(np.int64)


def role(path: Path) -> str:
    """Find the role of a raster by its name: a key of the table above, or empty."""
    stem = re.sub(r"\d{5,}", " ", path.stem.lower())
    for name, words in _ROLES.items():
        if re.search(rf"(?<![a-z])(?:{words})(?![a-z])", stem):
            return name
    return ""


def is_raster(path: Path) -> bool:
    """Check whether a file is a GeoTIFF or ASCII grid, by its first bytes, or BIL with a header."""
    try:
        with path.open("rb") as file:
            head = file.read(64)
    except OSError:
        return False
    if head[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
        return True
    return head[:5].lower() == b"ncols" or (path.suffix == ".bil" and path.with_suffix(".hdr").is_file())


def is_lcp(path: Path) -> bool:
    """Check whether a file has the header and size of an LCP (GDAL, lcpdataset.cpp)."""
    try:
        with path.open("rb") as file:
            head = np.frombuffer(file.read(12), "<i4")
        size = path.stat().st_size
    except (OSError, ValueError):
        return False
    return len(head) == 3 and set(head[:2].tolist()) <= {20, 21} and abs(head[2]) <= 90 and size > 7316


def read(path: Path) -> Raster:
    """Read a raster's first band.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    heartbeat.sign()
    with reading(path, "raster"):
        with path.open("rb") as file:
            ascii_grid = file.read(5).lower() == b"ncols"
        return _read_ascii(path) if ascii_grid else _read_gdal(path)


def _read_gdal(path: Path) -> Raster:
    rasterio = optional_packages.package("rasterio")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(path, driver=_driver(path)) as source:
            _check_size(path, source, 1)
            a, b, c, d, e, f = source.transform[:6]
            if b or d:
                raise _error(path, "is turned in its projection; gdalwarp makes it upright")
            values = source.read(1)
            converted = values.astype(np.float32)
            if source.nodata is not None:
                converted[values == source.nodata] = np.nan
            if source.scales[0] != 1 or source.offsets[0] != 0:
                converted = converted * np.float32(source.scales[0]) + np.float32(source.offsets[0])
            projection = source.crs.to_wkt() if source.crs else _prj(path)
            whole = np.issubdtype(values.dtype, np.integer)
    x, y = c + a * (np.arange(converted.shape[1]) + 0.5), f + e * (np.arange(converted.shape[0]) + 0.5)
    return Raster(path, _mask_no_data(converted), x, y, projection, whole)


def read_bands(path: Path) -> tuple[NDArray[np.float32], list[str]]:
    """Read all bands (nt, ny, nx) of a GDAL raster, NaN without data, and their descriptions.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    heartbeat.sign()
    rasterio = optional_packages.package("rasterio")
    with reading(path, "raster"), warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(path, driver=_driver(path)) as source:
            _check_size(path, source, source.count)
            values = source.read()
            converted = values.astype(np.float32)
            if source.nodata is not None and source.nodata != 0:
                converted[values == source.nodata] = np.nan
            return converted, [text or "" for text in source.descriptions]


def _driver(path: Path) -> str:
    """Return the GDAL driver of a raster; GDAL itself also opens a VRT, which names files and servers."""
    if path.suffix.lower() != ".bil":
        return "GTiff"
    with path.with_suffix(".hdr").open("rb") as header:
        return "ENVI" if header.read(4) == b"ENVI" else "EHdr"


def _check_size(path: Path, source: Any, bands: int) -> None:
    size = bands * source.height * source.width * max(np.dtype(each).itemsize for each in source.dtypes)
    if size > UNPACKED_BYTES:
        shape = f"{bands} x {source.height} x {source.width} values"
        raise _error(path, f"has {shape}, more than {UNPACKED_BYTES / 1e6:,.0f} MB; take a part of it")


def _read_ascii(path: Path) -> Raster:
    """Read Esri's ASCII grid: six header lines of a word and a number, then rows from the north."""
    head: dict[str, float] = {}
    with path.open(encoding="ascii", errors="replace") as file:
        while len(head) < 6:
            at = file.tell()
            words = file.readline(_PIECE).split()
            if len(words) != 2 or not words[0][0].isalpha():
                file.seek(at)
                break
            head[words[0].lower()] = _number(words[1])
        if not {"ncols", "nrows", "cellsize"} <= set(head):
            raise _error(path, "its header has no ncols, nrows or cellsize")
        if not np.isfinite([value for name, value in head.items() if name != "nodata_value"]).all():
            raise _error(path, "its header has a value that is not a number")
        nx, ny, side = int(head["ncols"]), int(head["nrows"]), head["cellsize"]
        if not (0 < nx * ny <= _LARGEST and nx > 0 and side > 0):
            raise _error(path, f"has {ny} rows, {nx} columns and cells of {side}, which makes no sense")
        values = _read_values(path, file, len(head), nx * ny)
    if values.size != nx * ny:
        raise _error(path, f"has {values.size} values where its head says {ny} x {nx}; it is incomplete")
    values = values.reshape(ny, nx)
    values[values == np.float32(head.get("nodata_value", -9999.0))] = np.nan
    corner = [head.get(f"{axis}llcorner", head.get(f"{axis}llcenter", 0.0) - side / 2) for axis in "xy"]
    x, y = corner[0] + side * (np.arange(nx) + 0.5), corner[1] + side * (ny - np.arange(ny) - 0.5)
    return Raster(path, _mask_no_data(values), x, y, _prj(path))


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")


def _read_values(path: Path, file: TextIO, above: int, count: int) -> NDArray[np.float32]:
    """Read numbers after the lines `above`, up to a few more than `count`, in pieces of lines."""
    pieces = [np.empty(0, np.float32)]
    while count >= 0 and (text := file.read(_PIECE)):
        text += (end := file.readline(_PIECE))
        if len(end) == _PIECE:
            raise _error(path, f"has a line of more than {_PIECE / 1e6:,.0f} MB; write one line for each row")
        try:
            pieces.append(np.array(text.split(), np.float32))
        except ValueError:
            raise _wrong_word(path, text, above) from None
        count, above = count - pieces[-1].size, above + text.count("\n")
    return np.concatenate(pieces)


def _wrong_word(path: Path, text: str, above: int) -> InputError:
    """Create the error for the first word that is not a number."""
    for number, line in enumerate(text.splitlines(), above + 1):
        for word in re.finditer(r"\S+", line):
            try:
                float(word[0])
            except ValueError:
                return input_error(
                    path, f"{word[0][:40]!r} is not a number", line=number, column=word.start() + 1
                )
    return _error(path, "contains text that is not a number")


def _mask_no_data(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Replace -9999 by NaN: it means no data by convention."""
    values[values == -9999.0] = np.nan
    return values


def _prj(path: Path) -> str:
    """Read the projection from a .prj file of the same name; empty without one."""
    projection = path.with_suffix(".prj")
    if not os.path.lexists(projection):
        return ""
    with reading(projection):
        return read_text(projection, errors="replace", most=SETTINGS_BYTES).strip()


def landscape(path: Path) -> dict[str, Raster]:
    """Read the layers of an LCP: elevation (m), category, height and base_height (m), bulk_density (kg/m3).

    Header as in GDAL (lcpdataset.cpp): 7316 bytes, then 16-bit numbers interleaved by pixel, rows from the
    north. Units: heights 1 m, 2 ft, 3 m x 10, 4 ft x 10; bulk density 1 kg/m3, 2 lb/ft3, 3 kg/m3 x 100, 4
    lb/ft3 x 1000.

    Raises
    ------
    InputError
        The file is damaged.
    """
    with reading(path, "landscape (LCP)"):
        return _read_landscape(path)


def _read_landscape(path: Path) -> dict[str, Raster]:
    if not is_lcp(path):
        raise _error(path, "has no header of an LCP with cells behind it; it is damaged or incomplete")
    with path.open("rb") as file:
        data = file.read(7316)
    crown, ground = np.frombuffer(data, "<i4", 2, 0)
    nx, ny = (int(each) for each in np.frombuffer(data, "<i4", 2, 4164))
    east, west, north, south = np.frombuffer(data, "<f8", 4, 4172)
    elevation, height, base, density = (
        int(np.frombuffer(data, "<i2", 1, at)[0]) for at in (4224, 4234, 4236, 4238)
    )
    bands = 5 + 3 * int(crown == 21) + 2 * int(ground == 21)
    if nx <= 0 or ny <= 0 or path.stat().st_size - 7316 < 2 * bands * nx * ny or not east > west < np.inf:
        raise _error(path, f"says {ny} x {nx} cells of {bands} layers, which it does not hold; it is damaged")
    cells = np.memmap(path, "<i2", "r", 7316, (ny, nx, bands))
    x = west + (east - west) * (np.arange(nx) + 0.5) / nx
    y = north - (north - south) * (np.arange(ny) + 0.5) / ny
    heights = {0: 0.1, 1: 1.0, 2: 0.3048, 3: 0.1, 4: 0.03048}
    densities = {0: 0.01, 1: 1.0, 2: 16.018463, 3: 0.01, 4: 0.016018463}
    layers = {"elevation": (0, 0.3048 if elevation == 1 else 1.0), "category": (3, 1.0)}
    if crown == 21:
        layers |= {"height": (5, heights.get(height, 0.1)), "base_height": (6, heights.get(base, 0.1))}
        layers |= {"bulk_density": (7, densities.get(density, 0.01))}
    by_role = {}
    for name, (band, scale) in layers.items():
        values = cells[:, :, band].astype(np.float32)
        by_role[name] = Raster(path, _mask_no_data(values) * np.float32(scale), x, y, _prj(path))
    return by_role


def _error(path: Path, reason: str) -> InputError:
    return input_error(path, reason)
