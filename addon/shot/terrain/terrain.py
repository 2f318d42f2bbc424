"""Terrain as a function: height, fuel and arrival time at any point, for mesh, trees and cameras."""

from __future__ import annotations

import copy

import numpy as np
from firetwin_core import terrain
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ...ellipsoid import MEAN_RADIUS
from ...geometry.grids import dilate
from ...run import areas, burning, fuel_category
from ...run.frame import local_frame
from ..sections import SceneSettings
from . import apron, dem_patch, even_cells, noise
from .elevation import Elevation

NEVER = 1.0e9  # s, arrival time of ground that never burns
# the same in `burn_time`; smaller, so that interpolation next to burned ground keeps precision
UNKNOWN = 1.0e8
_LEVEL = 0.05  # m
_SPREAD = (0.01, 5.0)  # m/s
_RINGS = 3  # rings of cells beyond the final perimeter with extrapolated arrival times
RELIEF = 7.0  # m, standard deviation of the added relief on slopes of 45 degrees
_OCTAVES = ((210.0, 1.0), (105.0, 0.55), (52.0, 0.27), (26.0, 0.12))  # of the relief: m, weight
_SHARP = 2.4
_RELIEF_LEVEL, _RELIEF_MEAN = 0.25, 0.55  # its strength on level ground, the mean of its shape
_LEAST_SHAPE = (1.0 - _SHARP) * sum(weight for _, weight in _OCTAVES)  # gradient noise is within -1..1

Array = NDArray[np.float64]


