"""Understorey: brush, logs, rocks, tufts of grass and twigs near the cameras, without Blender.

Each kind has a separate lattice over the scene, with at most one plant or object per cell. It is a function
of the cell, so it is the same in every shot. Its size in pixels decides whether it is drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.surface import land_use
from ...shot.terrain import noise
from ...shot.tiles import tile_vegetation
from . import biomes, cover, field_lines, models

_PIXELS = 2.0  # smallest height of drawn instances, pixels; half of them are drawn at this height
_BLOCK = 32.0  # m; size of blocks that are culled together
_FARTHEST = 600.0  # m
_STEEPEST = 1.2  # slope up to which logs and rocks stay
_HEDGE = 30.0  # density of bushes in a hedge / density on open land
_LYING = (*models.LOGS, *models.TWIGS)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlantKind:
    """A kind of understorey plant or object. Numbers are assumed.

    Attributes
    ----------
    models
        Indices of its models before the fire.
    burned
        Indices of its models after the fire, in the same order.
    cells
        Cells of its lattice along a block's side.
    height, spread, limits
        Median height, standard deviation of its logarithm, and its limits, m.
    width
        Limits of the ratio to the model's width.
    density
        Number per m2 from canopy fuel and surface fuel (kg/m2) and bare rock (0..1).
    patches
        Size of its patches, m; 0: uniform.
    also
        Factor (n,) on the density at points (n, 2) in the scene, m; None: 1.
    """

    models: tuple[int, ...]
    burned: tuple[int, ...]
    cells: int
    height: float
    spread: float
    limits: tuple[float, float]
    width: tuple[float, float]
    density: Callable[[Array, Array, Array], Array]
    patches: float = 0.0
    also: Callable[[Array], Array] | None = None


def _floor(surface: Array) -> Array:
    return noise.smoothstep(0.05, 0.6, surface)


KINDS = {
    "brush": PlantKind(
        models.BRUSH,
        models.BURNED_BRUSH,
        16,
        0.85,
        0.45,
        (0.25, 2.4),
        (0.8, 1.5),
        lambda canopy, surface, bare: _floor(surface) * (0.03 + 0.12 * np.exp(-canopy / 0.4)) + 0.006 * bare,
        patches=22.0,
    ),
    "log": PlantKind(
        models.LOGS,
        models.LOGS,
        5,
        0.32,
        0.40,
        (0.15, 0.95),
        (0.8, 1.2),
        lambda canopy, surface, bare: 0.010 * noise.smoothstep(0.1, 1.2, canopy),
    ),
    "rock": PlantKind(
        models.ROCKS,
        models.ROCKS,
        16,
        0.28,
        0.75,
        (0.08, 3.0),
        (0.75, 1.25),
        lambda canopy, surface, bare: 0.025 + 0.20 * bare,
        patches=30.0,
    ),
    "tuft": PlantKind(
        models.TUFTS,
        models.STUBBLE,
        32,
        0.30,
        0.35,
        (0.12, 0.65),
        (0.7, 1.3),
        lambda canopy, surface, bare: _floor(surface) * (0.12 + 0.8 * np.exp(-canopy / 0.5)) + 0.05 * bare,
        patches=9.0,
    ),
    "twigs": PlantKind(
        models.TWIGS,
        models.TWIGS,
        32,
        0.13,
        0.35,
        (0.06, 0.28),
        (0.8, 1.3),
        lambda canopy, surface, bare: 0.7 * noise.smoothstep(0.05, 1.0, canopy),
        patches=6.0,
    ),
}


def kinds(shot: Shot) -> dict[str, PlantKind]:
    """Kinds of the shot's biome, by name."""
    biome = biomes.choose(shot).biome
    if biome.open_land is None:
        return KINDS
    return {name: _of_biome(shot, biome, name, kind) for name, kind in KINDS.items()}


def _of_biome(shot: Shot, biome: biomes.Biome, name: str, kind: PlantKind) -> PlantKind:
    plants = biome.plants
    often, taller, wider = (each.get(name, 1.0) for each in (plants.density, plants.height, plants.width))
    which = plants.models.get(name, (kind.models, kind.burned))
    return replace(
        kind,
        cells=round(kind.cells * plants.finer.get(name, 1.0)),
        models=which[0],
        burned=which[1],
        height=kind.height * taller,
        limits=(kind.limits[0] * taller, kind.limits[1] * taller),
        width=(kind.width[0] * wider, kind.width[1] * wider),
        density=lambda canopy, surface, bare: often * kind.density(canopy, surface, bare),
        also=_beside(shot, biome, name),
    )


