"""Run from a map of arrival times: heat flux is computed from fuel and arrival time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ...errors import Error, input_error
from . import companion_rasters, fuels, heat_from_intensity, raster
from .companion_rasters import LandRasters
from .given_wind import Wind
from .grid import Grid
from .model import Model, Moving, Options


@dataclass
class Maps:
    """Maps of a model's files, on one grid.

    Attributes
    ----------
    arrival
        Arrival time (ny, nx), s since the start, NaN where never.
    intensity, speed, per_area
        Fireline intensity, W/m, rate of spread, m/s, and heat per area, J/m2, in burned cells; None: no such
        map.
    surface, canopy, elevation, category
        kg/m2, kg/m2, m and fuel model numbers; None: companion rasters supply them.
    wind
        Wind along columns and rows at a time (s), m/s; None: no wind.
    """

    arrival: NDArray
    intensity: NDArray | None = None
    speed: NDArray | None = None
    per_area: NDArray | None = None
    surface: NDArray | None = None
    canopy: NDArray | None = None
    elevation: NDArray | None = None
    category: NDArray | None = None
    wind: Wind | None = None


def arrival_times(read: raster.Raster, unit: float) -> NDArray:
    """Return the arrival times (ny, nx) of a raster in a unit (s), in s; NaN in unburned cells."""
    values = read.values * np.float64(unit)
    return np.where(values < 0.0, np.nan, values)


def read_rasters(
    first: Path,
    unit: float,
    layers: list[tuple[Path, str, float]],
    paths: list[Path],
    options: Options,
    source: str,
    notes: list[str],
) -> Model:
    """Read rasters as a model.

    Parameters
    ----------
    first, unit
        Raster of arrival times, and its unit, s.
    layers
        Other rasters: path, name in `Maps`, and unit in SI.
    paths
        Files of the run, among them its companion rasters.
    """
    arrival = raster.read(first)
    maps = Maps(arrival_times(arrival, unit))
    for path, name, factor in layers:
        layer = raster.read(path)
        if layer.values.shape != arrival.values.shape:
            raise input_error(path, "has another grid than the arrival times")
        setattr(maps, name, np.where(layer.values > 0, layer.values * np.float64(factor), np.nan))
    land = companion_rasters.find(paths, look=True)
    projection = options.projection or arrival.projection or land.projection
    grid, note = arrival.grid(projection, options.at)
    options = Options(options.start, options.at, projection, options.interval)
    files = [first, *(path for path, _, _ in layers)]
    return model(maps, grid, land, options, source, files, [*notes, *([note] if note else [])])


def model(
    maps: Maps,
    grid: Grid,
    land: LandRasters,
    options: Options,
    source: str,
    files: list[Path],
    notes: list[str],
) -> Model:
    """Build a model from maps; the start is the option's (`begun`)."""
    if maps.arrival.shape != grid.shape:
        raise input_error(files[0], f"has arrival times {maps.arrival.shape} on a grid of {grid.shape}")
    for name in ("intensity", "speed", "per_area"):
        values = getattr(maps, name)
        if values is not None and values.shape != grid.shape:
            raise input_error(files[0], f"has {name} {values.shape} on a grid of {grid.shape}")
    fuel = _fuel(maps, grid, land, options.projection, notes)
    category = fuel.category
    lasts = fuels.burn_out(category if category is not None else np.full(grid.shape, np.nan))
    notes.append("heat flux is made of fuel and arrival: all surface and canopy fuel burns, at 17.433 MJ/kg")
    notes.append(
        "a spot's heat comes out at a rate that falls evenly to 0 at three mean burning times of its fuel"
    )
    try:
        release = heat_from_intensity.Release.of(
            maps.arrival, heat_from_intensity.of_fuel(fuel.surface + fuel.canopy), lasts, options.interval
        )
    except Error as error:
        raise input_error(files[0], str(error)) from None
    kept = {} if category is None else {"fuel_category": lambda: category}
    ground = maps.elevation if maps.elevation is not None else land.elevation(grid, options.projection)
    return Model(
        source=source,
        name=f"{source} run",
        start=begun(options, files[0]),
        times=release.times,
        grid=grid,
        fuel_grid=grid,
        still={
            "elevation": lambda: ground,
            "surface_fuel": lambda: fuel.surface,
            "canopy_fuel": lambda: fuel.canopy,
            "fuel_arrival_time": lambda: maps.arrival,
            **kept,
        },
        moving={"heat_flux": release.flux, **_blowing(maps.wind, grid, release.times)},
        files=files,
        projection=options.projection,
        assumptions=notes + land.assumptions,
    )


