"""Station signs of a shot: content of signs, buildings and routes, ignition point, and head of the fire.

A sign is labelled with `EXERCISE` if its station or one of its resources belongs to an exercise.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ... import limits
from ...ellipsoid import metres_per_degree
from ...errors import input_error
from ...run import areas
from ...run.content import sha256
from ...stations import arrival_text, fire_arrival, measures, reading
from ...stations.describe import count_types
from ...stations.records import EXERCISE, ORIGINS, Resource, Station
from ...stations.station_file import StationFile
from ..cameras import targets
from ..schema import scene_text
from ..settings import Settings
from ..shot import Shot
from . import drawn_routes
from .drawn_routes import Route, read_features

FACT, INVENTED, USER = ORIGINS

_LONGEST = 80  # characters of a name on a sign
_TYPES = 3  # types of resources that a sign lists
_BESIDE = 120.0  # maximum distance from a station to the nearest corner of its building, m
_ABOVE = 100.0  # height of the head above the ground, m

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sign:
    """Sign of a station.

    Attributes
    ----------
    latitude, longitude
        Degrees north and east.
    lines
        Lines below the name.
    origin
        "fact", "exercise" or "user"; "exercise" if any part of the content is.
    footprint
        Outline of its building (n, 2), degrees east and north; None: unknown.
    id
        Number in the file.
    """

    name: str
    kind: str
    latitude: float
    longitude: float
    lines: tuple[str, ...]
    origin: str
    footprint: Array | None = None
    id: int = 0

    @property
    def exercise(self) -> bool:
        """True if a part of the content was invented for an exercise."""
        return self.origin == INVENTED


class MovingPoints(NamedTuple):
    """Scene positions, m: ignition (3,), or None, and head of the fire at each frame (frames, 3)."""

    ignition: Array | None
    head: Array


def make_signs(shot: Shot) -> list[Sign]:
    """Make the signs of the stations on the ground of the run; none if stations are off.

    Raises
    ------
    InputError
        A file cannot be read, or has too many stations there.
    """
    settings = shot.settings.stations
    if not settings.enabled or settings.file is None:
        return []
    station_file = reading.read(settings.file)
    axes = shot.ground.fields.latitude, shot.ground.fields.longitude
    here = _within(settings.file, station_file.stations, *axes)
    outlines, minutes, fire = _outlines(shot.settings), _minutes(shot, station_file, here), _fire(shot, here)
    boxes = bounds(outlines)
    return [
        _sign(
            settings.show,
            station,
            station_file.resources_of[station.id],
            least,
            arrival,
            nearest_outline(outlines, boxes, station.latitude, station.longitude),
        )
        for station, least, arrival in zip(here, minutes, fire, strict=True)
    ]


def make_routes(shot: Shot, shown: Iterable[Sign]) -> list[Route]:
    """Return the lines of the user, or straight lines from stations to the ignition; none if routes are off.

    Raises
    ------
    InputError
        The user's file cannot be read, has no lines or too many.
    """
    settings = shot.settings.stations
    if not settings.enabled:
        return []
    if settings.routes_file is not None:
        return drawn_routes.read(settings.routes_file)
    began = ignition_point(shot)
    if not settings.routes or began is None:
        return []
    end = (began[1], began[0])
    return [Route(np.array([(each.longitude, each.latitude), end]), each.origin) for each in shown]


def ignition_point(shot: Shot) -> tuple[float, float] | None:
    """Return the mean position of the fuel cells that burn first, degrees; None if nothing burns."""
    return fire_arrival.first_burned_point(shot.run)


def find_moving_points(shot: Shot) -> MovingPoints:
    """Return the positions of ignition and head."""
    began, ground = ignition_point(shot), shot.bare_ground
    head = targets.follow("head", ground, shot.frames.times, _ABOVE)
    return MovingPoints(None if began is None else ground.point(*began)[0], head)


def _within(path: Path, stations: Iterable[Station], latitude: Array, longitude: Array) -> list[Station]:
    """List the stations of a file within the axes of a grid, degrees.

    Raises
    ------
    InputError
        They are too many.
    """
    (south, north), (west, east) = ((axis.min(), axis.max()) for axis in (latitude, longitude))
    here = [each for each in stations if south <= each.latitude <= north and west <= each.longitude <= east]
    if len(here) > limits.SIGNS:
        most = f"at most {limits.SIGNS:,} are drawn"
        raise input_error(path, f"has {len(here):,} stations in the scene; {most}: keep the main ones")
    return here


def inputs(settings: Settings) -> dict[str, str]:
    """Return the hashes of the user's station files."""
    known = settings.stations
    if not known.enabled:
        return {}
    files = {"stations": known.file, "footprints": known.footprints, "routes": known.routes_file}
    return {name: sha256(path)[:16] for name, path in files.items() if path is not None}