def _beside(shot: Shot, biome: biomes.Biome, name: str) -> Callable[[Array], Array] | None:
    """Density factor (n,) at points (n, 2): bushes by shrub cover and along hedges, tufts between."""
    if name not in ("brush", "tuft") or biome.open_land is None:
        return None
    covered, land = cover.shrubs(shot), biome.open_land

    def factor(place: Array) -> Array:
        part = cover.at(shot, covered, place)
        if name == "tuft":
            return 1.0 - 0.8 * part
        thick = 1.4 * cover.bushes(shot, land, part, place) + _HEDGE * land_use.hedges(shot, place)
        if land.hedge <= 0.0:
            return thick
        off = field_lines.fields(field_lines.NUMPY, place[:, 0], place[:, 1], land.field)[0]
        return thick + _HEDGE * (off < 0.5 * land.hedge) * ~land_use.mapped(shot, place)

    return factor


@dataclass(frozen=True)
class Instances:
    """Instances of the understorey, n of them.

    Attributes
    ----------
    position
        (n, 3) metres in the scene, on the ground.
    height, width, rotation
        (n,) m; ratio to the model's width; radians.
    pitch, roll
        (n,) radians about their own y and x: along the slope, for logs and the like.
    model, burned
        (n,) indices of its models in `models`, before and after the fire.
    key
        (n, 2) integers that seed an instance's random choices.
    size
        (n,) ratio of their height in pixels to the least that is drawn.
    """

    position: Array
    height: Array
    width: Array
    rotation: Array
    pitch: Array
    roll: Array
    model: NDArray[np.int64]
    burned: NDArray[np.int64]
    key: NDArray[np.int64]
    size: Array

    def take(self, chosen: NDArray) -> Instances:
        """Select instances."""
        return Instances(*(getattr(self, field.name)[chosen] for field in fields(self)))


def grow(shot: Shot) -> Instances:
    """Generate the visible understorey: at most `forest.understorey` instances, the largest in pixels."""
    budget = shot.settings.forest.understorey
    pixel, _ = shot.pixel
    if budget == 0 or not np.isfinite(pixel):
        return _nothing()
    parts = [
        _scattered(shot, kind, number, pixel, budget) for number, kind in enumerate(kinds(shot).values())
    ]
    every = Instances(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Instances)))
    if len(every.size) > budget:
        every = every.take(np.sort(np.argsort(-every.size, kind="stable")[:budget]))
    return _settled(shot, every)


def _nothing() -> Instances:
    empty, whole = np.empty(0), np.empty(0, np.int64)
    key = np.empty((0, 2), np.int64)
    return Instances(np.empty((0, 3)), empty, empty, empty, empty, empty, whole, whole, key, empty)


def _scattered(shot: Shot, kind: PlantKind, number: int, pixel: float, budget: int) -> Instances:
    """Instances of a kind, not yet aligned with the slope."""
    seed = shot.settings.seed + 600 + 20 * number
    reach = min(2.0 * kind.limits[1] / (_PIXELS * pixel), _FARTHEST)
    cells, least = _cells(shot, kind.cells, reach, budget)
    width = _BLOCK / kind.cells

    def lot(use: int, cells: NDArray = cells) -> Array:
        return noise.uniform(cells[:, 0], cells[:, 1], seed + use)

    height = kind.height * np.exp(kind.spread * noise.normal(lot(3), lot(4)))
    height = np.clip(height, *kind.limits)
    # Half of those twice as tall as the least are drawn, so that density fades in.
    tall = height / (pixel * _PIXELS) / (0.5 + lot(5))
    near = np.flatnonzero(tall > least)
    cells, height, tall = cells[near], height[near], tall[near]
    place = (cells + 0.5 + 0.9 * (np.stack([lot(0, cells), lot(1, cells)], axis=-1) - 0.5)) * width
    canopy, surface, bare, water = _ground(shot, place)
    density = np.asarray(kind.density(canopy, surface, bare)) * (water < 0.5)
    if kind.patches:
        waves = noise.fractal(place[:, 0], place[:, 1], kind.patches, 2, seed + 9)
        density = density * 2.0 * noise.smoothstep(-0.45, 0.45, waves)
    if kind.also is not None:
        density = density * kind.also(place)
    if shot.settings.terrain.land_use is not None:
        density = density * ~land_use.keeps_out(shot, place)
    density = density * tile_vegetation.may_grow(shot, place)
    stands = np.flatnonzero(lot(2, cells) < density * width**2)
    cells, place, height, tall = cells[stands], place[stands], height[stands], tall[stands]
    position = np.column_stack([place, shot.ground.up(*place.T)]) if len(place) else np.empty((0, 3))
    distance = shot.visibility.distance(position)
    size = tall / np.maximum(distance, 0.1)
    kept = np.flatnonzero((size > 1.0) & (distance > 0.5 + 1.2 * height) & (distance < _FARTHEST))
    cells, height = cells[kept], height[kept]
    which = (lot(6, cells) * len(kind.models)).astype(np.int64)
    narrow, wide = kind.width
    return Instances(
        position[kept],
        height,
        narrow + (wide - narrow) * lot(7, cells),
        2.0 * np.pi * lot(8, cells),
        np.zeros(len(kept)),
        np.zeros(len(kept)),
        np.array(kind.models)[which],
        np.array(kind.burned)[which],
        cells,
        size[kept],
    )


