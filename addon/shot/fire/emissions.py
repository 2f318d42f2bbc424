"""What each kind of fuel gives as it burns: heat, smoke, and how that looks; a row of numbers for each.

Emission factors of particles under 2.5 um (PM2.5) and of carbon monoxide are those of S. P. Urbanski (2014,
"Wildland fire emissions, carbon, and climate: Emission factors", Forest Ecology and Management 317, 51-60),
as the fire effects model FOFEM 6 tabulates them: grassland 8.5, shrubland 7.1, western forest in prescribed
fires 17.6 and in wildfires 23.2, and of residual smouldering wood 33.0 and duff 35.3 g of PM2.5 per kg of
dry fuel. M. O. Andreae (2019, doi 10.5194/acp-19-8523-2019) reviews others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ...run import fuel_category
from ...run.models import fuels

HEAT = fuels.HEAT  # J/kg: what runs' heat is made with, whatever the fuel
_OF_CO = 10.1e6  # J/kg, heat that carbon monoxide would give if it burned
EXTINCTION = 4000.0  # m2/kg of fresh smoke in green light (Reid et al. 2005, doi 10.5194/acp-5-799-2005)
_PLAIN = 0.02  # kg/kg of burned fuel, where none is known (WRF-SFIRE's fire_tracer_smoke)
PLAIN = _PLAIN / HEAT
"""kg/J. The looks of a solved flow's smoke were chosen by eye with it."""

