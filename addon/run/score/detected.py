"""Satellites' detections against a run: whether the run had burned there by then, and for how long."""

from __future__ import annotations

from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import times
from ..observations import Detections
from . import used
from .grid import Grid


def fates(run: Run, grid: Grid, detections: Detections) -> NDArray[np.str_]:
    """What becomes of each detection, one of `used.FATES`."""
    row, column = grid.at(detections.latitude, detections.longitude)
    return used.fates(run, _moments(run, detections), (row >= 0) & (column >= 0))


def rows(run: Run, grid: Grid, detections: Detections) -> list[dict[str, Any]]:
    """A row for each overpass within the run's time and place.

    `inside` are detections whose middle the run had burned by then, `within_pixel` also those no farther than
    half a pixel from it. `lag` is how long before (s, median and mean) the front had passed the middles,
    negative where it came later, of those that it reaches at all; `never` counts the others.
    """
    import shapely

    row, column = grid.at(detections.latitude, detections.longitude)
    moments = _moments(run, detections)
    covered = fates(run, grid, detections) == used.USED
    found = []
    for moment in np.unique(moments[covered]):
        these = np.flatnonzero(covered & (moments == moment))
        arrival = grid.arrival[row[these], column[these]]
        points = grid.projection.points(detections.longitude[these], detections.latitude[these])
        away = shapely.distance(points, grid.polygon(moment))
        lag = moment - arrival[~np.isnan(arrival)]
        found.append(
            {
                "time": times.iso(times.utc(run, float(moment))),
                "source": detections.source,
                "count": int(these.size),
                "inside": int((arrival <= moment).sum()),
                "within_pixel": int((np.nan_to_num(away, nan=np.inf) <= detections.size[these] / 2).sum()),
                "lag_median": float(np.median(lag)) if lag.size else None,
                "lag_mean": float(lag.mean()) if lag.size else None,
                "never": int(np.isnan(arrival).sum()),
            }
        )
    return found


def _moments(run: Run, detections: Detections) -> NDArray[np.float64]:
    return np.array([times.seconds(run, each) for each in detections.time], np.float64)
