"""A raster of the user's own, placed on the Earth by its projection: a GeoTIFF, read by rasterio.

rasterio is an extra, wanted only where such a file is named. Of a file no more is read than is asked for, and
no more of that is held at once than `_MEMORY`.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...errors import Error, InputError, input_error
from ...run import areas
from ..settings import scene_file
from ..settings.settings import Settings

_MEMORY = 64  # MB
_GLIMPSES, _GLIMPSE = 6, 8  # looks along each side, and pixels of one
_OFF = 0.02  # pixels that a place may be off when it is looked up
_EARTH = "EPSG:4326"  # WGS84, degrees

Array = NDArray[np.float64]
Bounds = tuple[float, float, float, float]


def library(settings: Settings, name: str) -> ModuleType:
    """The package rasterio, which the key `name` of [terrain] needs.

    Raises
    ------
    InputError
        It is not installed; names the line of the scene file.
    """
    try:
        import rasterio
        import rasterio.warp
        import rasterio.windows
    except ImportError:
        reason = f"terrain.{name} needs the Python package rasterio: {sys.executable} -m pip install rasterio"
        raise scene_file.error_at(settings.path, ("terrain", name), reason) from None
    return rasterio


class Raster:
    """A GeoTIFF that the key `name` of [terrain] names.

    Attributes
    ----------
    bounds
        West, south, east and north, degrees.
    resolution
        Size of a pixel in its middle, about, m.

    Raises
    ------
    InputError
        rasterio is missing, the file is no GeoTIFF, or says not where it lies on the Earth.
    """

    def __init__(self, settings: Settings, name: str) -> None:
        self.rasterio = library(settings, name)
        self.key = settings.path, ("terrain", name)
        self.path: Path = getattr(settings.terrain, name)
        if not self.path.is_file():
            reason = f"terrain.{name}: there is no file {self.path}"
            raise scene_file.error_at(settings.path, ("terrain", name), reason)
        with self.open() as source:
            if source.crs is None or source.transform.is_identity:
                raise self.error(
                    "does not say where on the Earth it lies; gdal_edit.py -a_srs and -a_ullr can tell it"
                )
            bounds = self.rasterio.warp.transform_bounds(source.crs, _EARTH, *source.bounds)
            if not np.isfinite(bounds).all():
                raise self.error("lies nowhere on the Earth by its own projection")
            self.bounds, self.shape = bounds, source.shape
            self.count, self.unit = source.count, (source.units[0] or "").strip().lower()
            self.types, self.nodata = source.dtypes, source.nodata
        south, north = bounds[1], bounds[3]
        metres = 111_200.0 * np.array([north - south, (bounds[2] - bounds[0]) * np.cos(np.radians(south))])
        self.resolution = float(np.min(metres / self.shape))

    def error(self, reason: str) -> InputError:
        """An error about this file."""
        return input_error(self.path, 0, 0, reason)

    @contextmanager
    def open(self) -> Iterator[Any]:
        """The file, open; whatever goes wrong in reading is said in one line.

        Raises
        ------
        InputError
        """
        known = self.rasterio.errors
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", known.NotGeoreferencedWarning)
                with (
                    self.rasterio.Env(GDAL_DISABLE_READDIR_ON_OPEN="EMPTY_DIR", GDAL_CACHEMAX=_MEMORY),
                    self.rasterio.open(self.path, driver="GTiff") as source,
                ):
                    yield source
        except Error:
            raise
        except (known.RasterioError, OSError, ValueError) as error:
            why = " ".join(str(error.__cause__ or error).split()).replace(str(self.path), "it")
            reason = f"{'.'.join(self.key[1])}: {self.path} cannot be read as a GeoTIFF ({why})"
            raise scene_file.error_at(*self.key, reason) from error

    def overlaps(self, latitude: Array, longitude: Array) -> bool:
        """Whether it covers any of a rectangle that holds these places, degrees."""
        return overlap(self.bounds, latitude, longitude)

    def on_grid(self, latitude: Array, longitude: Array, bands: int = 1) -> NDArray[np.float32]:
        """Its values (bands, ny, nx) at the points of a regular grid, NaN where it has none.

        Between pixels they are bilinear; where the grid is coarser, means about each point.

        Parameters
        ----------
        latitude, longitude
            (ny,), (nx,) degrees, evenly spaced and ascending.
        """
        whole = np.full((bands, len(latitude), len(longitude)), np.nan, np.float32)
        longitude = longitude + _turn(self.bounds, longitude)
        west, south, east, north = self.bounds
        rows, columns = _within(latitude, south, north), _within(longitude, west, east)
        found = np.full(whole[:, rows, columns].shape, np.nan, np.float32)
        if found.size == 0:
            return whole
        dx, dy = (float((axis[-1] - axis[0]) / (len(axis) - 1)) for axis in (longitude, latitude))
        corner = longitude[columns.start] - 0.5 * dx, latitude[rows.start] - 0.5 * dy
        with self.open() as source:
            self.rasterio.warp.reproject(
                self.rasterio.band(source, list(range(1, bands + 1))),
                found,
                dst_transform=self.rasterio.Affine(dx, 0.0, corner[0], 0.0, dy, corner[1]),
                dst_crs=_EARTH,
                src_nodata=self.nodata,
                dst_nodata=np.nan,
                resampling=self.rasterio.warp.Resampling.bilinear,
                warp_mem_limit=_MEMORY,
                tolerance=_OFF,
            )
            scales, offsets = source.scales[:bands], source.offsets[:bands]
        whole[:, rows, columns] = (
            found * np.float32(scales)[:, None, None] + np.float32(offsets)[:, None, None]
        )
        return whole

    def glimpse(self, within: Bounds) -> tuple[NDArray[np.float32], Array, Array]:
        """Some values of the first band (n,) as they stand there, NaN for no data, with their places.

        Latitude and longitude (n,) are degrees; the places are spread over a box, degrees.
        """
        values, columns, rows = [], [], []
        with self.open() as source:
            box = self.rasterio.warp.transform_bounds(_EARTH, source.crs, *within)
            a, b, c, d, e, f = source.transform[:6]
            (top, bottom), (left, right) = (
                np.clip(at, 0, side - 1)
                for at, side in zip(_pixels(source.transform, box), source.shape, strict=True)
            )
            for row in np.linspace(top, bottom, _GLIMPSES).astype(int):
                for column in np.linspace(left, right, _GLIMPSES).astype(int):
                    window = self.rasterio.windows.Window(column, row, _GLIMPSE, _GLIMPSE)
                    read = source.read(1, window=window, masked=True).astype(np.float32).filled(np.nan)
                    y, x = (v + 0.5 for v in np.mgrid[: read.shape[0], : read.shape[1]])
                    values.append(read.ravel())
                    columns.append((x + column).ravel())
                    rows.append((y + row).ravel())
            x, y = np.concatenate(columns), np.concatenate(rows)
            place = a * x + b * y + c, d * x + e * y + f
            longitude, latitude = self.rasterio.warp.transform(source.crs, _EARTH, *place)
            found = np.concatenate(values) * np.float32(source.scales[0]) + np.float32(source.offsets[0])
        return found, np.array(latitude), np.array(longitude)


def overlap(bounds: Bounds, latitude: Array, longitude: Array) -> bool:
    """Whether west, south, east and north hold any of a rectangle that holds these places; degrees."""
    west, south, east, north = bounds
    longitude = longitude + _turn(bounds, longitude)
    return bool(
        latitude.min() < north
        and latitude.max() > south
        and longitude.min() < east
        and longitude.max() > west
    )


def extent(run: Run) -> Bounds:
    """West, south, east and north of a run's grid, degrees."""
    return run.longitude.min(), run.latitude.min(), run.longitude.max(), run.latitude.max()


