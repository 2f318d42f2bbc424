"""Emissions by kind of fuel: heat of combustion, emission factors, residence time and look of the smoke.

Emission factors of particles under 2.5 um (PM2.5) and of carbon monoxide are from S. P. Urbanski (2014,
"Wildland fire emissions, carbon, and climate: Emission factors", Forest Ecology and Management 317, 51-60),
as the fire effects model FOFEM 6 tabulates them: grassland 8.5, shrubland 7.1, western forest in prescribed
fires 17.6 and in wildfires 23.2, and of residual smouldering wood 33.0 and duff 35.3 g of PM2.5 per kg of
dry fuel. M. O. Andreae (2019, doi 10.5194/acp-19-8523-2019) reviews others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ...run import fuel_category

_CO_HEAT = 10.1e6  # J/kg, heat of combustion of carbon monoxide
# m2/kg, mass extinction of fresh smoke in green light (Reid et al. 2005, doi 10.5194/acp-5-799-2005)
EXTINCTION = 4000.0
_PLAIN = 0.02  # kg/kg, PM2.5 emission factor of unknown fuel (WRF-SFIRE's fire_tracer_smoke)
PLAIN = _PLAIN / constants.HEAT_OF_COMBUSTION
"""kg/J, reference smoke per heat. The look of a solved flow's smoke was tuned by eye with it."""

GRASS, SHRUB, LITTER, CROWN = range(4)
"""Kinds of fuel: grass; shrubs; forest floor (litter, duff and wood); crowns."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FuelKind:
    """Combustion and smoke properties of a kind of fuel.

    Attributes
    ----------
    name
        Name in words.
    smoke
        Emission factor of PM2.5, kg per kg of fuel: flaming, smouldering.
    monoxide
        Emission factor of CO in smouldering, kg per kg of fuel; its heat is not released.
    residence
        Residence time of flames at a spot, s.
    burn_out
        Burn-out time: s, plus s for each kg/m2 of fuel, until smouldering fuel is down to 1/e.
    embers
        Decay time of glowing embers in the ash, s to 1/e.
    gain
        Factor on the smoke's extinction, relative to a crown fire with `PLAIN` smoke.
    dark
        0..1, darkness of fresh smoke, relative to the brown base of a crown fire's plume.
    white
        Single-scattering albedo of aged smoke in green light.
    ash
        0..1, brightness of the ash.
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
        """Heat of combustion, J per kg of fuel: flaming, smouldering."""
        return constants.HEAT_OF_COMBUSTION, constants.HEAT_OF_COMBUSTION - _CO_HEAT * self.monoxide


# Emission factors: litter that burns behind the front is half prescribed fire of western forest and half
# residual smouldering (mean of wood and duff), as wood still has flames then (assumed). Crowns are wildfires
# of western forest. For grass and shrubs Urbanski's means cover both phases, smouldering included. Residence
# time: grass 15 s (measured by the fire laboratory of the University of Toronto, "Grass fire behaviour and
# flame"); others assumed. Burn-out time: grass and brush use the weights 7 and 100 to 180 of WRF-SFIRE over
# 0.8514; litter 210 s at 0.3 kg/m2 and 1020 s at 3 kg/m2, as its 180 and 900. Albedo: grass near the 0.84 of
# Reid et al. (2005), as its hot flames make more soot; shrubs assumed; forest chosen by eye for aged haze.
# Gain: 0.3 draws the smoke of a flow with 0.8 to 1.1 times its mass. Grass smoke has 0.8 times that: 6.7 g of
# PM2.5 per kg of fuel (savanna and grassland, Andreae 2019) instead of 8.5. Forest smoke, chosen by eye, has
# three times its mass, for ash and droplets; shrubs between. Darkness and ash are chosen by eye.
KINDS = (
    FuelKind("grass", (0.0085, 0.0085), 0.0, 15.0, (8.0, 0.0), 90.0, 0.24, 0.12, 0.86, 0.35),
    FuelKind("shrub", (0.0071, 0.0071), 0.0, 45.0, (100.0, 45.0), 600.0, 0.45, 0.5, 0.90, 0.8),
    FuelKind("litter", (0.0176, 0.0259), 0.174, 120.0, (120.0, 300.0), 3600.0, 0.78, 1.0, 0.945, 0.6),
    FuelKind("crowns", (0.0232, 0.0232), 0.0, 120.0, (90.0, 0.0), 3600.0, 0.79, 1.0, 0.945, 0.6),
)