def _cells(shot: Shot, count: int, reach: float, budget: int) -> tuple[NDArray[np.int64], Array]:
    """Cells (n, 2) of a lattice, east and north, in the blocks that cameras see within `reach` m.

    Also returns the least distance (n,) of a camera to each, m. A block has `count` cells along its side.
    Above 40 cells per instance of the budget, the farthest cells are dropped.
    """
    eyes = np.concatenate(
        [path.position[shot.filmed(path)] for path in shot.perspective_paths] or [np.empty((0, 3))]
    )
    low = eyes[:, 2] - shot.ground.up(*eyes[:, :2].T) < reach if len(eyes) else np.empty(0, bool)
    if not low.any():
        return np.empty((0, 2), np.int64), np.empty(0)
    blocks = np.unique(np.floor(eyes[low, :2] / _BLOCK).astype(np.int64), axis=0)
    around = int(np.ceil(reach / _BLOCK)) + 1
    ring = np.mgrid[-around : around + 1, -around : around + 1].reshape(2, -1).T
    ring = ring[np.hypot(*ring.T) * _BLOCK < reach + 1.5 * _BLOCK]
    blocks = np.unique((blocks[:, None] + ring).reshape(-1, 2), axis=0)
    middle = (blocks + 0.5) * _BLOCK
    middle = np.column_stack([middle, shot.ground.up(*middle.T)])
    distance = shot.visibility.distance(middle)
    near = distance < reach + _BLOCK
    near[near] = shot.visibility.visible_mask(middle[near], np.full(near.sum(), 1.5 * _BLOCK), shadows=True)
    most = max(40 * budget // count**2, 1)
    chosen = np.flatnonzero(near)
    chosen = np.sort(chosen[np.argsort(distance[chosen], kind="stable")[:most]])
    inside = np.indices((count, count)).reshape(2, -1).T
    cells = (blocks[chosen, None] * count + inside).reshape(-1, 2)
    return cells, np.repeat(distance[chosen] - 0.85 * _BLOCK, count**2)


def _ground(shot: Shot, place: Array) -> tuple[Array, Array, Array, Array]:
    """Canopy fuel, surface fuel, bare rock and water at points (n, 2) in the scene, m."""
    ground = shot.ground
    index = ground.indices(*ground.geodetic(*place.T)) if len(place) else (np.empty(0), np.empty(0))
    return (
        bilinear(ground.fields.canopy_fuel, *index),
        bilinear(ground.fields.surface_fuel, *index),
        bilinear(ground.bare, *index),
        bilinear(ground.water, *index),
    )


def _settled(shot: Shot, instances: Instances) -> Instances:
    """Align lying instances with the slope; drop them on slopes that are too steep."""
    lies = np.flatnonzero(np.isin(instances.model, _LYING))
    if len(lies) == 0:
        return instances
    x, y = instances.position[lies, :2].T
    reach, turn = 3.0 * instances.height[lies], instances.rotation[lies]
    east, north = reach * np.cos(turn), reach * np.sin(turn)

    def ends(dx: Array, dy: Array) -> tuple[Array, Array]:
        return shot.ground.up(x + dx, y + dy), shot.ground.up(x - dx, y - dy)

    (ahead, behind), (left, right) = ends(east, north), ends(-north, east)
    pitch, roll, position = instances.pitch.copy(), instances.roll.copy(), instances.position.copy()
    pitch[lies] = -np.arctan((ahead - behind) / (2.0 * reach))
    roll[lies] = np.arctan((left - right) / (2.0 * reach))
    position[lies, 2] = np.minimum(0.5 * (ahead + behind), position[lies, 2])
    steep = np.maximum(np.abs(np.tan(pitch)), np.abs(np.tan(roll)))
    made = replace(instances, position=position, pitch=pitch, roll=roll)
    return made.take(np.flatnonzero(steep < _STEEPEST))
