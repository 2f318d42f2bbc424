"""Run from NumPy arrays: the public function `firetwin.run.write`, for models that no reader knows."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import UsageError

_ONE_OF = "give arrival, or burned and times"


def write(
    out: str | Path,
    *,
    start: str | datetime,
    latitude: ArrayLike,
    longitude: ArrayLike,
    arrival: ArrayLike | None = None,
    burned: ArrayLike | None = None,
    times: ArrayLike | None = None,
    projection: str = "",
    elevation: ArrayLike | None = None,
    surface_fuel: ArrayLike | None = None,
    canopy_fuel: ArrayLike | None = None,
    fuel_category: ArrayLike | None = None,
    name: str = "",
    zone: str = "",
) -> Path:
    """Write a run folder from arrays, and return it.

    Heat flux is computed from fuel and arrival times: all fuel of a cell burns, at 17.433 MJ/kg. Values that
    are not given are assumed, and ``run.toml`` lists them.

    Parameters
    ----------
    out
        Folder of the run; it must not exist.
    start
        Start of the run: time with an offset from UTC, as text in ISO 8601 or as datetime.
    latitude, longitude
        Cell centres, degrees: (ny,) and (nx,), or both (ny, nx). With `projection`: y (ny,) and x (nx,), m.
    arrival
        Arrival time of the fire (ny, nx), s since `start`; NaN: never.
    burned
        Burned fraction (nt, ny, nx), 0 to 1, in place of `arrival`: a mask for each of the `times`. A cell
        burns when half of it has burned.
    times
        (nt,) s since `start`, ascending.
    projection
        Projection of the axes, such as ``EPSG:32610``.
    elevation
        Ground elevation (ny, nx), m; assumed 0.
    surface_fuel, canopy_fuel
        Fuel (ny, nx), kg/m2; by `fuel_category`, or assumed 1 and 0 kg/m2.
    fuel_category
        Fuel model number (ny, nx): Anderson 1 to 13, or Scott and Burgan 91 to 204.
    name, zone
        Name of the run, and its time zone (``America/Los_Angeles``); by default the folder's name, and the
        offset of `start`.

    Raises
    ------
    UsageError
        Neither or both of `arrival` and `burned` are given, or `start` is not a time.
    InputError
        The arrays make no run: shapes differ, nothing burns, or the folder exists.

    Examples
    --------
    >>> write("run", start="2014-09-17T12:00-07:00", latitude=lat, longitude=lon, arrival=s)  # doctest: +SKIP
    """
    from ..progress import silent
    from .models import masks, write
    from .models.companion_rasters import LandRasters
    from .models.from_arrival_time import Maps, model
    from .models.grid import Grid
    from .models.model import Options

    if (arrival is None) == (burned is None) or (burned is None) != (times is None):
        raise UsageError(f"write: {_ONE_OF}")
    out = Path(out)
    write.check(out)
    begun = start if isinstance(start, datetime) else _moment(start)
    options = Options.of(begun.isoformat(), "", projection, 0.0, [], name, zone)
    axes = (np.asarray(longitude, np.float64), np.asarray(latitude, np.float64))
    grid = Grid.projected(*axes, projection) if projection else Grid(axes[1], axes[0])

    def layer(values: ArrayLike | None) -> Any:
        return None if values is None else np.asarray(values, np.float32)

    maps = Maps(
        np.empty(0) if arrival is None else np.asarray(arrival, np.float64),
        surface=layer(surface_fuel),
        canopy=layer(canopy_fuel),
        elevation=layer(elevation),
        category=layer(fuel_category),
    )
    land, source = LandRasters({}), "arrays"
    if burned is None:
        run = model(maps, grid, land, options, source, [out], [])
    else:
        shares, moments = np.asarray(burned), np.asarray(times, np.float64)
        if len(shares) != len(moments):
            raise UsageError(f"write: burned has {len(shares)} times, and times has {len(moments)}")
        run = masks.model(moments, shares.__getitem__, grid, land, options, source, [out], [], maps)
    run.name, run.zone = name or out.name, options.zone
    write.write(run, out, source, silent)
    return out


def _moment(text: str) -> datetime:
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise UsageError(f"write: start {text!r} is not a time such as 2014-09-17T12:00:00-07:00") from None
    return moment if moment.tzinfo else moment.replace(tzinfo=UTC)
