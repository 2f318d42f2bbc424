"""Terrain elevation of a shot: the run's heights, or the data of a user's elevation model (DEM).

All objects on the ground take their heights from here. At its edges and gaps the model blends into
the run's heights over `_BLEND` metres. Next to 3D Tiles the ground blends into the tiles, outside of them.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...run import areas
from ..sections import SceneSettings
from . import rim, tile_heights
from .raster import Array, GeoTiff, extent, format_bounds
from .tile_heights import TileHeights

_BLEND = 600.0  # m
_UNITS = {
    "": 1.0, "m": 1.0, "metre": 1.0, "meter": 1.0, "metres": 1.0, "meters": 1.0,
    "ft": 0.3048, "foot": 0.3048, "feet": 0.3048, "international foot": 0.3048,
    "us-ft": 1200.0 / 3937.0, "us survey foot": 1200.0 / 3937.0, "us_survey_foot": 1200.0 / 3937.0,
    "ussurveyfoot": 1200.0 / 3937.0, "foot_us": 1200.0 / 3937.0,
}  # fmt: skip
_PLAUSIBLE = (-1000.0, 9500.0)  # m, plausible elevations on Earth
_FEET = (2.9, 3.7)  # ratio to the run's heights at which a model counts as feet
_MAX_OFFSET = 500.0  # m, limit of the median difference from the run's heights
_APRON = 2048  # points per side at most for the apron's heights


class Elevation:
    """Elevation on a run's grids, m; NaN where neither the run nor the model has data.

    Parameters
    ----------
    model
        The elevation model; None: the run's heights alone.
    """

    def __init__(self, run: Run, model: GeoTiff | _Stacked | None = None) -> None:
        self.run, self.model = run, model

    @property
    def tiles(self) -> TileHeights | None:
        """3D Tiles that give this elevation; None without."""
        return self.model.tiles if isinstance(self.model, _Stacked) else None

    @property
    def parts(self) -> tuple[Elevation, Elevation]:
        """Elevation of the 3D Tiles alone, and of the ground around them; only for elevation from tiles."""
        assert isinstance(self.model, _Stacked)
        return Elevation(self.run, _Stacked(self.model.tiles, None)), Elevation(self.run, self.model.model)

    @property
    def fuel(self) -> NDArray[np.float32]:
        """Elevation (fy, fx) of the fuel grid, m."""
        return self._fuel[0]

    @property
    def share(self) -> NDArray[np.float32]:
        """Weight of the elevation model (fy, fx), 0..1, on the fuel grid."""
        return self._fuel[1]

    @cached_property
    def _fuel(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        run = self.run
        return self.mixed(run.fuel_latitude, run.fuel_longitude, run.fuel_elevation)

    @cached_property
    def coarse(self) -> NDArray[np.float32]:
        """Elevation (ny, nx) of the model grid, m."""
        return self.mixed(self.run.latitude, self.run.longitude, self.run.elevation)[0]

    @cached_property
    def air(self) -> NDArray[np.float32]:
        """Elevation (ay, ax) at the horizontal grid of the run's 3D fields, m."""
        run = self.run
        if not run.has("air_latitude"):
            return self.coarse
        at = []
        for axis, places in ((run.latitude, run.air_latitude), (run.longitude, run.air_longitude)):
            rising = np.argsort(axis)
            at.append(np.interp(places, axis[rising], rising.astype(np.float64)))
        own = bilinear(run.elevation, at[0][:, None], at[1]).astype(np.float32)
        return self.mixed(run.air_latitude, run.air_longitude, own)[0]

    def rows(self, first: int, last: int) -> NDArray[np.float32]:
        """Rows of `fuel`; of the run's own heights only these are read."""
        return self.fuel[first:last] if self.model else self.run.fuel_rows("fuel_elevation", first, last)

    def mixed(self, latitude: Array, longitude: Array, own: NDArray) -> tuple[NDArray, NDArray[np.float32]]:
        """Blend model and run heights `own` on a grid (ny, nx); return heights and the model's weight.

        The weight is 1 for the model alone and 0 for the run alone.
        """
        if self.model is None or not self.model.overlaps(latitude, longitude):
            return own, np.zeros(own.shape, np.float32)
        if isinstance(self.model, _Stacked):
            return self._on_tiles(latitude, longitude, own)
        heights = self.read(latitude, longitude)
        known = np.isfinite(heights)
        share = np.where(known, 1.0, 0.0).astype(np.float32)
        between = np.isfinite(own)
        share[between] = ramp(known, _width(latitude, longitude))[between]
        own_there, heights = np.where(between, own, heights), np.where(known, heights, own)
        return (own_there + share * (heights - own_there)).astype(own.dtype), share

    def _on_tiles(
        self, latitude: Array, longitude: Array, own: NDArray
    ) -> tuple[NDArray, NDArray[np.float32]]:
        """Blend as `mixed`: tiles in full up to their border, where the surrounding ground meets them."""
        tiles, others = self.parts
        beside, share = others.mixed(latitude, longitude, own)
        heights = rim.meet(tiles.read(latitude, longitude), beside, _width(latitude, longitude))
        return heights.astype(own.dtype), np.where(heights == beside, share, np.float32(1.0))

    def read(self, latitude: Array, longitude: Array) -> NDArray[np.float32]:
        """Model heights (ny, nx), m, NaN without data; axes may be uneven or descending."""
        assert self.model is not None
        even = _even(latitude), _even(longitude)
        heights = self.model.on_grid(*even)[0] * unit(self.model)
        heights[(heights < _PLAUSIBLE[0]) | (heights > _PLAUSIBLE[1])] = np.nan
        row, column = (
            (axis - regular[0]) / (regular[1] - regular[0])
            for axis, regular in zip((latitude, longitude), even, strict=True)
        )
        if all(np.abs(at - np.round(at)).max() < 1.0e-6 for at in (row, column)):
            return heights[np.ix_(np.round(row).astype(int), np.round(column).astype(int))]
        return bilinear(heights, row[:, None], column).astype(np.float32)


