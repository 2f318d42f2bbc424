"""Georeferenced raster: a user's GeoTIFF, read and reprojected by rasterio.

rasterio is an optional package, needed only for such files. Only the requested area is read, in blocks of at
most `_MEMORY`.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ... import extras
from ...errors import InputError, input_error, reading
from ...run import areas
from ..schema import scene_text
from ..sections import SceneSettings

_MEMORY = 64  # MB
_SAMPLES, _SAMPLE_SIZE = 6, 8  # samples along each side, and their size in pixels
_TOLERANCE = 0.02  # pixels, tolerance of reprojection
_WGS84 = "EPSG:4326"  # WGS84, degrees

Array = NDArray[np.float64]
Bounds = tuple[float, float, float, float]


def library(settings: SceneSettings, name: str) -> ModuleType:
    """Import rasterio, which the key `name` of [terrain] needs.

    Raises
    ------
    InputError
        rasterio is not installed; the error names the line of the scene file.
    """
    try:
        import rasterio
        import rasterio.warp
        import rasterio.windows
    except ImportError:
        reason = f"terrain.{name} needs the Python package rasterio: {extras.install('raster')}"
        raise scene_text.error_at(settings.path, ("terrain", name), reason) from None
    return rasterio


class GeoTiff:
    """A GeoTIFF that the key `name` of [terrain] names.

    Attributes
    ----------
    bounds
        West, south, east and north, degrees.
    resolution
        Approximate pixel size at the centre, m.

    Raises
    ------
    InputError
        rasterio is missing, or the file is not a GeoTIFF or has no georeference.
    """

    def __init__(self, settings: SceneSettings, name: str) -> None:
        self.rasterio = library(settings, name)
        self.path: Path = getattr(settings.terrain, name)
        if not self.path.is_file():
            reason = f"terrain.{name}: no such file {self.path}"
            raise scene_text.error_at(settings.path, ("terrain", name), reason)
        with self.open() as source:
            if source.crs is None or source.transform.is_identity:
                raise self.error("has no georeference; add one with gdal_edit.py -a_srs and -a_ullr")
            bounds = self.rasterio.warp.transform_bounds(source.crs, _WGS84, *source.bounds)
            if not np.isfinite(bounds).all():
                raise self.error(
                    "has a projection that maps it to no place on Earth; correct it with gdal_edit.py -a_srs"
                )
            self.bounds, self.shape = bounds, source.shape
            self.count, self.unit = source.count, (source.units[0] or "").strip().lower()
            self.types, self.nodata = source.dtypes, source.nodata
        south, north = bounds[1], bounds[3]
        metres = np.array([north - south, bounds[2] - bounds[0]]) * areas.metres_per_degree(south)
        self.resolution = float(np.min(metres / self.shape))

    def error(self, reason: str) -> InputError:
        """Error about this file."""
        return input_error(self.path, reason)

    @contextmanager
    def open(self) -> Iterator[Any]:
        """Open the file; read errors become one-line messages.

        Raises
        ------
        InputError
        """
        with reading(self.path, "GeoTIFF"), warnings.catch_warnings():
            warnings.simplefilter("ignore", self.rasterio.errors.NotGeoreferencedWarning)
            with (
                self.rasterio.Env(GDAL_DISABLE_READDIR_ON_OPEN="EMPTY_DIR", GDAL_CACHEMAX=_MEMORY),
                self.rasterio.open(self.path, driver="GTiff") as source,
            ):
                yield source

    def overlaps(self, latitude: Array, longitude: Array) -> bool:
        """Return whether the raster overlaps the bounding box of these points, degrees."""
        return overlap(self.bounds, latitude, longitude)

    def on_grid(self, latitude: Array, longitude: Array, bands: int = 1) -> NDArray[np.float32]:
        """Resample to a regular grid: values (bands, ny, nx), NaN without data.

        Bilinear between pixels; on a coarser grid the mean around each point.

        Parameters
        ----------
        latitude, longitude
            (ny,), (nx,) degrees, evenly spaced and ascending.
        """
        whole = np.full((bands, len(latitude), len(longitude)), np.nan, np.float32)
        longitude = longitude + _wrap_offset(self.bounds, longitude)
        west, south, east, north = self.bounds
        rows, columns = _slice_between(latitude, south, north), _slice_between(longitude, west, east)
        values = np.full(whole[:, rows, columns].shape, np.nan, np.float32)
        if values.size == 0:
            return whole
        dx, dy = (float((axis[-1] - axis[0]) / (len(axis) - 1)) for axis in (longitude, latitude))
        corner = longitude[columns.start] - 0.5 * dx, latitude[rows.start] - 0.5 * dy
        with self.open() as source:
            self.rasterio.warp.reproject(
                self.rasterio.band(source, list(range(1, bands + 1))),
                values,
                dst_transform=self.rasterio.Affine(dx, 0.0, corner[0], 0.0, dy, corner[1]),
                dst_crs=_WGS84,
                src_nodata=self.nodata,
                dst_nodata=np.nan,
                resampling=self.rasterio.warp.Resampling.bilinear,
                warp_mem_limit=_MEMORY,
                tolerance=_TOLERANCE,
            )
            scales, offsets = source.scales[:bands], source.offsets[:bands]
        scale, offset = (np.array(each, np.float32)[:, None, None] for each in (scales, offsets))
        whole[:, rows, columns] = values * scale + offset
        return whole

    def glimpse(self, within: Bounds) -> tuple[NDArray[np.float32], Array, Array]:
        """Sample the first band: raw values (n,), NaN without data, latitude and longitude (n,), degrees.

        The samples are spread over the box `within`, degrees.
        """
        values, columns, rows = [], [], []
        with self.open() as source:
            box = self.rasterio.warp.transform_bounds(_WGS84, source.crs, *within)
            a, b, c, d, e, f = source.transform[:6]
            (top, bottom), (left, right) = (
                np.clip(at, 0, side - 1)
                for at, side in zip(_pixels(source.transform, box), source.shape, strict=True)
            )
            for row in np.linspace(top, bottom, _SAMPLES).astype(int):
                for column in np.linspace(left, right, _SAMPLES).astype(int):
                    window = self.rasterio.windows.Window(column, row, _SAMPLE_SIZE, _SAMPLE_SIZE)
                    read = source.read(1, window=window, masked=True).astype(np.float32).filled(np.nan)
                    y, x = (v + 0.5 for v in np.mgrid[: read.shape[0], : read.shape[1]])
                    values.append(read.ravel())
                    columns.append((x + column).ravel())
                    rows.append((y + row).ravel())
            x, y = np.concatenate(columns), np.concatenate(rows)
            place = a * x + b * y + c, d * x + e * y + f
            longitude, latitude = self.rasterio.warp.transform(source.crs, _WGS84, *place)
            heights = np.concatenate(values) * np.float32(source.scales[0]) + np.float32(source.offsets[0])
        return heights, np.array(latitude), np.array(longitude)


def overlap(bounds: Bounds, latitude: Array, longitude: Array) -> bool:
    """Return whether a box (west, south, east, north) overlaps the bounding box of these points; degrees."""
    west, south, east, north = bounds
    longitude = longitude + _wrap_offset(bounds, longitude)
    return bool(
        latitude.min() < north
        and latitude.max() > south
        and longitude.min() < east
        and longitude.max() > west
    )


def extent(run: Run) -> Bounds:
    """Bounding box of a run's grid: west, south, east and north, degrees."""
    return run.longitude.min(), run.latitude.min(), run.longitude.max(), run.latitude.max()