def check(settings: Settings, run: Run) -> None:
    """Check before the build that the user's files can be read, and have not too many stations in the run.

    Raises
    ------
    InputError
        A file cannot be read, has too many stations, or none is given.
    """
    stations = settings.stations
    if not stations.enabled:
        return
    if stations.file is None and stations.routes_file is None:
        reason = "stations.enabled needs stations.file, a GeoPackage of stations, or stations.routes_file"
        raise scene_text.error_at(settings.path, ("stations", "enabled"), reason)
    if stations.file is not None:
        _within(stations.file, reading.read(stations.file).stations, run.latitude, run.longitude)
    _outlines(settings)
    if stations.routes_file is not None:
        drawn_routes.read(stations.routes_file)


def _minutes(shot: Shot, known: StationFile, here: Sequence[Station]) -> list[str]:
    """Format the shortest time from the order to the arrival at the ignition; empty if unknown or hidden."""
    began = ignition_point(shot)
    if "minutes" not in shot.settings.stations.show or began is None:
        return [""] * len(here)
    least = measures.shortest_minutes(known, began)[[known.station_row[each.id] for each in here]]
    return ["" if np.isnan(each) else f"{each:.0f} min to the ignition" for each in least]


def _fire(shot: Shot, here: Sequence[Station]) -> list[str]:
    """Format the time at which the fire reaches each station; empty if hidden."""
    if "fire" not in shot.settings.stations.show:
        return [""] * len(here)
    found = fire_arrival.sample(shot.run, [each.latitude for each in here], [each.longitude for each in here])
    clock = shot.settings.time.zone
    return [f"fire: {arrival_text.describe(shot.run, found, k, clock).headline}" for k in range(len(here))]


def _sign(
    show: tuple[str, ...],
    station: Station,
    resources: list[Resource],
    minutes: str,
    fire: str,
    outline: Array | None,
) -> Sign:
    kind = " ".join(station.kind.split())[:_LONGEST]
    lines = [kind] if "kind" in show and kind else []
    told = False  # True if data of the resources is shown
    if "resources" in show and (text := count_types(resources, _TYPES)):
        lines.append(text)
        told = True
    if minutes:
        lines.append(minutes)
        told = True
    if fire:
        lines.append(fire)
    origins = {station.origin} | ({each.origin for each in resources} if told else set())
    origin = next(each for each in (INVENTED, USER, FACT) if each in origins)
    if origin == INVENTED:
        lines.append(EXERCISE)
    name, where = " ".join(station.title.split())[:_LONGEST], (station.latitude, station.longitude)
    return Sign(name, kind, *where, tuple(lines), origin, outline, station.id)


def _outlines(settings: Settings) -> list[Array]:
    path = settings.stations.footprints
    if path is None:
        return []
    outlines = [rings[0] for each in read_features(path) for rings in each.polygons]
    most = max(map(len, outlines), default=0)
    if most > limits.CORNERS:
        reason = f"has a footprint of {most:,} corners; simplify it to at most {limits.CORNERS:,}"
        raise input_error(path, reason)
    if (corners := sum(map(len, outlines))) > limits.FOOTPRINT_CORNERS:
        reason = f"has footprints of {corners:,} corners; cut out the area of the scene"
        raise input_error(path, reason)
    return outlines


def bounds(outlines: list[Array]) -> Array:
    """Return west, south, east and north (n, 4) of outlines, degrees."""
    return np.array([(*ring.min(axis=0), *ring.max(axis=0)) for ring in outlines]).reshape(-1, 4)


def nearest_outline(outlines: list[Array], boxes: Array, latitude: float, longitude: float) -> Array | None:
    """Find the outline with the corner nearest to a station, within `_BESIDE`.

    Parameters
    ----------
    boxes
        `bounds` of the outlines.
    """
    north, east = metres_per_degree(latitude)
    beyond = np.array([_BESIDE / east, _BESIDE / north])
    west, south = areas.turned(boxes[:, 0], longitude), boxes[:, 1]
    close = (west <= longitude + beyond[0]) & (west + boxes[:, 2] - boxes[:, 0] >= longitude - beyond[0])
    close &= (south <= latitude + beyond[1]) & (boxes[:, 3] >= latitude - beyond[1])
    best, outline = _BESIDE, None
    for ring in (outlines[k] for k in np.flatnonzero(close)):
        turned = areas.turned(ring[:, 0], longitude)
        far = float(np.hypot((turned - longitude) * east, (ring[:, 1] - latitude) * north).min())
        if far < best:
            best, outline = far, ring
    return outline