GRASS, SHRUB, LITTER, CROWN = range(4)
"""Kinds of fuel: grass; shrubs; litter, duff and wood on a forest's floor; and the crowns over it."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Kind:
    """How a kind of fuel burns.

    Attributes
    ----------
    name
        In words.
    smoke
        kg of PM2.5 per kg of fuel, flaming and smouldering.
    monoxide
        kg of CO per kg of fuel, smouldering: the heat that is lacking then.
    residence
        s that flames stand over a spot.
    burn_out
        s, and s for each kg/m2, in which smouldering fuel is down to 1/e.
    embers
        s in which spots that glow in the ash are down to 1/e.
    gain
        Of the smoke's extinction, beside that which was chosen for a crown fire with `PLAIN` smoke.
    dark
        0..1, how much of the dark brown of a crown fire's base fresh smoke has.
    white
        Albedo of its smoke that has spread, in green light.
    ash
        0..1, how pale what is left is.
    """

    name: str
    smoke: tuple[float, float]
    monoxide: float
    residence: float
    burn_out: tuple[float, float]
    embers: float
    gain: float
    dark: float
    white: float
    ash: float

    @property
    def heat(self) -> tuple[float, float]:
        """J per kg of fuel, flaming and smouldering."""
        return HEAT, HEAT - _OF_CO * self.monoxide


# Litter that burns on behind the front counts half as prescribed fires of western forest and half as
# residual smouldering, the mean of wood's and duff's: wood still has flames then (assumed). Crowns are as
# wildfires of western forest. Smouldering of grass and shrubs is in Urbanski's means of both phases.
# Residence: of grass 15 s (measured by the fire laboratory of the University of Toronto, "Grass fire
# behaviour and flame"), of the others assumed. Burn-out: of grass and brush the weights 7 and 100 to 180 of
# WRF-SFIRE over 0.8514, of litter 210 s at 0.3 kg/m2 and 1020 s at 3 kg/m2, as its 180 and 900. Albedo: of
# grass, whose hot flames make more soot, near the 0.84 of Reid et al. (2005); of shrubs assumed; of forest
# as it was chosen by eye for aged haze. Gain: of grass such that a flow's smoke is drawn with 0.8 to 1.1
# times its mass; of forest such that it is as it was chosen by eye, three times its mass, for ash and
# droplets; of shrubs between. Darkness and ash are chosen by eye.
KINDS = (
    Kind("grass", (0.0085, 0.0085), 0.0, 15.0, (8.0, 0.0), 90.0, 0.30, 0.12, 0.86, 0.35),
    Kind("shrub", (0.0071, 0.0071), 0.0, 45.0, (100.0, 45.0), 600.0, 0.55, 0.5, 0.90, 0.8),
    Kind("litter", (0.0176, 0.0259), 0.174, 120.0, (120.0, 300.0), 3600.0, 0.78, 1.0, 0.945, 0.6),
    Kind("crowns", (0.0232, 0.0232), 0.0, 120.0, (90.0, 0.0), 3600.0, 0.79, 1.0, 0.945, 0.6),
)

_GRASS_MOST = 0.6  # kg/m2 of surface fuel without canopy that is grass: the heaviest of Anderson's 1 to 3
_UNDER = 0.05  # kg/m2 of canopy from which what lies under it is litter (assumed)


_OF_CATEGORY = {
    fuel_category.GRASS: GRASS,
    fuel_category.SHRUB: SHRUB,
    fuel_category.LITTER: LITTER,
    fuel_category.SLASH: LITTER,
}


def kind(surface: ArrayLike, canopy: ArrayLike, category: ArrayLike | None = None) -> NDArray[np.int8]:
    """The kind of surface fuel (kg/m2).

    That of the fuel model's number (`category`), where there is one that burns; else by how much there is of
    it, and of canopy over it (kg/m2).
    """
    open_ground = np.where(np.asarray(surface) > _GRASS_MOST, SHRUB, GRASS)
    found = np.where(np.asarray(canopy) > _UNDER, LITTER, open_ground).astype(np.int8)
    if category is not None:
        known = fuel_category.kinds(np.asarray(category))
        for of, what in _OF_CATEGORY.items():
            found[known == of] = what
    return found


def of_run(run: Run) -> NDArray[np.int8]:
    """(fy, fx) kind of the surface fuel of a run."""
    told = run.has(fuel_category.FIELD)
    category = run.fuel_rows(fuel_category.FIELD, 0, len(run.fuel_latitude)) if told else None
    return kind(run.surface_fuel, run.canopy_fuel, category)


def column(name: str, part: int | None = None) -> Array:
    """One attribute of all kinds, to be looked up by kind; of a pair its first or second."""
    found = [getattr(each, name) for each in KINDS]
    return np.array([each[part] if part is not None else each for each in found], np.float64)


def burn_out(surface: ArrayLike, kinds: ArrayLike) -> Array:
    """Burn-out time (s) of so much surface fuel (kg/m2) of these kinds."""
    return column("burn_out", 0)[kinds] + column("burn_out", 1)[kinds] * np.asarray(surface, np.float64)


_COLUMN = 1.0e9, 5.0e10  # W of fires whose columns begin to have ash and droplets, and have all (by eye)


@dataclass(frozen=True)
class Mix:
    """Smoke of several kinds of fuel.

    Attributes
    ----------
    shares
        (4,) of its mass.
    per_heat
        kg per J of heat.
    power
        W of the fire: a strong one's column takes ash up and makes droplets.
    """

    shares: Array
    per_heat: float
    power: float = _COLUMN[1]

    @property
    def dark(self) -> float:
        """How dark its base is, 0..1."""
        return float(self.shares @ column("dark"))

    @property
    def residence(self) -> float:
        """How long (s) flames stand over a spot, in the mean."""
        return float(self.shares @ column("residence"))

    @property
    def white(self) -> float:
        """Albedo of it when it has spread."""
        return float(self.shares @ column("white"))

    @property
    def dilution(self) -> float:
        """Smoke of a watt beside that which looks were chosen with: as warm, it is so much thinner."""
        return self.per_heat / PLAIN

    @property
    def opacity(self) -> float:
        """Of its extinction, beside that of smoke which looks were chosen with, as warm."""
        strong = np.log(max(self.power, _COLUMN[0]) / _COLUMN[0]) / np.log(_COLUMN[1] / _COLUMN[0])
        plain, full = KINDS[GRASS].gain, float(self.shares @ column("gain"))
        return self.dilution * float(plain + min(strong, 1.0) * (full - plain))


def mix(smoke: ArrayLike, heat: float, power: float = _COLUMN[1]) -> Mix:
    """The mix of so much smoke (kg) of each kind (4,) with so much heat (J); without any a crown fire's.

    `power` (W) is the fire's.
    """
    smoke = np.asarray(smoke, np.float64)
    total = float(smoke.sum())
    if not total > 0.0 or not heat > 0.0:
        return Mix(np.eye(len(KINDS))[CROWN], PLAIN)
    return Mix(smoke / total, total / heat, power)
