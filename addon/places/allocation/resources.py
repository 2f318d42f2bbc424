"""Resources as an allocation reads them, and how long each takes to a place."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

AIR = ("airtanker", "helicopter", "aircraft")
"""Kinds that fly straight; others follow roads."""
DETOUR = 1.4
"""Length of a way on roads by the straight distance; an assumption."""
_EARTH = 6_371_008.8  # m, mean radius


class Resource(Protocol):
    """One resource that can be sent: an engine, a crew, a dozer, an aircraft.

    Attributes
    ----------
    id
        Unique name; ties are broken by it.
    type
        Kind and type of the PMS 200, such as "engine/3" or "crew/IHC".
    line_m_h
        Line that it builds, m/h.
    mobilise_min, speed_km_h
        Time from the order to its departure, and its speed.
    cost_hour
        Cost of an hour, in the list's currency.
    lat, lon
        Where it stands, degrees.
    """

    @property
    def id(self) -> str: ...
    @property
    def type(self) -> str: ...
    @property
    def line_m_h(self) -> float | None: ...
    @property
    def mobilise_min(self) -> float | None: ...
    @property
    def speed_km_h(self) -> float | None: ...
    @property
    def cost_hour(self) -> float | None: ...
    @property
    def lat(self) -> float: ...
    @property
    def lon(self) -> float: ...


class Unit(NamedTuple):
    """A resource of known numbers."""

    id: str
    type: str
    line_m_h: float
    mobilise_min: float
    speed_km_h: float
    cost_hour: float
    lat: float
    lon: float
    name: str = ""
    origin: str = "exercise"
    currency: str = ""


def usable(resources: Iterable[Resource]) -> tuple[list[Resource], list[str]]:
    """Resources in the order of their ids, and why others are left out; no line rate counts as 0."""
    kept, left = [], []
    for each in sorted(resources, key=lambda one: natural(str(one.id))):
        missing = [name for name in ("mobilise_min", "speed_km_h", "cost_hour") if not _known(each, name)]
        if missing:
            left.append(f"{each.id} ({each.type}) has no {' and no '.join(missing)}")
        else:
            kept.append(each)
    return kept, left


def _known(resource: Resource, name: str) -> bool:
    value = getattr(resource, name)
    least = 0.0 if name != "speed_km_h" else np.nextafter(0.0, 1.0)
    return value is not None and bool(np.isfinite(value)) and value >= least


def natural(text: str) -> tuple[tuple[int, str], ...]:
    """Sort key by which 9 comes before 10, and 7-2 before 7-10."""
    return tuple((len(part), part) for part in re.split(r"[-. ]", text))


def is_of(kind: str, wanted: str) -> bool:
    """Whether a type such as "engine/3" is the wanted type, or of the wanted kind "engine"."""
    return kind == wanted or kind.partition("/")[0] == wanted


def minutes(resources: Sequence[Resource], place: ArrayLike) -> NDArray[np.float64]:
    """Minutes (n, k) from the order to the arrival at places (k, 2), degrees.

    Great-circle distance, `DETOUR` times as long on the ground.
    """
    here = np.radians([[each.lat, each.lon] for each in resources]).reshape(-1, 1, 2)
    there = np.radians(np.asarray(place, np.float64))[None]
    half = np.sin(0.5 * (there - here)) ** 2
    chord = half[..., 0] + np.cos(here[..., 0]) * np.cos(there[..., 0]) * half[..., 1]
    distance = 2.0 * _EARTH * np.arcsin(np.sqrt(np.minimum(chord, 1.0)))
    way = np.array([1.0 if each.type.partition("/")[0] in AIR else DETOUR for each in resources])
    speed = np.array([each.speed_km_h for each in resources], np.float64) / 0.06  # m/min
    first = np.array([each.mobilise_min for each in resources], np.float64)
    return first[:, None] + distance * (way / speed)[:, None]