def format_bounds(bounds: Bounds) -> str:
    """Format a bounding box: ``38.900 to 38.909 N and -120.600 to -120.584 E``."""
    west, south, east, north = bounds
    return f"{south:.3f} to {north:.3f} N and {west:.3f} to {east:.3f} E"


def _wrap_offset(bounds: Bounds, longitude: Array) -> float:
    """Multiple of 360 degrees that shifts these longitudes into the range of the bounds."""
    middle = 0.5 * float(longitude[0] + longitude[-1])
    return float(areas.turned(middle, 0.5 * (bounds[0] + bounds[2]))) - middle


def _slice_between(axis: Array, low: float, high: float) -> slice:
    """Slice of an even, ascending axis between two values, with one more point at each end."""
    step = axis[1] - axis[0]
    first, last = np.searchsorted(axis, (low - step, high + step))
    return slice(int(first), int(last))


def _pixels(transform: Any, box: Bounds) -> tuple[Array, Array]:
    """Row and column ranges of a box in the raster's own coordinates."""
    a, b, c, d, e, f = (~transform)[:6]
    x, y = np.array(box)[[0, 2, 0, 2]], np.array(box)[[1, 1, 3, 3]]
    row, column = d * x + e * y + f, a * x + b * y + c
    return np.array([row.min(), row.max()]), np.array([column.min(), column.max()])
