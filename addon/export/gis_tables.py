"""Feature tables of the GeoPackage: fronts, burned areas, cameras, places and divisions."""

from __future__ import annotations

import functools

import numpy as np

from ..imaging import map_symbols
from ..run import times
from ..run.observations import Feature
from . import fronts, places, tracks
from .gis_geopackage import Table
from .request import ExportRequest
from .tracks import Track

_time = functools.partial(times.iso, timespec="milliseconds")
_TIMES = {"begin_time": "DATETIME", "end_time": "DATETIME"}
_DIVISIONS = {
    "kind": "TEXT", "category": "TEXT", "name": "TEXT", "division": "TEXT", "type": "TEXT", "station": "TEXT",
    "hour": "REAL", "held": "BOOLEAN", "front_m": "REAL", "line_m": "REAL", "arrival_min": "REAL",
    "note": "TEXT",
}  # fmt: skip


def make(request: ExportRequest) -> list[Table]:
    """Make all tables that have features, from the lowest on the map to the highest."""
    found = [*_fire(request), *_divisions(places.divisions(request.shot)), *_cameras(request)]
    return [table for table in (*found, _places(request)) if table.rows]


def _fire(request: ExportRequest) -> list[Table]:
    columns = _TIMES | {"area_ha": "REAL", "time_s": "REAL"}
    area = Table("burned_area", "Burned area until the next time", "MULTIPOLYGON", columns)
    line = Table("fronts", "Fire front until the next time", "MULTILINESTRING", columns)
    for front in fronts.find(request):
        end = _time(front.end) if front.end else None
        values = (_time(front.begin), end, round(front.area / 1e4, 4), front.time)
        area.rows.append((front.polygons, values))
        line.rows.append((front.lines, values))
    return [area, line]


def _cameras(request: ExportRequest) -> list[Table]:
    """Make tables of paths, with the UTC time of each point (s since 1970) as measure, and of frames."""
    path = Table(
        "camera_paths", "Camera paths; the measure is UTC, s since 1970", "LINESTRING",
        _TIMES | {"name": "TEXT", "projection": "TEXT"}, z=True, m=True,
    )  # fmt: skip
    angles = ("heading_deg", "tilt_deg", "roll_deg", "horizontal_fov_deg", "vertical_fov_deg", "focal_mm")
    columns = _TIMES | {"name": "TEXT", "frame": "INTEGER"} | dict.fromkeys(angles, "REAL")
    frame = Table("camera_frames", "Camera position and direction at each frame", "POINT", columns, z=True)
    for track in tracks.find(request):
        points = track.geodetic[:, [1, 0, 2]]
        moments = [_time(each) for each in track.times]
        if len(points) > 1:
            measure = [each.timestamp() for each in track.times]
            values = (moments[0], moments[-1], track.name, track.projection)
            path.rows.append((np.column_stack([points, measure]), values))
        lens = _lens(track)
        turned = np.column_stack(track.angles(request.georeference.matrix[:3, :3]))
        for k, (number, begin) in enumerate(zip(track.frames.tolist(), moments, strict=True)):
            end = moments[k + 1] if k + 1 < len(moments) else None
            values = (begin, end, track.name, number, *np.round(turned[k], 6).tolist(), *lens[k])
            frame.rows.append((points[[k]], values))
    return [path, frame]


def _lens(track: Track) -> list[tuple[float | None, ...]]:
    """List the angles of view, degrees, and focal lengths, mm; None for orthographic cameras."""
    if track.projection == "orthographic":
        return [(None, None, None)] * len(track.frames)
    if track.projection == "panorama":
        return [(*np.degrees(2.0 * half).round(6).tolist(), None) for half in track.half]
    angle = np.degrees(2.0 * np.arctan(track.half)).round(6)
    return [(*each, focal) for each, focal in zip(angle.tolist(), track.focal.round(4).tolist(), strict=True)]


def _places(request: ExportRequest) -> Table:
    columns = {"name": "TEXT", "category": "TEXT", "kind": "TEXT", "text": "TEXT", "exercise": "BOOLEAN"}
    table = Table("places", "Stations, named places and ignition", "POINT", columns)
    for place in places.find(request.shot):
        values = (place.name, place.symbol, place.kind, "\n".join(place.lines), place.exercise)
        table.rows.append((np.array([[place.longitude, place.latitude]]), values))
    return table


def _divisions(features: list[Feature]) -> list[Table]:
    """Make tables of control lines and routes, and of division breaks."""
    line = Table(
        "divisions", "Control lines and routes of an allocation (exercise)", "MULTILINESTRING", _DIVISIONS
    )
    point = Table("division_breaks", "Division breaks (exercise)", "POINT", _DIVISIONS)
    for feature in features:
        given = feature.properties
        category = str(given.get("FeatureCategory") or "")
        style = map_symbols.find(category, map_symbols.LINES) or "other"
        values = [_plain(given.get(name)) for name in _DIVISIONS]
        values[1], values[-1] = category if len(feature.points) else style, str(given.get("exercise") or "")
        if lines := [each for each in feature.lines if len(each) > 1]:
            line.rows.append((lines, values))
        for each in feature.points:
            point.rows.append((each[None, :], values))
    return [line, point]


def _plain(value: object) -> object:
    """Return a value that SQLite stores; a text for other values."""
    return value if value is None or isinstance(value, bool | int | float | str) else str(value)
