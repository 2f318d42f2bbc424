"""Reader of NCAR's Community Fire Behavior Model: ``fire_output_YYYY-MM-DD_HH:MM:SS.nc``, one time per file.

The layout was measured on files of the model (commit e5cb182): no attributes; variables (ny, nx) float32,
south row first; all rows and columns are valid.
"""

from __future__ import annotations

import re
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from ..models import arrival, companion_rasters, fuels, netcdf
from ..models.grid import Grid
from ..models.model import Model, Options, read_until

NAME, ORDER = "output of the Community Fire Behavior Model", 20
MODELS = "CFBM"

_TIME = re.compile(r"(\d{4})-(\d\d)-(\d\d)[_T ](\d\d)\D?(\d\d)\D?(\d\d)")


def sniff(path: Path) -> bool:
    """Check whether a file has the model's variables and dimensions."""
    dimensions, variables = netcdf.names(path)
    return {"nx", "ny"} <= dimensions and {"lats", "lons", "fire_area", "fgrnhfx"} <= variables


def read(paths: list[Path], options: Options) -> Model:
    """Read the series as a model."""
    by_time = {_moment(path): path for path in sorted(paths) if sniff(path)}
    moments = sorted(moment for moment in by_time if read_until(moment, options))
    ours = [by_time[moment] for moment in moments]
    times = np.array([(moment - moments[0]).total_seconds() for moment in moments])
    files = netcdf.Files()
    first = files(ours[0])
    grid = Grid(*(first.read(name).astype(np.float64) for name in ("lats", "lons")))
    shape = grid.shape
    land = companion_rasters.find(paths)

    def get(name: str, i: int) -> NDArray:
        values = files(ours[i]).read(name)
        if values.shape != shape:
            raise files(ours[i]).error(f"{name} is {values.shape} where the first file's grid is {shape}")
        return values

    def flux(i: int) -> NDArray:
        values = get("fgrnhfx", i)
        return np.where(get("fire_area", i) > 0, values, np.float32(0)) if i == 0 else values

    @lru_cache(1)  # both components are requested in turn
    def wind(i: int) -> tuple[NDArray, NDArray]:
        return grid.east_north(get("uf", i), get("vf", i))

    moving = {
        "heat_flux": flux,
        "burned_fraction": lambda i: np.clip(np.nan_to_num(get("fire_area", i)), 0, 1),
    }
    notes = [
        "times are taken from the file names, as UTC",
        "heat flux is fgrnhfx (sensible), a mean over the model's last step, of unsaid length",
        "the model never sets the flux of the first file: it is 0 there where fire_area is",
        "burned fraction is fire_area: burned areas are sums of burned shares of cells",
        "latitude and longitude on a sphere of 6370 km are used as WGS84 coordinates",
    ]
    if "uf" in first and "vf" in first:
        moving |= {"wind_east": lambda i: wind(i)[0], "wind_north": lambda i: wind(i)[1]}
        notes.append("wind is uf, vf at the namelist's fire_wind_height, turned from the grid's axes")
    still = {}
    if "zsf" in first:
        still["elevation"] = lambda: get("zsf", 0)
    if "nfuel_cat" in first:
        notes.append("surface fuel is the model's own load (fgi) of Anderson's model nfuel_cat")
        still["surface_fuel"] = lambda: fuels.loads(get("nfuel_cat", 0), "sfire")
        still["fuel_category"] = lambda: get("nfuel_cat", 0)
    if "lfn" in first:
        notes.append("time of arrival is interpolated in the level function between files")
        still["fuel_arrival_time"] = lambda: arrival.from_levels(times, lambda i: get("lfn", i), shape)
    else:
        notes.append("time of arrival is interpolated in fire_area between files")
        still["fuel_arrival_time"] = lambda: arrival.from_share(times, lambda i: get("fire_area", i), shape)
    land.complete(still, grid, grid, options.projection)
    return Model(
        source="Community Fire Behavior Model",
        name="Community Fire Behavior Model run",
        start=moments[0],
        times=times,
        grid=grid,
        fuel_grid=grid,
        still=still,
        moving=moving,
        files=ours,
        projection="2-D latitude and longitude (Lambert, by geo_em.d01.nc)",
        mean_s=0.0,
        sources=[(path, 0) for path in ours],
        assumptions=notes + land.assumptions,
        close=files.close,
    )


def _moment(path: Path) -> datetime:
    match = _TIME.search(path.name)
    try:
        year, month, day, hour, minute, second = map(int, match.groups() if match else ())
        return datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:
        reason = "its time is in its name only: call it fire_output_YYYY-MM-DD_HH:MM:SS.nc, as the model does"
        raise input_error(path, reason) from None