def resolve(settings: SceneSettings, run: Run, tiles: Path | None = None) -> Elevation:
    """Resolve the elevation of a scene.

    Parameters
    ----------
    tiles
        File of the heights of the scene's tiles, if objects are placed on them.

    Raises
    ------
    InputError
        The elevation model cannot be used.
    """
    model = GeoTiff(settings, "elevation") if settings.terrain.elevation else None
    if tiles and tiles.is_file():  # else tiles are not selected yet
        return Elevation(run, _Stacked(tile_heights.read(tiles, run), model))
    return Elevation(run, model)


class _Stacked:
    """Heights of tiles, and of an elevation model outside of them."""

    unit = "m"

    def __init__(self, tiles: TileHeights, model: GeoTiff | None) -> None:
        self.tiles, self.model, self.resolution = tiles, model, tiles.resolution

    def overlaps(self, latitude: Array, longitude: Array) -> bool:
        """Return whether one of them has heights there."""
        return self.tiles.overlaps(latitude, longitude) or (
            self.model is not None and self.model.overlaps(latitude, longitude)
        )

    def on_grid(self, latitude: Array, longitude: Array) -> NDArray[np.float32]:
        """Heights (1, ny, nx), m."""
        found = self.tiles.on_grid(latitude, longitude)
        if self.model is None or not self.model.overlaps(latitude, longitude):
            return found
        return np.where(np.isfinite(found), found, self.model.on_grid(latitude, longitude) * unit(self.model))


def check(settings: SceneSettings, run: Run) -> None:
    """Validate an elevation model: file type, overlap with the run, and unit of its heights.

    Raises
    ------
    InputError
        Names the file and what to do.
    """
    if not settings.terrain.elevation:
        return
    model = GeoTiff(settings, "elevation")
    if model.unit not in _UNITS:
        raise model.error(f'has heights in "{model.unit}"; convert them to metres or feet with gdal_calc.py')
    if not model.overlaps(run.latitude, run.longitude):
        here = format_bounds(extent(run))
        raise model.error(f"covers {format_bounds(model.bounds)}, outside of the run, which covers {here}")
    height, latitude, longitude = model.glimpse(extent(run))
    height = height * unit(model)
    own = _run_heights(run, latitude, longitude)
    here = np.isfinite(own) & np.isfinite(height)
    if not here.any():
        if not Elevation(run, model).share.any():
            raise model.error("has no data in the run's area")
        return
    height, own = height[here], own[here]
    wrong = (height < _PLAUSIBLE[0]) | (height > _PLAUSIBLE[1])
    if wrong.any():
        raise model.error(
            f"has heights of {height[wrong][0]:g} m; if that means no data: "
            f"gdal_edit.py -a_nodata {height[wrong][0] / unit(model):g} {model.path.name}"
        )
    _compare(model, height, own)


