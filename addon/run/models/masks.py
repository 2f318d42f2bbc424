"""Burned masks over time as a run: arrival times from the masks, and heat from fuel and arrival times."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from . import arrival, from_arrival_time
from .companion_rasters import LandRasters
from .grid import Grid
from .model import Model, Options

_ALMOST = 1.0 + 1e-3  # largest burned fraction; more is a percentage or another quantity


def model(
    times: NDArray[np.float64],
    share: Callable[[int], NDArray],
    grid: Grid,
    land: LandRasters,
    options: Options,
    source: str,
    files: list[Path],
    notes: list[str],
    maps: from_arrival_time.Maps | None = None,
) -> Model:
    """Build a model from burned fractions (0 to 1) at times.

    A cell burns when half of it has burned, linear between two masks. A cell of two masks 0 and 1 gets the
    middle of their interval: half the interval is the largest error.

    Parameters
    ----------
    times
        (nt,) s since the start of `options`, ascending.
    share
        Burned fraction [ny, nx] by time index; NaN counts as 0.
    maps
        Fuel and elevation of the model; `arrival` is set here.

    Raises
    ------
    InputError
        The values are not fractions, or nothing burns.
    """

    def checked(index: int) -> NDArray[np.float32]:
        values = np.nan_to_num(np.asarray(share(index), np.float32))
        if values.shape != grid.shape:
            raise input_error(files[0], f"has masks of {values.shape} cells on a grid of {grid.shape}")
        if values.size and (values.min() < 1.0 - _ALMOST or values.max() > _ALMOST):
            reason = (
                f"has burned_fraction of {values.min():g} to {values.max():g}, not 0 to 1; set scale in "
                "[fields], for example scale = 0.01 for percent"
            )
            raise input_error(files[0], reason)
        return np.clip(values, 0.0, 1.0)

    maps = maps or from_arrival_time.Maps(np.empty(0))
    maps.arrival = arrival.from_share(times, checked, grid.shape)
    hours = f"{float(np.diff(times).max()) / 60.0:g} min" if len(times) > 1 else "one time"
    notes = [
        *notes,
        f"arrival times are interpolated between masks {hours} apart, when half a cell has burned",
    ]
    return from_arrival_time.model(maps, grid, land, options, source, files, notes)


def since(moments: list[datetime]) -> NDArray[np.float64]:
    """Return times (s) since the first moment."""
    return np.array([(each - moments[0]).total_seconds() for each in moments])
