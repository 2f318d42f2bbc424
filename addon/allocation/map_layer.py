"""Map layer of a suggested allocation: GeoJSON with control lines, division breaks, and sent resources."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..stations.records import EXERCISE
from . import divisions
from .containment import Answer
from .suggestion import AllocationInput

Array = NDArray[np.float64]

_CATEGORY = {"control_line": "Planned Line", "division_break": "Division Break"}
_NOT_HELD = "Line Not Held"
_DIGITS = 5  # of degrees, 1 m


def make(asked: AllocationInput, answer: Answer | None, result: dict[str, Any]) -> dict[str, Any]:
    """Return a FeatureCollection; each feature has `kind`, `exercise` (the label) and `FeatureCategory`.

    The category chooses a symbol of the NWCG standard on the sheets of `firetwin brief --context`.

    `control_line` (MultiLineString) has `division`, `hour`, `held`, `front_m` and `line_m`; `division_break`
    (Point) has `name`, such as "A/B"; `resource` (LineString from station to division) has `name`, `type`,
    `station`, `division`, `arrival_min`, `line_m` and `held`.
    """
    parts = asked.divisions
    features = _breaks(asked)
    where = {each.id: each for each in asked.resources}
    for k, division in enumerate(result["divisions"]):
        if not any(division["perimeter"]):
            continue
        hour, held = division["contained_at_hour"], division["contained_at_hour"] is not None
        index = result["hours"].index(hour) if held else len(result["hours"]) - 1
        plan = division.get("nearest_plan")
        built = division.get("line", 0.0) if plan is None else plan["line"]
        lines = divisions.split_line(parts.lines[index], parts.centre, len(parts.names))[k]
        about = {
            "division": division["name"],
            "hour": result["hours"][index],
            "held": held,
            "front_m": division["perimeter"][index],
            "line_m": None if answer is None else built,
        }
        end = _nearest(lines, parts.place[k][::-1])
        drawn = [line.round(_DIGITS).tolist() for line in lines]
        features.append(_feature("control_line", "MultiLineString", drawn, about))
        for each in [*division["resources"], *(plan or {"resources": []})["resources"]]:
            unit = where[each["id"]]
            ends = [[unit.lon, unit.lat], end]
            about = {name: each[name] for name in ("name", "type", "station", "origin")} | {
                "division": division["name"], "arrival_min": each["arrival"], "line_m": each["line"],
                "held": held,
            }  # fmt: skip
            features.append(_feature("resource", "LineString", np.round(ends, _DIGITS).tolist(), about))
    return {"type": "FeatureCollection", "name": EXERCISE, "features": features}


def _nearest(lines: list[Array], place: Array) -> list[float]:
    """Return the point of lines (n, 2) nearest to a place (degrees east, north); without lines the place."""
    points = np.concatenate(lines) if lines else place[None, :]
    away = (points - place) * (np.cos(np.radians(place[1])), 1.0)
    x, y = points[np.hypot(*away.T).argmin()].tolist()
    return [x, y]


def _breaks(asked: AllocationInput) -> list[dict[str, Any]]:
    """Return the points where the control line of the last hour passes from one division to the next.

    If there are several points between two divisions, the farthest from the centre counts.
    """
    parts, count = asked.divisions, len(asked.divisions.names)
    if count < 2:
        return []
    lines = divisions.split_line(parts.lines[-1], parts.centre, count)
    features = []
    for k in range(count):
        other = (k + 1) % count
        ends = {tuple(end) for line in lines[k] for end in (line[0].tolist(), line[-1].tolist())}
        shared = ends & {tuple(end) for line in lines[other] for end in (line[0].tolist(), line[-1].tolist())}
        if shared:
            latitude, longitude = parts.centre
            narrow = np.cos(np.radians(latitude))
            at = max(shared, key=lambda each: np.hypot((each[0] - longitude) * narrow, each[1] - latitude))
            between = {"name": f"{parts.names[k]}/{parts.names[other]}"}
            features.append(_feature("division_break", "Point", np.round(at, _DIGITS).tolist(), between))
    return features


def _feature(kind: str, shape: str, coordinates: Any, about: dict[str, Any]) -> dict[str, Any]:
    category = _CATEGORY.get(kind, "")
    if not about.get("held", True) and category:
        category = _NOT_HELD
    named = {"kind": kind, "FeatureCategory": category, "exercise": EXERCISE}
    return {
        "type": "Feature",
        "properties": named | about,
        "geometry": {"type": shape, "coordinates": coordinates},
    }
