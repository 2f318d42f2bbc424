"""Duration of a heat flux that no flame front reaches, such as of a burning tank or a pile."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import burning


def duration(run: Run) -> NDArray[np.float64] | None:
    """Compute the time (fy, fx), s, from before the first to the last intense flux; None if there is none.

    A flux is intense from `burning.CROWN_FIRE_FLUX` on: such a cell burns something other than its fuel. The
    time begins one output before the first intense flux, as the fire may arrive at any time since then.
    """
    if not run.flux_range()[1] >= burning.CROWN_FIRE_FLUX:
        return None
    times = np.asarray(run.times, np.float64)
    step = float(np.mean(np.diff(times))) if len(times) > 1 else burning.BURN_TIME
    before = np.concatenate([[times[0] - step], times[:-1]])
    first, last = np.full(run.elevation.shape, np.inf), np.full(run.elevation.shape, -np.inf)
    for index, time in enumerate(times):
        intense = run.heat_flux(index) >= burning.CROWN_FIRE_FLUX  # False for NaN
        first[intense] = np.minimum(first[intense], before[index])
        last[intense] = time
    rows = burning.nearest(run.latitude, run.fuel_latitude)
    columns = burning.nearest(run.longitude, run.fuel_longitude)
    return np.maximum(last - first, 0.0)[np.ix_(rows, columns)]
