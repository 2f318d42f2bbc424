"""Satellite detections against a run: whether the run had burned there by the overpass, and its lag."""

from __future__ import annotations

from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import times
from ..observations import Detections
from . import used
from .grid import ScoreGrid


def fates(run: Run, grid: ScoreGrid, detections: Detections) -> NDArray[np.str_]:
    """Use of each detection, one of `used.FATES`."""
    row, column = grid.cells_at(detections.latitude, detections.longitude)
    return used.fates(run, _moments(run, detections), (row >= 0) & (column >= 0))


def rows(run: Run, grid: ScoreGrid, detections: Detections) -> list[dict[str, Any]]:
    """Compute statistics of each overpass within the run's time and area.

    `inside` counts detections whose centre the run had burned by then; `within_pixel` also those within half
    a pixel of burned ground. `lag` is the time (s, median and mean) since the front passed the centres,
    negative if it came later, of those that it ever reaches; `never` counts the others.
    """
    import shapely

    row, column = grid.cells_at(detections.latitude, detections.longitude)
    moments = _moments(run, detections)
    covered = fates(run, grid, detections) == used.USED
    result = []
    for moment in np.unique(moments[covered]):
        these = np.flatnonzero(covered & (moments == moment))
        arrival = grid.arrival[row[these], column[these]]
        points = grid.projection.points(detections.longitude[these], detections.latitude[these])
        away = shapely.distance(points, grid.polygon(moment))
        lag = moment - arrival[~np.isnan(arrival)]
        result.append(
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
    return result


def _moments(run: Run, detections: Detections) -> NDArray[np.float64]:
    return np.array([times.seconds(run, each) for each in detections.time], np.float64)
