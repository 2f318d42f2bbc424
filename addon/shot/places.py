"""Places of a shot: what signs, buildings and routes of stations show, and where the fire began and is.

Everything of an exercise says so: a sign whose station or resources are an exercise's has `EXERCISE` on it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import metres_per_degree
from ..errors import input_error
from ..run import areas
from ..run.content import sha256
from ..run.observations import Detections, Feature, features
from . import stations_file
from .cameras import targets
from .settings import scene_file
from .settings.settings import Settings
from .shot import Shot
from .stations_file import Resource, Station
from .terrain.terrain import Terrain

EXERCISE = "Exercise: not operational advice"
FACT, INVENTED, USER = stations_file.ORIGINS

_AIR = ("airtanker", "helicopter")  # kinds that fly straight
_DETOUR = 1.4  # length of roads by straight distance (assumed)
_TYPES = 3  # types of resources that a sign lists
_BESIDE = 120.0  # m from a station to the nearest corner of its own building
_ABOVE = 100.0  # m, height of the head over the ground

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sign:
    """What is shown of a station.

    Attributes
    ----------
    latitude, longitude
        Degrees north and east.
    lines
        Below the name.
    origin
        "fact", "exercise" or "user"; "exercise" where anything of it is.
    footprint
        Outline of its building (n, 2), degrees east and north; None: not known.
    """

    name: str
    kind: str
    latitude: float
    longitude: float
    lines: tuple[str, ...]
    origin: str
    footprint: Array | None = None

    @property
    def exercise(self) -> bool:
        """Whether anything of it was invented for an exercise."""
        return self.origin == INVENTED


@dataclass(frozen=True)
class Route:
    """A line (n, 2), degrees east and north, and the origin of what goes along it."""

    line: Array
    origin: str


class Moving(NamedTuple):
    """Scene positions, m: where the fire began (3,), or None, and its head at each frame (frames, 3)."""

    ignition: Array | None
    head: Array


def signs(shot: Shot) -> list[Sign]:
    """Signs of the stations on the run's ground; none where stations are off.

    Raises
    ------
    InputError
        A file cannot be read.
    """
    settings = shot.settings.stations
    if not settings.enabled or settings.file is None:
        return []
    stations, resources = stations_file.read(settings.file)
    here = [station for station in stations if covers(shot.ground, station.latitude, station.longitude)]
    outlines = _outlines(shot.settings)
    began = ignition(shot)
    own: dict[int, list[Resource]] = {}
    for resource in resources:
        own.setdefault(resource.station, []).append(resource)
    return [_sign(settings.show, each, own.get(each.id, []), began, outlines) for each in here]


def routes(shot: Shot, shown: Iterable[Sign]) -> list[Route]:
    """The user's lines, or else straight ones from the stations to the ignition; none where routes are off.

    Raises
    ------
    InputError
        The user's file cannot be read, or has no lines.
    """
    settings = shot.settings.stations
    if not settings.enabled:
        return []
    if settings.routes_file is not None:
        drawn = _features(settings.routes_file)
        lines = [Route(line, _origin(each)) for each in drawn for line in each.lines if len(line) > 1]
        if not lines:
            raise input_error(settings.routes_file, 0, 0, "has no lines; draw routes as LineString features")
        return lines
    began = ignition(shot)
    if not settings.routes or began is None:
        return []
    end = (began[1], began[0])
    return [Route(np.array([(each.longitude, each.latitude), end]), each.origin) for each in shown]


def ignition(shot: Shot) -> tuple[float, float] | None:
    """Latitude and longitude of the fuel cell that burns first; None where nothing burns."""
    if not np.isfinite(shot.arrival).any():
        return None
    row, column = np.unravel_index(np.nanargmin(shot.arrival), shot.arrival.shape)
    return float(shot.run.fuel_latitude[row]), float(shot.run.fuel_longitude[column])


def moving(shot: Shot) -> Moving:
    """Where the fire began and where its head is."""
    began, ground = ignition(shot), shot.bare_ground
    head = targets.follow("head", ground, shot.frames.times, _ABOVE)
    return Moving(None if began is None else ground.point(*began)[0], head)


def covers(ground: Terrain, latitude: float, longitude: float) -> bool:
    """Whether a point lies on the ground of the scene."""
    axes, at = (ground.fields.latitude, ground.fields.longitude), (latitude, longitude)
    return all(axis.min() <= each <= axis.max() for axis, each in zip(axes, at, strict=True))


def inputs(settings: Settings) -> dict[str, str]:
    """Hashes of the user's files of stations."""
    known = settings.stations
    if not known.enabled:
        return {}
    files = {"stations": known.file, "footprints": known.footprints, "routes": known.routes_file}
    return {name: sha256(path)[:16] for name, path in files.items() if path is not None}


