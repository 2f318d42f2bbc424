"""Cover of open land: shrubs, hollows and valleys, as fields (ny, nx) of the terrain grid. Without Blender.

Cover without fuel data is procedural. Hollows come from the terrain, and from noise on level land.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...run import fuel_category
from ...shot.shot import Shot, cached_on_shot
from ...shot.surface import land_use
from ...shot.terrain import noise
from ...shot.terrain.terrain import Terrain
from . import biomes, patterns

_REACH = 180.0  # m, half-width of the moving means that a hollow lies below (by eye)
_DEEP = 9.0  # m below these means at which a hollow is complete (by eye)
_LEVEL = 420.0  # m, wavelength of noise hollows
_BUSHY = {"grass": 0.0, "shrub": 0.85, "litter": 0.35, "slash": 0.15}
"""Shrub cover fraction by kind of fuel; grass takes the biome's (assumed)."""
_AMONG_GRASS = 0.30  # shrub cover of Scott and Burgan's GS, grass and shrub

Array = NDArray[np.float64]


_HOLLOWS: WeakKeyDictionary[Terrain, Array] = WeakKeyDictionary()


@cached_on_shot
def shrubs(shot: Shot) -> Array:
    """Shrub cover 0..1 of open land: from the fuel category, else from the fuel load."""
    here = biomes.choose(shot)
    share = _by_load(shot.ground, here)
    if shot.run.has(fuel_category.FIELD):
        share = np.where(np.isnan(said := _by_category(shot, here)), share, said)
    return share


def _by_load(ground: Terrain, here: biomes.ShotBiome) -> Array:
    low, high = here.biome.shrub_load
    return _beside(here, 0.85 * noise.smoothstep(low, high, ground.fields.surface_fuel))


def _beside(here: biomes.ShotBiome, shrub: Array) -> Array:
    return np.maximum(shrub, here.biome.shrub_cover)


def _by_category(shot: Shot, here: biomes.ShotBiome) -> Array:
    """Shrub cover 0..1 from the run's fuel category; NaN elsewhere, as on the apron."""
    number = on_ground(shot, shot.run.fuel_rows(fuel_category.FIELD, 0, len(shot.run.fuel_latitude)))
    kind = fuel_category.kinds(number)
    share = np.full(len(fuel_category.NAMES), np.nan)
    for name, bushy in _BUSHY.items():
        share[fuel_category.NAMES.index(name)] = bushy
    share[fuel_category.UNBURNABLE] = 0.0
    shrub_cover = np.where((number > 120) & (number < 125), _AMONG_GRASS, share[kind])
    return np.where(kind == fuel_category.UNBURNABLE, shrub_cover, _beside(here, shrub_cover))


def mapped(shot: Shot) -> Array:
    """Mask of land cover maps: 1 where a land use map has data."""
    if land_use.read_map(shot) is None:
        return np.zeros(shot.ground.shape)
    fields = shot.ground.fields
    place = shot.ground.frame.forward_grid(fields.latitude, fields.longitude, fields.elevation)
    return land_use.mapped(shot, place.reshape(-1, 3)).reshape(shot.ground.shape).astype(np.float64)


def on_ground(shot: Shot, field: NDArray) -> Array:
    """Resample a field (fy, fx) of the run's fuel grid to the terrain grid; NaN beyond the run."""
    run: Run = shot.run
    row, column = (
        np.interp(wanted, *_ascending(own), left=np.nan, right=np.nan)
        for wanted, own in (
            (shot.ground.fields.latitude, run.fuel_latitude),
            (shot.ground.fields.longitude, run.fuel_longitude),
        )
    )
    resampled = np.full((len(row), len(column)), np.nan)
    inside = np.ix_(np.isfinite(row), np.isfinite(column))
    at = (np.rint(v[np.isfinite(v)]).astype(int) for v in (row, column))
    resampled[inside] = field[np.ix_(*at)]
    return resampled


def _ascending(axis: Array) -> tuple[Array, Array]:
    """Return an axis in ascending order, and its indices."""
    order = np.argsort(axis)
    return axis[order], order.astype(np.float64)


def hollows(ground: Terrain) -> Array:
    """Hollows: depth below moving means of elevation, -1 (crests) to 1 (hollows); noise on level land."""
    if ground not in _HOLLOWS:
        _HOLLOWS[ground] = _hollows(ground)
    return _HOLLOWS[ground]


def _hollows(ground: Terrain) -> Array:
    height = ground.fields.elevation
    below = np.zeros(height.shape)
    for reach in (_REACH, 3.0 * _REACH):
        cells = [max(round(reach / size), 1) for size in ground.cell]
        below += _mean(height, cells) - height
    relief = np.clip(below / _DEEP, -1.0, 1.0)
    return relief + (1.0 - np.abs(relief)) * 0.6 * _noise(ground)


def _noise(ground: Terrain) -> Array:
    """Noise of the plane, -1..1; 0 on the apron, whose grid is coarse."""
    fields, inner = ground.fields, np.zeros(ground.shape)
    rows, columns = (np.arange(len(axis)) for axis in (fields.latitude, fields.longitude))
    made = noise.fractal(
        columns[None] * ground.cell[1], rows[:, None] * ground.cell[0], _LEVEL, 3, ground.seed + 55
    )
    part = tuple(slice(fields.margin, -fields.margin or None) for _ in range(2))
    inner[part] = np.clip(1.6 * made[part], -1.0, 1.0)
    return inner


def _mean(field: Array, cells: list[int]) -> Array:
    """Compute moving means of `cells` cells to each side along both axes; edge values extend the field."""
    for axis, reach in enumerate(cells):
        pad = [(reach + 1, reach) if k == axis else (0, 0) for k in (0, 1)]
        total = np.cumsum(np.pad(field, pad, "edge"), axis=axis)
        window = 2 * reach + 1
        ahead, behind = [slice(None)] * 2, [slice(None)] * 2
        ahead[axis], behind[axis] = slice(window, None), slice(None, -window)
        field = (total[tuple(ahead)] - total[tuple(behind)]) / window
    return field


def bushes(shot: Shot, land: biomes.OpenLand, shrub: Array, place: Array) -> Array:
    """Shrub cover 0..1 at points (n, 2), m, whose mean over patches is `shrub` (n,)."""
    if len(place) == 0:
        return np.empty(0)
    place = np.column_stack([place[:, :2], shot.ground.up(*place[:, :2].T)])
    noise_there, hollow = patterns.at(place), patterns.Numbers(at(shot, hollows(shot.ground), place))
    _, _, wet = patterns.wetness(noise_there, hollow, land)
    return patterns.bushes(noise_there, patterns.Numbers(shrub), wet, land)[1].value


def draws(land: biomes.OpenLand, place: Array) -> Array:
    """Shallow valleys 0..1 at points (n, 3) in the scene, m."""
    if not land.draws:
        return np.zeros(len(place))
    noise_there = patterns.at(place)
    return patterns.draws(noise_there, noise_there(130.0, 4.0, 0.65), land).value


def at(shot: Shot, field: Array, place: Array) -> Array:
    """Values (n,) of a field at points (n, 2 or 3) in the scene, m."""
    if len(place) == 0:
        return np.empty(0)
    return bilinear(field, *shot.ground.indices(*shot.ground.geodetic(*place[:, :2].T)))