class Terrain:
    """Terrain height and fuel on the run's fuel grid and the apron.

    Within `near_radius` of eye points the surface between grid points is Catmull-Rom with added relief.
    Farther away it is bilinear, as the core's tree heights are. The two are blended.

    Parameters
    ----------
    arrival
        Arrival time (fy, fx), s, at the centre of each fuel cell; NaN where it never burns.

    Attributes
    ----------
    made_up
        True for a synthetic run. Only then are unburned islands invented.
    eyes
        Eye points (m, 3) in the scene, m. Without them the terrain is bilinear everywhere.
    surface
        Near-camera surface between the grid points: Catmull-Rom with ridges and gullies.
    patch
        Patch of an elevation model that replaces it; None if there is none.
    rough
        Approximate distance (m) between this surface and the bilinear terrain.
    """

    def __init__(
        self, settings: SceneSettings, run: Run, arrival: Array, relief: Elevation | None = None
    ) -> None:
        self._relief = relief or Elevation(run)
        self.frame = local_frame(run)
        latitude, longitude = run.fuel_latitude, run.fuel_longitude
        width, height = areas.cell_size(
            latitude, longitude, self.frame.latitude, (run.latitude, run.longitude)
        )
        north, east = areas.metres_per_degree(self.frame.latitude)
        elevation, canopy, surface = (
            np.nan_to_num(_oriented(field, latitude, longitude), copy=False)
            for field in (self._relief.fuel, fuel_category.canopy(run), run.surface_fuel)
        )
        model = apron.TerrainFields(
            _ascending(latitude, height / north),
            _ascending(longitude, width / east),
            elevation,
            canopy,
            surface,
        )
        self.cell = (
            north * float(np.mean(np.diff(model.latitude))),
            east * float(np.mean(np.diff(model.longitude))),
        )
        self.fields = apron.extend(
            model,
            self.cell,
            settings.terrain.apron,
            settings.seed,
            (lambda *grid: self._relief.mixed(*grid)[0]) if self._relief.model else None,
        )
        self._share = np.pad(_oriented(self._relief.share, latitude, longitude), self.fields.margin)
        self.seed, self.near_radius = settings.seed, settings.terrain.near_radius
        self.made_up = run.synthetic
        self._set_arrival(_oriented(arrival, latitude, longitude), float(run.times[-1]))
        self.eyes = np.empty((0, 3))
        self.bare, self.water = _bare(self.fields), _water(self.fields)
        if run.has(fuel_category.FIELD):
            number = run.fuel_rows(fuel_category.FIELD, 0, len(latitude))
            said = _oriented(number == fuel_category.WATER, latitude, longitude)
            self.water = np.maximum(self.water, np.pad(said, self.fields.margin))
        slope = np.hypot(*np.gradient(self.fields.elevation, *self._metres()))
        self._slope = np.minimum(slope, 1.0)
        self.surface, self.rough = self._surface(), RELIEF
        self.patch: dem_patch.HeightPatch | None = None

    def _surface(self, patch: dem_patch.HeightPatch | None = None) -> terrain.Surface:
        return terrain.Surface(
            self.fields.elevation,
            self._slope,
            1.0 - self.water,
            self.cell,
            _OCTAVES,
            strength=RELIEF,
            level=_RELIEF_LEVEL,
            sharp=_SHARP,
            mean=_RELIEF_MEAN,
            seed=self.seed + 90,
            patch=patch,
        )

    def seen_from(self, eyes: ArrayLike) -> Terrain:
        """Return the same terrain with detail near these eye points (m, 3) in the scene, m."""
        detailed = copy.copy(self)
        detailed.eyes = np.asarray(eyes, np.float64).reshape(-1, 3)
        if self._relief.model and self.near_radius > 0.0 and (near := detailed._near_eyes(detailed._grid())):
            detailed.patch = dem_patch.patch(self.fields, self._share, self._relief, self.cell, near)
        if detailed.patch:
            detailed.surface = self._surface(detailed.patch)
            detailed.rough = max(RELIEF, float(np.abs(detailed.patch.offset).max()))
        return detailed

    def with_fire(self, run: Run, arrival: Array) -> Terrain:
        """Return the same terrain with the fire of a run on equal grids."""
        burned = copy.copy(self)
        burned._set_arrival(_oriented(arrival, run.fuel_latitude, run.fuel_longitude), float(run.times[-1]))
        return burned

    def _grid(self) -> Array:
        """Scene points (ny, nx, 3) of the grid, m."""
        return self.frame.forward_grid(self.fields.latitude, self.fields.longitude, self.fields.elevation)

    def padded(self, field: NDArray, latitude: Array, longitude: Array) -> NDArray:
        """Pad a field of the run's fuel grid, on these axes, to the terrain grid; NaN in the apron."""
        return np.pad(_oriented(field, latitude, longitude), self.fields.margin, constant_values=np.nan)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the grid, apron included."""
        rows, columns = self.fields.elevation.shape
        return rows, columns

    def _metres(self) -> tuple[Array, Array]:
        """Approximate coordinates along both axes, m, for gradients."""
        north, east = areas.metres_per_degree(self.frame.latitude)
        return self.fields.latitude * north, self.fields.longitude * east

    def _set_arrival(self, arrival: Array, end: float) -> None:
        """Arrival times (s) within the final perimeter and a few cells beyond, and the burned mask.

        Beyond the perimeter arrival times are extrapolated at the rate of spread of the adjacent front.
        `burned` exceeds 0.5 where the front has passed by the `end` of the run (s). A moving front lies
        between two cell centres by their arrival times; a stopped front lies half-way.
        """
        margin, reached = self.fields.margin, np.isfinite(arrival)
        self.arrival = np.full(self.shape, NEVER)
        self.burn_time, self.burned = np.full(self.shape, UNKNOWN), np.zeros(self.shape)
        near = box(reached, more=_RINGS)
        if near is None:
            return
        end = max(end, float(np.max(arrival, initial=end, where=reached)))
        arrival, reached = arrival[near], reached[near]
        crossing = np.zeros(arrival.shape)
        least = burning.least_crossing(max(self.cell))
        row, column = np.nonzero(reached)
        crossing[reached] = burning.crossing(arrival, row, column, least)
        time, crossing, is_known = _extrapolated(np.where(reached, arrival, 0.0), crossing, reached)
        part = np.clip(0.5 + (end - time) / np.where(is_known, crossing, 1.0), 0.0, 1.0)
        burned = np.where(is_known & (reached | (time > end)), part, 0.0)
        if self.made_up:
            row, column = np.nonzero(burned)
            north, east = (
                (at + lines.start) * size
                for at, lines, size in zip((row, column), near, self.cell, strict=True)
            )
            patches = noise.fractal(east, north, 800.0, 3, self.seed + 70)
            burned[row, column] *= 1.0 - noise.smoothstep(0.50, 0.68, patches)  # unburned islands, 6 %
        inner = slice(margin, -margin or None)
        self.arrival[inner, inner][near] = np.where(reached, arrival, NEVER)
        self.burn_time[inner, inner][near] = np.where(is_known, time, UNKNOWN)
        self.burned[inner, inner][near] = burned

    def indices(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of points (degrees), clamped to the grid."""
        fields = self.fields
        row = np.interp(np.asarray(latitude), fields.latitude, np.arange(len(fields.latitude)))
        longitude = areas.turned(longitude, 0.5 * (fields.longitude[0] + fields.longitude[-1]))
        return row, np.interp(longitude, fields.longitude, np.arange(len(fields.longitude)))

    def places(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude of fractional rows and columns."""
        fields = self.fields
        latitude = np.interp(np.asarray(row), np.arange(len(fields.latitude)), fields.latitude)
        longitude = np.interp(np.asarray(column), np.arange(len(fields.longitude)), fields.longitude)
        return latitude, longitude

    def detail(self, east: ArrayLike, north: ArrayLike, up: ArrayLike = 0.0) -> Array:
        """Weight 0..1 of the near-camera surface: 1 within 0.6 of an eye's near radius, 0 beyond it."""
        east, north, up = (np.asarray(v, np.float32) for v in np.broadcast_arrays(east, north, up))
        if self.near_radius <= 0.0 or len(self.eyes) == 0:
            return np.zeros(east.shape)
        nearest = np.full(east.shape, np.inf, np.float32)
        for eye in self.eyes.astype(np.float32):
            square = (east - eye[0]) ** 2 + (north - eye[1]) ** 2 + (up - eye[2]) ** 2
            np.minimum(nearest, square, out=nearest)
        return noise.smoothstep(self.near_radius, 0.6 * self.near_radius, np.sqrt(nearest))

    def height(self, row: ArrayLike, column: ArrayLike, detail: ArrayLike = 0.0) -> Array:
        """Height above the datum (m) at fractional rows and columns, with the weight of detail there."""
        if isinstance(detail, float) and detail == 0.0:
            return bilinear(self.fields.elevation, *np.broadcast_arrays(row, column))
        row, column, detail = np.broadcast_arrays(row, column, np.asarray(detail, np.float64))
        height = bilinear(self.fields.elevation, row, column)
        near = np.flatnonzero(detail.ravel() > 0.0)
        if len(near):
            r, c, w = (v.ravel()[near] for v in (row, column, detail))
            flat = height.ravel()
            flat[near] += w * self.surface.detail(r, c)
            height = flat.reshape(row.shape)
        return height

    def floor(self) -> Array:
        """Compute a lower bound of the terrain: scene points (ny, nx, 3) of the grid, all below the ground.

        Bilinear ground within a quad is never below its lowest corner. Far from eyes this holds for the quads
        as drawn. Near eyes Catmull-Rom deviates from the chord by at most 1/8 of the second differences along
        one axis and 1.25/8 along the other, as the absolute values of its weights add up to 1.25. Relief goes
        down to RELIEF times the slope factor times the sum of the octaves' minima. In finer data of an
        elevation model, its lowest point in a quad counts.
        """
        place = self._grid()
        near = self._near_eyes(place)
        if near is None or self.near_radius <= 0.0:
            return place
        height = self.fields.elevation[near]
        bend = (np.abs(_second_difference(height, 0)) + np.abs(_second_difference(height, 1))) * (1.25 / 8.0)
        relief = RELIEF * (_RELIEF_LEVEL + self._slope[near]) * (_RELIEF_MEAN - _LEAST_SHAPE)
        place[near] = self.frame.forward_grid(
            self.fields.latitude[near[0]],
            self.fields.longitude[near[1]],
            height - np.maximum(dilate(bend, 2) + relief, dilate(self._hollows()[near], 1)),
        )
        return place

    def _hollows(self) -> NDArray[np.float32]:
        """Depth (ny, nx), m, of an elevation model below the grid's ground in the next cell."""
        below = np.zeros(self.shape, np.float32)
        if self.patch:
            below[self.patch.place] = self.patch.hollows()
        return below

    def _near_eyes(self, place: Array) -> tuple[slice, slice] | None:
        """Rows and columns of the grid (points `place`) that contain everything near an eye."""
        if len(self.eyes) == 0:
            return None
        low, high = (f(self.eyes[:, :2], axis=0) for f in (np.min, np.max))
        more = self.near_radius + 4.0 * max(self.cell)
        inside = np.all((place[..., :2] > low - more) & (place[..., :2] < high + more), axis=-1)
        return box(inside)

    def point(self, latitude: ArrayLike, longitude: ArrayLike, above: ArrayLike = 0.0) -> Array:
        """Scene points (n, 3) at a height above the ground (m), at points in degrees."""
        latitude, longitude, above = (
            np.atleast_1d(np.asarray(v, np.float64)) for v in np.broadcast_arrays(latitude, longitude, above)
        )
        row, column = self.indices(latitude, longitude)
        height = self.height(row, column)
        if self.near_radius > 0.0 and len(self.eyes):
            coarse = self.frame.forward(latitude, longitude, height)
            height = self.height(row, column, self.detail(*coarse.T))
        return self.frame.forward(latitude, longitude, height + above)

    def geodetic(self, east: ArrayLike, north: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude of the ground at scene coordinates (m); verticals converge with distance."""
        east, north = (np.atleast_1d(np.asarray(v, np.float64)) for v in np.broadcast_arrays(east, north))
        up = -(east**2 + north**2) / (2.0 * MEAN_RADIUS)
        for _ in range(2):
            latitude, longitude, _height = self.frame.reverse(np.stack([east, north, up], axis=-1))
            height = self.height(*self.indices(latitude, longitude))
            up = self.frame.forward(latitude, longitude, height)[:, 2]
        latitude, longitude, _height = self.frame.reverse(np.stack([east, north, up], axis=-1))
        return latitude, longitude

    def under(self, position: NDArray[np.float64]) -> tuple[Array, Array]:
        """Fractional row and column below scene points (n, 3), m, along the local vertical."""
        latitude, longitude, _height = self.frame.reverse(position)
        return self.indices(latitude, longitude)

    def up(self, east: ArrayLike, north: ArrayLike) -> Array:
        """Scene z (n,) of the ground at scene coordinates (m)."""
        return self.point(*self.geodetic(east, north))[:, 2]

    def top(self, east: ArrayLike, north: ArrayLike) -> Array:
        """Scene z (n,) of the ground, or of roofs and crowns if 3D Tiles are the ground."""
        east, north = (np.atleast_1d(np.asarray(v, np.float64)) for v in np.broadcast_arrays(east, north))
        up, tiles = self.up(east, north), self._relief.tiles
        return up if tiles is None else np.fmax(up, tiles.top(east, north))

    def sample(self, field: Array, east: ArrayLike, north: ArrayLike) -> Array:
        """Interpolate a field of the grid (apron included) at scene coordinates (m), bilinear."""
        return bilinear(field, *self.indices(*self.geodetic(east, north)))

    def arrival_at(self, row: ArrayLike, column: ArrayLike) -> Array:
        """Arrival time (s) at fractional rows and columns; NEVER in unburned islands and beyond the fire."""
        burned = bilinear(self.burned, row, column)
        return np.where(burned >= 0.5, bilinear(self.burn_time, row, column), NEVER)

    def spread(self, row: Array, column: Array) -> Array:
        """Rate of spread (m/s): inverse of the arrival time's gradient over one cell."""
        slope = []
        for axis, size in enumerate(self.cell):
            shift = (0.5, 0.0) if axis == 0 else (0.0, 0.5)
            times = [
                bilinear(self.burn_time, row + sign * shift[0], column + sign * shift[1])
                for sign in (1.0, -1.0)
            ]
            slope.append((times[0] - times[1]) / size)
        return np.clip(1.0 / np.maximum(np.hypot(*slope), 1.0e-6), *_SPREAD)


def _ascending(axis: Array, size: float) -> Array:
    """Sort an axis in ascending order; a single value becomes two, one cell of `size` apart."""
    if len(axis) == 1:
        return axis[0] + size * np.array([-0.5, 0.5])
    return axis[::-1] if axis[0] > axis[-1] else axis


def _oriented(field: NDArray, latitude: Array, longitude: Array) -> Array:
    """Transpose and flip a field of the run to (ny, nx) on ascending axes."""
    field = field.astype(np.float64)
    for number, axis in enumerate((latitude, longitude)):
        if len(axis) == 1:
            field = np.repeat(field, 2, number)
        elif axis[0] > axis[-1]:
            field = np.flip(field, number)
    return field


def _fuelless(fields: apron.TerrainFields) -> NDArray[np.bool_]:
    return (fields.surface_fuel < 0.05) & (fields.canopy_fuel < 0.01)


def _water(fields: apron.TerrainFields) -> Array:
    """Lake mask, 0 or 1: ground without fuel that is level within 5 cm over three cells."""
    if min(fields.elevation.shape) < 3:
        return np.zeros(fields.elevation.shape)
    level = dilate(fields.elevation, 1) + dilate(-fields.elevation, 1) < _LEVEL
    bare = _fuelless(fields)
    inner = (level & bare).astype(np.float64)
    return np.where(bare & (inner + _neighbours(inner) > 0.0), 1.0, 0.0)


def _bare(fields: apron.TerrainFields) -> Array:
    """Fraction of fuel-free ground near each grid point, 0..1, smoothed so that noise can break its edge."""
    bare = _fuelless(fields).astype(np.float64)
    for _ in range(2):
        bare = (bare + _neighbours(bare)) / 9.0
    return even_cells.average(bare, fields)


def box(chosen: NDArray[np.bool_], more: int = 0) -> tuple[slice, slice] | None:
    """Bounding slices of a mask (ny, nx), widened by `more` on each side; None if it is empty."""
    slices = []
    for axis, count in enumerate(chosen.shape):
        hit = np.flatnonzero(chosen.any(axis=1 - axis))
        if len(hit) == 0:
            return None
        slices.append(slice(max(int(hit[0]) - more, 0), min(int(hit[-1]) + 1 + more, count)))
    return slices[0], slices[1]


def _extrapolated(
    time: Array, crossing: Array, is_known: NDArray[np.bool_]
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Extrapolate times and crossings (s) to `_RINGS` rings of cells; also return the extended mask."""
    time, crossing, is_known = time.copy(), crossing.copy(), is_known.copy()
    for _ in range(_RINGS):
        weight = _neighbours(is_known.astype(np.float64))
        grow = ~is_known & (weight > 0.0)
        pace = _neighbours(crossing * is_known)[grow] / weight[grow]
        time[grow] = _neighbours(time * is_known)[grow] / weight[grow] + pace
        crossing[grow] = pace
        is_known |= grow
    return time, crossing, is_known


def _neighbours(field: Array) -> Array:
    """Sum over the eight neighbours."""
    padded = np.pad(field, 1)
    three = padded[:-2] + padded[1:-1] + padded[2:]
    return three[:, :-2] + three[:, 1:-1] + three[:, 2:] - field


def _second_difference(field: Array, axis: int) -> Array:
    """Second difference along an axis; edges are extended level."""
    padded = np.pad(field, [(1, 1) if k == axis else (0, 0) for k in (0, 1)], "edge")
    return np.diff(padded, 2, axis)
