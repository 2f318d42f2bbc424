"""Scores: agreement of a run with observed perimeters, detections and acreages, by date.

A run has the arrival time of each fuel cell; by a date, the cells with earlier arrival times have burned.
Scores compare areas in two ways: on polygons (front between cell centres, in an equal-area projection) and on
cells (whole ones, on the ellipsoid). Their difference is the uncertainty due to the run's grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...errors import UsageError
from .. import info, times
from ..observations import Observations
from . import arrival, detected, shapes, used
from .grid import ScoreGrid
from .overlap import Overlap

SAMPLES = 6  # times at which another run is compared if nothing gives other times


@dataclass(frozen=True)
class Seen:
    """Reference perimeter: time (UTC), shapely geometry in degrees, and source."""

    time: datetime
    shape: Any
    source: str


def score(
    run: Run, observations: Observations, other: Run | None = None, zone: str = "UTC"
) -> dict[str, Any]:
    """Compute the results of `firetwin score` as JSON data: m, m2, s, and fractions from 0 to 1.

    Parameters
    ----------
    other
        A second run. Its perimeters serve as observations, at the observations' times or else at SAMPLES
        times of both runs, and both arrival times are compared cell by cell.

    Raises
    ------
    UsageError
        Shapely or pyproj is missing.
    """
    shapes.needed()
    grid = ScoreGrid.from_run(run)
    seen = [
        Seen(perimeter.time, shapes.of_perimeter(perimeter, grid.middle), perimeter.source)
        for perimeter in observations.perimeters
    ]
    perimeters = _fates(run, grid, seen)
    inside = [each for each, fate in zip(seen, perimeters, strict=True) if fate == used.USED]
    uses = _uses(run, grid, seen, perimeters, observations)
    if other is not None:
        uses = [use for use in uses if use["kind"] != "perimeters"]  # they only supply times
        inside = seen = _of_run(other, run, [each.time for each in seen])
    dates = [_date(run, grid, each) for each in inside]
    return {
        "run": {"name": run.name, "path": run.path, "synthetic": run.synthetic, "event": run.event},
        "against": sorted(
            {each.source for each in seen} | {detection.source for detection in observations.detections}
        ),
        "other_run": None if other is None else other.name,
        "zone": zone,
        "domain": {"area": grid.domain, "cells": list(grid.arrival.shape), "cell": list(grid.cell)},
        "projection": grid.projection.definition,
        "burned_from": info.burned_from(run),
        "arrival_from": "fuel_arrival_time" if run.has("fuel_arrival_time") else "heat_flux",
        "dates": dates,
        "uses": uses,
        "arrival": _arrival(run, grid, inside, other),
        "detections": [
            row for detection in observations.detections for row in detected.rows(run, grid, detection)
        ],
        "reported": _reported(run, grid),
        "assumptions": [
            *observations.assumptions,
            *(
                f"{detection.source}: {detection.left_out} detections of low confidence or other heat "
                "are left out"
                for detection in observations.detections
                if detection.left_out
            ),
        ],
    }


def _fates(run: Run, grid: ScoreGrid, perimeters: Sequence[Seen]) -> list[str]:
    """Use of each perimeter, one of `used.FATES`."""
    moments = [times.seconds(run, each.time) for each in perimeters]
    here = [grid.box.intersects(grid.projection.project(each.shape)) for each in perimeters]
    return [str(fate) for fate in used.fates(run, moments, here)]


def _uses(
    run: Run, grid: ScoreGrid, seen: Sequence[Seen], fates: Sequence[str], observations: Observations
) -> list[dict[str, Any]]:
    """Count the observations of each file by use, with reasons for exclusion (see `used.row`)."""
    sources = dict.fromkeys(perimeter.source for perimeter in seen)
    return [
        used.row(
            source,
            "perimeters",
            (f for perimeter, f in zip(seen, fates, strict=True) if perimeter.source == source),
        )
        for source in sources
    ] + [
        used.row(detection.source, "detections", detected.fates(run, grid, detection))
        for detection in observations.detections
    ]


def _date(run: Run, grid: ScoreGrid, perimeter: Seen) -> dict[str, Any]:
    """Score one perimeter: total burned area, and without the area burned at the start."""
    time, first = times.seconds(run, perimeter.time), float(run.times[0])
    here, there = grid.polygon(time), grid.projection.project(perimeter.shape)
    burned, observed = grid.burned(time), grid.inside(perimeter.shape)
    start, started = grid.polygon(first), grid.burned(first)
    row = {
        "time": times.iso(perimeter.time),
        "source": perimeter.source,
        "outside_grid": 1.0 - grid.box.intersection(there).area / there.area if there.area else 0.0,
        "all": _both(
            Overlap.of_polygons(here, there, grid.box), Overlap.of_cells(burned, observed, grid.areas)
        ),
        "distance": shapes.distances(here, there, min(grid.cell) / 2),
    }
    if started.any():
        row["without_start"] = _both(
            Overlap.of_polygons(here.difference(start), there.difference(start), grid.box.difference(start)),
            _of_cells_since(burned, started, observed, grid.areas),
        )
    return row


def _of_cells_since(burned: NDArray, started: NDArray, seen: NDArray, areas: NDArray) -> Overlap:
    """Score cells unburned at the start; each counts with its remaining area."""
    rest = 1.0 - started
    share = np.divide(np.maximum(burned - started * 1.0, 0.0), rest, out=np.zeros(rest.shape), where=rest > 0)
    return Overlap.of_cells(share, seen, areas * rest)


def _both(polygons: Overlap, cells: Overlap) -> dict[str, Any]:
    """Score on polygons and on cells, with the absolute difference as uncertainty."""
    one, two = polygons.scores(), cells.scores()
    error = {
        name: abs(a - b) if a is not None and (b := two[name]) is not None else None
        for name, a in one.items()
    }
    return {"polygons": one, "cells": two, "error": error}


def _arrival(run: Run, grid: ScoreGrid, seen: Sequence[Seen], other: Run | None) -> dict[str, Any] | None:
    if other is not None:
        theirs = ScoreGrid.from_run(other)
        shift = times.seconds(run, times.utc(other, 0.0))
        low, high = (times.seconds(run, moment) for moment in _common(run, other))
        return arrival.between(grid.arrival, arrival.sampled(theirs, grid) + shift, (low, high))
    if len(seen) < 2:
        return None
    masks = [grid.inside(perimeter.shape) for perimeter in seen]
    return arrival.within(grid.arrival, masks, [times.seconds(run, perimeter.time) for perimeter in seen])


def _reported(run: Run, grid: ScoreGrid) -> list[dict[str, Any]]:
    """List reported acreages of the fire with the areas of the run on polygons and on cells."""
    rows = info.reported(run)
    for row in rows:
        if row["run"] is not None:
            row["polygons"] = grid.polygon(times.seconds(run, datetime.fromisoformat(row["time"]))).area
    return rows


def _common(run: Run, other: Run) -> tuple[datetime, datetime]:
    """Return the first and the last time that both runs cover."""
    first, last = zip(
        *(
            (times.utc(each, float(each.times[0])), times.utc(each, float(each.times[-1])))
            for each in (run, other)
        ),
        strict=True,
    )
    return max(first), min(last)


def _of_run(other: Run, run: Run, moments: Sequence[datetime]) -> list[Seen]:
    """Return perimeters of another run as reference."""
    low, high = _common(run, other)
    if low >= high:
        raise UsageError(f"--against: {other.path} and the run have no moment in common")
    common = [moment for moment in moments if low <= moment <= high]
    spread = [
        low + timedelta(seconds=s) for s in np.linspace(0, (high - low).total_seconds(), SAMPLES + 1)[1:]
    ]
    theirs = ScoreGrid.from_run(other)
    return [
        Seen(moment, theirs.degrees(theirs.polygon(times.seconds(other, moment))), other.name)
        for moment in common or spread
    ]
