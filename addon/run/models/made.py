"""A run of models that give one map of arrival times: its heat flux is made here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import Error, input_error
from . import fuels, heat
from .beside import Land
from .grid import Grid
from .model import Model, Options


@dataclass
class Maps:
    """What the files say, on one grid.

    Attributes
    ----------
    arrival
        (ny, nx) s since the start, NaN where never.
    intensity, speed, per_area
        W/m, m/s and J/m2 where the fire came; None: not said.
    surface, canopy, elevation, category
        kg/m2, kg/m2, m and numbers of fuel models; None: what lies beside says it.
    """

    arrival: NDArray
    intensity: NDArray | None = None
    speed: NDArray | None = None
    per_area: NDArray | None = None
    surface: NDArray | None = None
    canopy: NDArray | None = None
    elevation: NDArray | None = None
    category: NDArray | None = None


def model(
    maps: Maps, grid: Grid, land: Land, options: Options, source: str, files: list[Path], told: list[str]
) -> Model:
    """A run of these maps; the start is the option's (`begun`)."""
    if maps.arrival.shape != grid.shape:
        raise input_error(files[0], 0, 0, f"has arrival times {maps.arrival.shape} on a grid of {grid.shape}")
    for name in ("intensity", "speed", "per_area"):
        values = getattr(maps, name)
        if values is not None and values.shape != grid.shape:
            raise input_error(files[0], 0, 0, f"has {name} {values.shape} on a grid of {grid.shape}")
    per_area = maps.per_area
    if per_area is None and maps.intensity is not None:
        per_area = heat.of_intensity(maps.arrival, maps.intensity, maps.speed, grid.cell)
        told.append(
            "heat per area is fireline intensity over rate of spread"
            + (", which is one over the gradient of arrival time" if maps.speed is None else "")
        )
    surface, canopy = maps.surface, maps.canopy
    if surface is None and "category" not in land.layers and per_area is not None:
        told.append("surface fuel is heat per area over 17.433 MJ/kg where it burned, their mean elsewhere")
        surface = _of_heat(per_area, maps.arrival)
    if surface is None:
        surface = land.surface(grid, options.projection)
    if canopy is None:
        canopy = land.canopy(grid, options.projection)
    fuel = surface + canopy
    category = maps.category if maps.category is not None else land.category(grid, options.projection)
    lasts = fuels.burn_out(category if category is not None else np.full(grid.shape, np.nan))
    if per_area is None:
        joules = heat.of_fuel(fuel)
        told.append(
            "heat flux is made of fuel and arrival: all surface and canopy fuel burns, at 17.433 MJ/kg"
        )
    else:
        joules, factor = heat.shared(per_area, fuel, maps.arrival)
        told.append(
            f"heat flux is made of heat per area and arrival, times {factor:.3g}: its total is that of all "
            "fuel burned, at 17.433 MJ/kg"
        )
    told.append(
        "a spot's heat comes out at a rate that falls evenly to 0 at three mean burning times of its fuel"
    )
    try:
        release = heat.Release.of(maps.arrival, joules, lasts, options.interval)
    except Error as error:
        raise input_error(files[0], 0, 0, str(error)) from None
    kept = {} if category is None else {"fuel_category": lambda: category}
    ground = maps.elevation if maps.elevation is not None else land.elevation(grid, options.projection)
    return Model(
        source=source,
        name=f"{source} run {files[0].stem}",
        start=begun(options, files[0]),
        times=release.times,
        grid=grid,
        fuel_grid=grid,
        still={
            "elevation": lambda: ground,
            "surface_fuel": lambda: np.nan_to_num(surface),
            "canopy_fuel": lambda: np.nan_to_num(canopy),
            "fuel_arrival_time": lambda: maps.arrival,
            **kept,
        },
        moving={"heat_flux": release.flux},
        files=files,
        projection=options.projection,
        assumptions=told + land.assumptions,
    )


def begun(options: Options, path: Path) -> datetime:
    """The moment that times count from, which only the user knows.

    Raises
    ------
    InputError
        `--start` is not given.
    """
    if options.start is None:
        reason = "does not say when the fire began; say it: --start 2014-09-17T04:45:00Z"
        raise input_error(path, 0, 0, reason)
    return options.start


def with_start(options: Options, start: datetime) -> Options:
    """The same options, of a start that files say, unless the user says one."""
    return options if options.start else replace(options, start=start)


def _of_heat(per_area: NDArray, arrival: NDArray) -> NDArray[np.float32]:
    load = np.asarray(per_area, np.float64) / fuels.HEAT
    burned = np.isfinite(arrival)
    mean = float(load[burned].mean()) if burned.any() else 0.0
    return np.where(burned, load, mean).astype(np.float32)
