"""Resources for an allocation, with their travel times and costs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..stations.distance import distance_km
from ..stations.measures import travel_minutes, unit_cost
from ..stations.records import AIR

Array = NDArray[np.float64]


class Unit(NamedTuple):
    """Resource that can be sent: an engine, a crew, a dozer, an aircraft. None: unknown.

    Attributes
    ----------
    id
        Unique name; ties go to lower ids.
    type
        Kind and type of PMS 200, such as "engine/3" or "crew/IHC".
    line_m_h
        Line production rate, m/h.
    mobilise_min, speed_km_h
        Time from the order to the departure, and travel speed.
    cost_hour, cost_mobilise, cost_day
        Cost per hour, of mobilisation and per day, in `currency`.
    lat, lon
        Position of its station, degrees.
    name, station
        Name of the unit, and of its station.
    """

    id: str
    type: str
    line_m_h: float | None
    mobilise_min: float | None
    speed_km_h: float | None
    cost_hour: float | None
    lat: float
    lon: float
    name: str = ""
    origin: str = "exercise"
    currency: str = ""
    cost_mobilise: float | None = None
    cost_day: float | None = None
    station: str = ""

    @property
    def title(self) -> str:
        """Name, or id without a name."""
        return self.name or self.id


def select_usable(units: Iterable[Unit]) -> tuple[list[Unit], list[str]]:
    """Return the usable units in the order of ids, and messages on omitted ones.

    A missing line rate counts as 0.
    """
    kept, left = [], []
    for each in sorted(units, key=lambda one: natural_key(one.id)):
        missing = [name for name in ("mobilise_min", "speed_km_h") if not _is_known(each, name)]
        if not (_is_known(each, "cost_hour") or _is_known(each, "cost_day")):
            missing.append("cost_hour")
        if missing:
            left.append(f"{each.title} ({each.type}) has no {' and no '.join(missing)}")
        else:
            kept.append(each)
    return kept, left


def _is_known(unit: Unit, name: str) -> bool:
    value = getattr(unit, name)
    least = 0.0 if name != "speed_km_h" else np.nextafter(0.0, 1.0)
    return value is not None and bool(np.isfinite(value)) and value >= least


def natural_key(text: str) -> tuple[tuple[int, str], ...]:
    """Return a sort key that puts 9 before 10, and 7-2 before 7-10."""
    return tuple((len(part), part) for part in re.split(r"[-. ]", text))


def is_of(kind: str, wanted: str) -> bool:
    """Return True if a type such as "engine/3" is the wanted type or of the wanted kind "engine"."""
    return kind == wanted or kind.partition("/")[0] == wanted


def field_values(units: Sequence[Unit], name: str) -> Array:
    """Return a numeric field (n,) of units; NaN: unknown."""
    found = (getattr(each, name) for each in units)
    return np.array([np.nan if each is None else each for each in found], np.float64)


def period_costs(units: Sequence[Unit], hours: float) -> Array:
    """Compute the cost (n,) of mobilisation and hours of work, as in a search."""
    mobilise, hour, day = (field_values(units, f"cost_{name}") for name in ("mobilise", "hour", "day"))
    return unit_cost(mobilise, hour, day, hours)


def travel_times(units: Sequence[Unit], place: ArrayLike) -> Array:
    """Compute the time (n, k), min, from the order to the arrival at points (k, 2), degrees."""
    at, spots = (
        (field_values(units, "lat"), field_values(units, "lon")),
        np.asarray(place, np.float64).reshape(-1, 2),
    )
    air = np.array([each.type.partition("/")[0] in AIR for each in units], bool)
    speed, first = field_values(units, "speed_km_h"), field_values(units, "mobilise_min")
    found = np.empty((len(units), len(spots)))
    for k, (latitude, longitude) in enumerate(spots.tolist()):
        far = distance_km(*at, (latitude, longitude))
        found[:, k] = travel_minutes(far, air, speed, first)
    return found
