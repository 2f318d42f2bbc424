"""Biome definition: plants with their density and size, and the colours of land through the year.

Colours are linear reflectances, chosen by eye against photographs, not measured; so are sizes and shares,
unless a source is named.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ....shot.terrain import noise
from . import _ecoregions
from ._ecoregions import Ecoregion

Colour = tuple[float, float, float]
Pair = tuple[Colour, Colour]  # the darkest and the lightest colour
_YEAR = 365.25  # days


@dataclass(frozen=True)
class Land:
    """Land of a run, by which a biome is chosen.

    Attributes
    ----------
    latitude, longitude
        Position of its centre, degrees.
    grass, shrub, wood
        Fractions 0..1 of the ground with fuel that is grass, shrub, and wood (timber litter, slash, any
        canopy).
    """

    latitude: float
    longitude: float
    grass: float
    shrub: float
    wood: float

    @property
    def ecoregion(self) -> Ecoregion:
        """Realm and zone of its centre."""
        return _ecoregions.at(self.latitude, self.longitude)

    def within(self, south: float, north: float, west: float, east: float) -> bool:
        """Return True if its centre is in a box, degrees."""
        return south <= self.latitude <= north and west <= self.longitude <= east


@dataclass(frozen=True)
class Season:
    """Phenology of open land: `high` on the greenest day of the year, `low` in the dry or cold season.

    Attributes
    ----------
    peak
        Day of the year, in the northern hemisphere; half a year later in the southern.
    lasts
        Days from the greenest day to the end of the green season, and from its start to the greenest day.
    """

    peak: float
    lasts: float
    low: float = 0.0
    high: float = 1.0

    def greenness(self, day: float, latitude: float) -> float:
        """Greenness, 0 (dry) to 1 (green), on a day of the year at a latitude (degrees)."""
        peak = self.peak if latitude >= 0.0 else self.peak + 0.5 * _YEAR
        off = abs((day - peak + 0.5 * _YEAR) % _YEAR - 0.5 * _YEAR)
        full = float(noise.smoothstep(self.lasts, 0.35 * self.lasts, np.array(off)))
        return self.low + (self.high - self.low) * full


@dataclass(frozen=True)
class Species:
    """A species of the stand.

    Attributes
    ----------
    models
        Indices of its models in `models`, of equal probability.
    share
        Weight of its number of trees against the other species.
    height
        Ratio to the height of a conifer of the same rank in such a stand (`forest.stand` of the core).
    width
        Ratio to the model's width.
    low, high
        Elevations (m) between which its share goes from 0 to all, or from all to 0 where `low` is the higher
        one; None: everywhere.
    """

    models: tuple[int, ...]
    share: float
    height: float = 1.0
    width: float = 1.0
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class OpenLand:
    """Ground colour without canopy.

    Attributes
    ----------
    bleached, straw, stale
        Dry grass: palest, medium and darkest.
    green, lush
        Growing grass, and grass in wet hollows.
    soil, shrub
        Darkest and lightest.
    bare
        Fraction of the ground where soil shows between grass, in the dry season.
    bush
        Width of a bush, m.
    tussock
        Width of a bunch of grass, m.
    hollows
        Excess of greenness and shrub cover in hollows over crests, 0..1.
    patch
        Size of the largest patches, m.
    tracks
        Distance between tracks of vehicles and cattle, m; 0: none. They are procedural.
    draws
        Distance between shallow valleys cut by water, m, which are green and bushy; 0: none. They are
        procedural.
    field
        Side lengths of fields or paddocks, m; 0: none. They are procedural, and so are hedges.
    tilled
        0: paddocks that differ by grazing, 1: fields, some of them ploughed or mown.
    hedge
        Width of hedges round fields, m.
    """

    bleached: Colour
    straw: Colour
    stale: Colour
    green: Colour
    lush: Colour
    soil: Pair
    shrub: Pair
    bare: float = 0.15
    bush: float = 5.0
    tussock: float = 1.1
    hollows: float = 0.5
    patch: float = 900.0
    tracks: float = 0.0
    draws: float = 0.0
    field: tuple[float, float] = (0.0, 0.0)
    tilled: float = 0.0
    hedge: float = 0.0


@dataclass(frozen=True)
class Plants:
    """Bushes, tufts and other understorey near cameras, relative to `understorey.KINDS`.

    Attributes
    ----------
    density
        Factor on the number, by kind; 1 by default.
    height, width
        Factors on height, and on the ratio of width to height, by kind.
    finer
        Factor on the lattice cells along a side, by kind; a cell holds at most one instance.
    models
        Indices of models that replace the models of `KINDS`, before and after the fire, by kind.
    """

    density: Mapping[str, float] = field(default_factory=dict)
    height: Mapping[str, float] = field(default_factory=dict)
    width: Mapping[str, float] = field(default_factory=dict)
    finer: Mapping[str, float] = field(default_factory=dict)
    models: Mapping[str, tuple[tuple[int, ...], tuple[int, ...]]] = field(default_factory=dict)


@dataclass(frozen=True)
class Biome:
    """A biome.

    Attributes
    ----------
    suits
        Score of its match with a run's land: the biome of the highest score is chosen.
    season
        Phenology of grass.
    needles
        Sunlit crowns, as the ground shows distant forest.
    stands
        Colour that makes up 0.6 of the crowns' colour in some stands.
    shade, between
        Colours of dense clumps, and between crowns.
    crown
        Width of crowns in the distant forest, m.
    leaf_fall
        Season in which deciduous trees lose their leaves: "winter", "drought", or "" if all are evergreen.
    deciduous
        Fraction of the crowns that are deciduous, as the ground shows distant forest.
    withered
        Factor on the colour of such crowns after their leaves have turned.
    litter, scrub
        Ground under trees: dead leaves from afar, and its green plants.
    grass
        Dry and green blades near cameras.
    species
        Trees of the stand; none: species of the core, with oaks in the foothills.
    rows
        Distance between the rows of a plantation, m; 0: no rows.
    tree_cover, shrub_cover
        Fractions of open land under lone trees, and under bushes where its fuel is grass.
    shrub_load
        Surface fuel (kg/m2) at which bushes begin, and at which they cover all, without a fuel category.
    open_land
        None: meadows, soil and brush of the Sierra.
    rock, outcrops
        Factor on the colour of granite; frequency of outcrops that no map shows, 0..1.
    plants
        Changes to the understorey near cameras.
    """

    suits: Callable[[Land], float]
    season: Season
    needles: Pair
    stands: Colour
    shade: Colour
    between: Colour
    crown: float = 13.0
    leaf_fall: str = ""
    deciduous: float = 0.0
    withered: Colour = (1.0, 1.0, 1.0)
    litter: Pair = ((0.019, 0.017, 0.010), (0.062, 0.050, 0.030))
    scrub: Colour = (0.024, 0.033, 0.014)
    grass: Pair = ((0.150, 0.115, 0.055), (0.060, 0.065, 0.028))
    species: tuple[Species, ...] = ()
    rows: float = 0.0
    tree_cover: float = 0.0
    shrub_cover: float = 0.0
    shrub_load: tuple[float, float] = (0.7, 1.4)
    open_land: OpenLand | None = None
    rock: Colour = (1.0, 1.0, 1.0)
    outcrops: float = 1.0
    plants: Plants = field(default_factory=Plants)