def _blowing(wind: Wind | None, grid: Grid, times: NDArray[np.float64]) -> dict[str, Moving]:
    """Return the wind fields of a run."""
    if wind is None:
        return {}

    def along(axis: int, index: int) -> NDArray:
        return np.broadcast_to(grid.east_north(*wind(float(times[index])))[axis], grid.shape)

    return {name: partial(along, axis) for axis, name in enumerate(("wind_east", "wind_north"))}


def begun(options: Options, path: Path) -> datetime:
    """Return the time origin, which only the user can give.

    Raises
    ------
    InputError
        `--start` is not given.
    """
    if options.start is None:
        reason = "has no start time; give it: --start 2014-09-17T04:45:00Z"
        raise input_error(path, reason)
    return options.start


def with_start(options: Options, start: datetime) -> Options:
    """Return options with the start from files, unless the user gives one."""
    return options if options.start else replace(options, start=start)


@dataclass(frozen=True)
class _Fuel:
    """Fuel loads, kg/m2, and fuel model numbers of each cell; None without numbers."""

    surface: NDArray
    canopy: NDArray
    category: NDArray | None


def _fuel(maps: Maps, grid: Grid, land: LandRasters, projection: str, notes: list[str]) -> _Fuel:
    """Find fuel in maps or companion rasters; otherwise from the model's heat per area, or constant."""
    category = maps.category if maps.category is not None else land.category(grid, projection)
    canopy = np.nan_to_num(maps.canopy if maps.canopy is not None else land.canopy(grid, projection))
    burned, own = np.isfinite(maps.arrival), _own_heat(maps, grid, canopy, notes)
    by_heat = None if own is None else np.maximum(own / constants.HEAT_OF_COMBUSTION - canopy, 0.0)
    if maps.surface is not None:
        surface, has_fuel = np.nan_to_num(maps.surface), np.isfinite(maps.surface)
    elif category is not None:
        surface = fuels.loads(category) if maps.category is not None else land.surface(grid, projection)
        has_fuel = np.isfinite(category)
    elif by_heat is not None:
        notes.append("surface fuel is heat per area over 17.433 MJ/kg where it burned, their mean elsewhere")
        surface = np.where(burned, by_heat, by_heat[burned].mean() if burned.any() else 0.0)
        return _Fuel(surface.astype(np.float32), canopy, None)
    else:
        return _Fuel(land.surface(grid, projection), canopy, None)
    lacks = burned & ~has_fuel
    if by_heat is not None and lacks.any():
        notes.append(
            f"{lacks.sum():,} burned cells of no known fuel have it by heat per area over 17.433 MJ/kg"
        )
        surface = np.where(lacks, by_heat, surface)
    _compare(own, (surface + canopy)[burned], burned, notes)
    return _Fuel(surface.astype(np.float32), canopy, category)


def _own_heat(maps: Maps, grid: Grid, canopy: NDArray, notes: list[str]) -> NDArray | None:
    """Return the model's heat per area (J/m2), limited to the heaviest fuel; None if there is none.

    The limit is the load of the heaviest standard fuel model and the cell's canopy fuel (kg/m2).
    """
    if maps.per_area is not None:
        heats = np.nan_to_num(np.asarray(maps.per_area, np.float64))
    elif maps.intensity is not None:
        whence = ", by the time of arrival at the neighbours that it came from" if maps.speed is None else ""
        notes.append(f"heat per area is fireline intensity over rate of spread{whence}")
        heats = heat_from_intensity.of_intensity(maps.arrival, maps.intensity, maps.speed, grid.cell)
    else:
        return None
    most = constants.HEAT_OF_COMBUSTION * (fuels.HEAVIEST + canopy)
    burned = np.isfinite(maps.arrival)
    if above := int(np.sum(burned & (heats > most))):
        notes.append(
            f"{above:,} of {burned.sum():,} burned cells have more heat per area than the heaviest fuel "
            f"model, {fuels.HEAVIEST:.3g} kg/m2, and canopy fuel have; it is limited to that"
        )
    return np.minimum(heats, most)


def _compare(own: NDArray | None, load: NDArray, burned: NDArray, notes: list[str]) -> None:
    """Record the ratio of the model's own heat to the fuel's, which the run releases."""
    total = float(heat_from_intensity.of_fuel(load).sum())
    if own is not None and total > 0:
        notes.append(f"the model's heat per area is {float(own[burned].sum()) / total:.3g} times its fuel's")
    without = int((load <= 0).sum())
    if without:
        notes.append(f"{without:,} burned cells have no fuel on the map and release no heat")