# kg/m2, largest surface fuel without canopy that counts as grass: the heaviest of Anderson's 1 to 3
_GRASS_MOST = 0.6
_LEAST_CANOPY = 0.05  # kg/m2, canopy fuel from which the surface fuel counts as litter (assumed)


_OF_CATEGORY = {
    fuel_category.GRASS: GRASS,
    fuel_category.SHRUB: SHRUB,
    fuel_category.LITTER: LITTER,
    fuel_category.SLASH: LITTER,
}


def kind(surface: ArrayLike, canopy: ArrayLike, category: ArrayLike | None = None) -> NDArray[np.int8]:
    """Kind of the surface fuel (kg/m2).

    The fuel model number (`category`) decides if it is burnable. Else the surface fuel and the
    canopy fuel above it (kg/m2) decide.
    """
    open_ground = np.where(np.asarray(surface) > _GRASS_MOST, SHRUB, GRASS)
    result = np.where(np.asarray(canopy) > _LEAST_CANOPY, LITTER, open_ground).astype(np.int8)
    if category is not None:
        known = fuel_category.kinds(np.asarray(category))
        for of, what in _OF_CATEGORY.items():
            result[known == of] = what
    return result


def of_run(run: Run) -> NDArray[np.int8]:
    """Kind of surface fuel (fy, fx) in a run."""
    has_category = run.has(fuel_category.FIELD)
    category = run.fuel_rows(fuel_category.FIELD, 0, len(run.fuel_latitude)) if has_category else None
    return kind(run.surface_fuel, run.canopy_fuel, category)


def column(name: str, part: int | None = None) -> Array:
    """Lookup table of one attribute by kind; `part` selects an entry of a pair."""
    values = [getattr(each, name) for each in KINDS]
    return np.array([each[part] if part is not None else each for each in values], np.float64)


def burn_out(surface: ArrayLike, kinds: ArrayLike) -> Array:
    """Burn-out time of a surface fuel load (kg/m2) of these kinds, s."""
    kinds = np.asarray(kinds)
    return column("burn_out", 0)[kinds] + column("burn_out", 1)[kinds] * np.asarray(surface, np.float64)


# W, fire power at which ash and droplets in the column begin and are complete (by eye)
_COLUMN = 1.0e9, 5.0e10
_PLAIN_GAIN = 0.3  # gain of smoke without them, at most


@dataclass(frozen=True)
class Mix:
    """Smoke mixed from several kinds of fuel.

    Attributes
    ----------
    shares
        (4,) mass fractions of the kinds.
    per_heat
        kg of PM2.5 per J of heat.
    power
        Fire power, W. The column of a strong fire lifts ash and forms droplets.
    """

    shares: Array
    per_heat: float
    power: float = _COLUMN[1]

    @property
    def dark(self) -> float:
        """Darkness of the plume's base, 0..1."""
        return float(self.shares @ column("dark"))

    @property
    def residence(self) -> float:
        """Mean residence time of flames, s."""
        return float(self.shares @ column("residence"))

    @property
    def white(self) -> float:
        """Single-scattering albedo of aged smoke."""
        return float(self.shares @ column("white"))

    @property
    def dilution(self) -> float:
        """Smoke per heat relative to the reference `PLAIN`: the dilution at equal temperature."""
        return self.per_heat / PLAIN

    @property
    def opacity(self) -> float:
        """Extinction relative to the reference smoke at equal temperature."""
        strong = np.log(max(self.power, _COLUMN[0]) / _COLUMN[0]) / np.log(_COLUMN[1] / _COLUMN[0])
        full = float(self.shares @ column("gain"))
        plain = min(_PLAIN_GAIN, full)
        return self.dilution * float(plain + min(strong, 1.0) * (full - plain))


def mix(smoke: ArrayLike, heat: float, power: float = _COLUMN[1]) -> Mix:
    """Mix from the smoke (kg) of each kind (4,) and the heat (J); a crown fire's without any smoke.

    `power` (W) is the fire's total heat release rate.
    """
    smoke = np.asarray(smoke, np.float64)
    total = float(smoke.sum())
    if not total > 0.0 or not heat > 0.0:
        return Mix(np.eye(len(KINDS))[CROWN], PLAIN)
    return Mix(smoke / total, total / heat, power)