def _compare(model: GeoTiff, height: Array, own: Array) -> None:
    """Raise an error if heights differ from the run's by far."""
    times = float(np.sum(height * own) / max(np.sum(own * own), 1.0))
    off = float(np.median(height - own))
    if abs(off) > _MAX_OFFSET and _FEET[0] < times < _FEET[1]:
        raise model.error(
            f"has heights {times:.2f} times the run's: they look like feet; set the unit with "
            f"gdal_edit.py -units ft {model.path.name}; they are then converted to metres"
        )
    if abs(off) > _MAX_OFFSET:
        raise model.error(
            f"is {abs(off):,.0f} m {'above' if off > 0.0 else 'below'} the run's ground in most places; "
            "its first band must hold heights in metres above mean sea level"
        )


def unit(model: GeoTiff | _Stacked) -> float:
    """Metres in a unit of the model's heights."""
    return _UNITS[model.unit]


def ramp(has_height: NDArray[np.bool_], width: int) -> NDArray[np.float32]:
    """Ramp (ny, nx): 1 if all points within `width` steps are known, falling smoothly to 0 at unknown ones.

    The edge continues beyond the grid.
    """
    total, eroded = np.zeros(has_height.shape, np.float32), has_height
    for _ in range(width):
        if eroded.all() and not total.any():
            return np.ones(has_height.shape, np.float32)
        total += eroded
        eroded = _eroded(eroded)
    total /= np.float32(width)
    return total * total * (np.float32(3.0) - np.float32(2.0) * total)


def _eroded(known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    for axis in (0, 1):
        padded = np.pad(known, [(1, 1) if k == axis else (0, 0) for k in (0, 1)], "edge")
        parts = (padded.take(range(k, k + known.shape[axis]), axis) for k in range(3))
        known = np.logical_and.reduce(list(parts))
    return known


def _width(latitude: Array, longitude: Array) -> int:
    """Points along `_BLEND` metres."""
    return max(round(_BLEND / _spacing(latitude, longitude)), 1)


def _spacing(latitude: Array, longitude: Array) -> float:
    """Least distance of rows or columns, m."""
    scale = areas.metres_per_degree(float(np.mean(latitude)))
    steps = (np.abs(np.diff(axis)) * k for axis, k in zip((latitude, longitude), scale, strict=True))
    return max(min((float(step.min()) for step in steps if len(step)), default=_BLEND), 1.0)


def _even(axis: Array) -> Array:
    """Make an even, ascending axis over the same stretch, as fine as this one or of `_APRON` points."""
    low, high = float(axis.min()), float(axis.max())
    if len(axis) == 1:
        return np.array([low, low + 1.0e-3])
    count = round((high - low) / float(np.abs(np.diff(axis)).min())) + 1
    if len(axis) != count:
        count = min(count, max(_APRON, len(axis)))
    return np.linspace(low, high, count)


def _run_heights(run: Run, latitude: Array, longitude: Array) -> Array:
    """Sample the run's heights (n,) in the model cells of these places; NaN outside of the run."""
    index, inside = [], np.ones(len(latitude), bool)
    middle = 0.5 * float(run.longitude[0] + run.longitude[-1])
    for axis, at in ((run.latitude, latitude), (run.longitude, areas.turned(longitude, middle))):
        rising = np.argsort(axis)
        inside &= (at >= axis.min()) & (at <= axis.max())
        near = np.interp(at, axis[rising], np.arange(len(axis)))
        index.append(rising[np.round(near).astype(int)])
    return np.where(inside, run.elevation[tuple(index)], np.nan)
