"""Bounds of values that a run can have: dates, elevations of the Earth's surface, and heat flux of a fire."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from .. import limits
from ..errors import input_error
from . import times


def check_times(run: Run) -> None:
    """Check that the times of a run are dates of Python and of ISO 8601, also in other time zones.

    Raises
    ------
    InputError
        They are not.
    """
    first, last = limits.RUN_YEARS
    try:
        years = [times.utc(run, float(run.times[index])).year for index in (0, -1)]
    except OverflowError:
        years = [0]
    if not all(first <= year <= last for year in years):
        reason = f"has times outside of the years {first} to {last}; correct start, interval_s or times_s"
        raise input_error(Path(run.path) / "run.toml", reason)


def check_heights(run: Run) -> None:
    """Check that the elevation of a run is one of the Earth's surface.

    Raises
    ------
    InputError
        It is not.
    """
    low, high = limits.RUN_HEIGHTS
    outside = np.argwhere((run.elevation < low) | (run.elevation > high))
    if len(outside):
        row, column = outside[0]
        reason = (
            f"has an elevation of {run.elevation[row, column]:,.6g} m in row {row + 1}, column {column + 1}, "
            f"and {low:,} to {high:,} m are possible; write it in metres, and NaN where it is unknown"
        )
        raise input_error(Path(run.path) / "elevation", reason)


def check_flux(run: Run) -> None:
    """Check that the heat flux of a run is one of a fire; reads all fluxes once.

    Raises
    ------
    InputError
        It is not.
    """
    if not run.flux_range()[1] > limits.HEAT_FLUX:
        return
    for index, time in enumerate(run.times):
        flux = run.heat_flux(index)
        beyond = np.argwhere(np.isfinite(flux) & (flux > limits.HEAT_FLUX))
        if len(beyond):
            row, column = beyond[0]
            moment = times.iso(times.utc(run, float(time)))
            reason = (
                f"has {flux[row, column]:.3g} W/m2 at time {index + 1}, {moment}, in row {row + 1}, column "
                f"{column + 1}, and at most {limits.HEAT_FLUX:.0e} W/m2 are possible; write it in W/m2"
            )
            raise input_error(Path(run.path) / "heat_flux", reason)
