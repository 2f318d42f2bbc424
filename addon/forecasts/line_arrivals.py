"""Arrival of a forecast's members at the control lines of an allocation, in the words of the page."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
from firetwin_core.run import Run

from ..run import times, zone
from . import forecast
from .ensemble import place_arrivals
from .ensemble.ensemble import Ensemble
from .ensemble.place_arrivals import SHARES


def add(result: dict[str, Any], run: Run, members: Ensemble, drawn: dict[str, Any]) -> dict[str, list[str]]:
    """Add to each division of a suggestion when members of a forecast first reach its control line.

    Returns lines of text by division.

    Parameters
    ----------
    result
        See `suggestion.describe`.
    drawn
        Map layer of the suggestion, with control lines at the hour of containment, or else the last hour.

    Raises
    ------
    InputError
        The run is not a member.
    """
    shown = forecast.shown_by(members, run)
    where, lines = zone.time_zone(run), _lines(drawn)
    order = datetime.fromisoformat(result["from"]).astimezone(UTC)
    divisions = [each for each in result["divisions"] if each["name"] in lines]
    arrivals = place_arrivals.earliest(members, [lines[each["name"]][0] for each in divisions])
    lines_of: dict[str, list[str]] = {}
    for k, division in enumerate(divisions):
        hour, arrival_times = lines[division["name"]][1], arrivals.known(k)
        moment = order + timedelta(hours=hour)
        before = int((arrival_times <= (moment - members.issued).total_seconds()).sum())
        reached = [(share, arrivals.by(k, share)) for share in SHARES]
        division["forecast"] = {
            "text": arrivals.sentence(k, where),
            "members": len(arrival_times),
            "hour": hour,
            "reached_by_hour": before,
            "reached_by": [
                {"share": share, "time": times.iso(members.valid(time)) if np.isfinite(time) else None}
                for share, time in reached
            ],
        }
        lines_of[division["name"]] = [
            f"members of the forecast at this line: {division['forecast']['text']}",
            f"{before} of {len(arrival_times)} members reach it by hour {hour:g}",
        ]
    total = len(members.members) + len(members.left_out)
    result["assumptions"] += [
        f"forecast: {members.manifest.name}, {arrivals.count} of {total} members, issued "
        f"{times.text(members.issued, where)}; a line is reached when a member burns any point of it, and no "
        "work on it is counted",
        f"forecast: {shown}",
        *filter(None, [arrivals.weights_note()]),
    ]
    return lines_of


def _lines(drawn: dict[str, Any]) -> dict[str, tuple[np.ndarray, float]]:
    """Return the points (n, 2), degrees east and north, and the hour of each division's control line."""
    lines = {}
    for feature in drawn["features"]:
        about = feature["properties"]
        if about["kind"] == "control_line":
            parts = [np.asarray(part, np.float64) for part in feature["geometry"]["coordinates"]]
            points = np.concatenate(parts) if parts else np.empty((0, 2))
            lines[about["division"]] = points, float(about["hour"])
    return lines