def said(bounds: Bounds) -> str:
    """``38.900 to 38.909 N and -120.600 to -120.584 E``."""
    west, south, east, north = bounds
    return f"{south:.3f} to {north:.3f} N and {west:.3f} to {east:.3f} E"


def _turn(bounds: Bounds, longitude: Array) -> float:
    """Whole turns (degrees) that bring these longitudes to those of west and east."""
    middle = 0.5 * float(longitude[0] + longitude[-1])
    return float(areas.turned(middle, 0.5 * (bounds[0] + bounds[2]))) - middle


def _within(axis: Array, low: float, high: float) -> slice:
    """Which points of an even, ascending axis lie between two values, and one more at each end."""
    step = axis[1] - axis[0]
    first, last = np.searchsorted(axis, (low - step, high + step))
    return slice(int(first), int(last))


def _pixels(transform: Any, box: Bounds) -> tuple[Array, Array]:
    """Rows and columns of the corners of a box in a raster's own coordinates."""
    a, b, c, d, e, f = (~transform)[:6]
    x, y = np.array(box)[[0, 2, 0, 2]], np.array(box)[[1, 1, 3, 3]]
    row, column = d * x + e * y + f, a * x + b * y + c
    return np.array([row.min(), row.max()]), np.array([column.min(), column.max()])
