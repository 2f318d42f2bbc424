"""Biomes: each module of this folder defines one, unless its name begins with "_".

It defines `BIOME`, a `Biome`, and the first line of its docstring is the biome's description. Without
Blender.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
from firetwin_core.run import Run

from .... import plugins
from ....run import blocks, fuel_category, times
from ....shot.fire import emissions
from ....shot.shot import Shot, cached_on_shot
from .. import phenology
from ..phenology import LeafState
from ._biome import Biome, Colour, Land, OpenLand, Plants, Season, Species

__all__ = [
    "Biome",
    "Colour",
    "Land",
    "LeafState",
    "OpenLand",
    "Plants",
    "Season",
    "ShotBiome",
    "Species",
    "chosen",
    "known",
    "of",
]

_ENOUGH = 160  # rows or columns of the grid that are sampled for the land
_CANOPY, _NOTHING = 0.01, 0.02  # kg/m2: canopy at which ground is wooded, and load that counts as no fuel
_SHRUB = 0.9  # kg/m2 of surface fuel without canopy at which it counts as shrub, without a category (assumed)
_CURED = 0.12  # greenness at most of grass that carries a fire; about a tenth of it is alive (assumed)
_DRY = 0.40  # greenness at most of grass where only litter, shrubs or crowns burn (assumed)
_GRASS_BURNS = 0.02  # fraction of the burned land that is grass from which grass carries the fire (assumed)
_CHOSEN: WeakKeyDictionary[Run, str] = WeakKeyDictionary()


@dataclass(frozen=True)
class ShotBiome:
    """A shot's biome, as set.

    Attributes
    ----------
    name
        Name of the biome.
    green
        Greenness of grass, 0: dry, 1: green.
    leaves
        State of deciduous leaves.
    """

    name: str
    biome: Biome
    green: float
    leaves: LeafState


@functools.cache
def known() -> dict[str, Biome]:
    """All biomes by name."""
    return plugins.values(__name__, "BIOME")


@cached_on_shot
def choose(shot: Shot) -> ShotBiome:
    """Select the biome of a shot: the one in the settings, or the best match for the run's land.

    Grass that burns is cured: the date alone decides its greenness only in a run without fire.
    """
    run, forest = shot.run, shot.settings.forest
    name = forest.biome if forest.biome != "auto" else _auto(run)
    biome = known()[name]
    if forest.tree_cover is not None:
        biome = replace(biome, tree_cover=forest.tree_cover)
    if forest.shrub_cover is not None:
        biome = replace(biome, shrub_cover=forest.shrub_cover)
    latitude = 0.5 * float(run.latitude[0] + run.latitude[-1])
    day = times.utc(run, float(shot.frames.first)).timetuple().tm_yday
    season = biome.season.greenness(day, latitude)
    leaves = phenology.of_kind(biome.leaf_fall, day, latitude, season)
    green = season if forest.greenness is None else forest.greenness
    if forest.greenness is None and season > _CURED:
        green = min(season, _greenest(shot))
    return ShotBiome(name, biome, green, leaves)


def _greenest(shot: Shot) -> float:
    """Greenness at most, by the fuel that burns in the run at any time, so that all shots of a run agree."""
    burned = emissions.of_run(shot.run)[np.isfinite(shot.arrival)]
    if not burned.size:
        return 1.0
    return _CURED if float(np.mean(burned == emissions.GRASS)) > _GRASS_BURNS else _DRY


def _auto(run: Run) -> str:
    if run not in _CHOSEN:
        _CHOSEN[run] = chosen(land(run))
    return _CHOSEN[run]


def chosen(land: Land) -> str:
    """Name of the biome that best matches a land."""
    return max(known(), key=lambda name: known()[name].suits(land))


def land(run: Run) -> Land:
    """Land of a run: location, and cover of grass, shrub and wood by fuel category, or else by fuel loads."""
    count = np.zeros(3)
    step = max(min(len(run.fuel_latitude), len(run.fuel_longitude)) // _ENOUGH, 1)
    for first, end in blocks.rows(run):
        canopy = np.nan_to_num(run.fuel_rows("canopy_fuel", first, end)[::step, ::step]) > _CANOPY
        surface = np.nan_to_num(run.fuel_rows("surface_fuel", first, end)[::step, ::step])
        kind = np.select([canopy, surface > _SHRUB, surface > _NOTHING], [2, 1, 0], -1)
        if run.has(fuel_category.FIELD):
            said = fuel_category.kinds(run.fuel_rows(fuel_category.FIELD, first, end)[::step, ::step])
            by_kind = np.array([-1, 0, 1, 2, 2, -1])[said]
            kind = np.where(said == fuel_category.UNKNOWN, kind, np.where(canopy, 2, by_kind))
        count += np.bincount(kind[kind >= 0], minlength=3)
    grass, shrub, wood = count / max(count.sum(), 1.0)
    latitude, longitude = (0.5 * float(axis[0] + axis[-1]) for axis in (run.latitude, run.longitude))
    return Land(latitude, longitude, grass, shrub, wood)