def check(settings: Settings) -> None:
    """Read the user's files.

    Raises
    ------
    InputError
        One cannot be read, or there is none.
    """
    known = settings.stations
    if not known.enabled:
        return
    if known.file is None and known.routes_file is None:
        reason = "stations.enabled needs stations.file, a GeoPackage of stations, or stations.routes_file"
        raise scene_file.error_at(settings.path, ("stations", "enabled"), reason)
    if known.file is not None:
        stations_file.read(known.file)
    for path in (known.footprints, known.routes_file):
        if path is not None:
            _features(path)


def summary(resources: Iterable[Resource]) -> str:
    """``2 x engine/3, 1 x dozer/2 and 2 more types``; empty without any."""
    counted: Counter[str] = Counter()
    for each in resources:
        counted[each.type] += each.count
    words = [f"{number} x {type_}" for type_, number in counted.most_common(_TYPES)]
    more = len(counted) - _TYPES
    return ", ".join(words) + (f" and {more} more type{'s' * (more > 1)}" if more > 0 else "")


def minutes(station: Station, resources: Iterable[Resource], to: tuple[float, float]) -> float | None:
    """Least time from the order to the arrival, min; None where no resource has a speed.

    Air goes straight, the ground `_DETOUR` times as far; distances on a plane, within 1 % to 100 km.
    """
    north, east = metres_per_degree(0.5 * (station.latitude + to[0]))
    turned = float(areas.turned(station.longitude, to[1]))
    far = float(np.hypot((station.latitude - to[0]) * north, (turned - to[1]) * east)) / 1000.0
    found = [
        (each.mobilise_min or 0.0)
        + 60.0 * far * (1.0 if each.type.partition("/")[0] in _AIR else _DETOUR) / each.speed_km_h
        for each in resources
        if each.speed_km_h
    ]
    return min(found, default=None)


def _sign(
    show: tuple[str, ...],
    station: Station,
    resources: list[Resource],
    began: tuple[float, float] | None,
    outlines: list[Array],
) -> Sign:
    lines = [station.kind] if "kind" in show and station.kind else []
    told = False  # whether something of the resources is shown
    if "resources" in show and (text := summary(resources)):
        lines.append(text)
        told = True
    if "minutes" in show and began is not None and (least := minutes(station, resources, began)) is not None:
        lines.append(f"{least:.0f} min to the ignition")
        told = True
    origins = {station.origin} | ({each.origin for each in resources} if told else set())
    origin = next(each for each in (INVENTED, USER, FACT) if each in origins)
    if origin == INVENTED:
        lines.append(EXERCISE)
    outline = _outline(outlines, station.latitude, station.longitude)
    return Sign(
        station.name, station.kind, station.latitude, station.longitude, tuple(lines), origin, outline
    )


def _outlines(settings: Settings) -> list[Array]:
    path = settings.stations.footprints
    return [] if path is None else [rings[0] for each in _features(path) for rings in each.polygons]


def _outline(outlines: list[Array], latitude: float, longitude: float) -> Array | None:
    """The outline whose nearest corner is nearest to a station, within `_BESIDE`."""
    north, east = metres_per_degree(latitude)
    best, found = _BESIDE, None
    for ring in outlines:
        turned = areas.turned(ring[:, 0], longitude)
        far = float(np.hypot((turned - longitude) * east, (ring[:, 1] - latitude) * north).min())
        if far < best:
            best, found = far, ring
    return found


def _features(path: Path) -> list[Feature]:
    found = features(path)
    if isinstance(found, Detections):
        raise input_error(path, 0, 0, "holds points of satellites; name a file of lines or polygons")
    return found


def _origin(feature: Feature) -> str:
    given = str(feature.properties.get("origin", USER))
    return given if given in stations_file.ORIGINS else USER
