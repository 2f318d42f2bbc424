"""Reader of netCDF files and zarr stores with CF conventions, by a mapping in TOML from fields to variables.

``[fields]`` has a line per field: ``heat_flux = "hfx"``, or a table with `variable`, `scale` and `offset`
(the field is scale x variable + offset). Variables with a field's own name need no line. Coordinates are
identified by units and standard names; ``[axes]`` names them if these are missing.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error, reading
from ...files import read_text
from ...limits import SETTINGS_BYTES
from ...toml_text import loads
from ..models import companion_rasters, from_arrival_time, masks, netcdf, optional_packages, zarr_store
from ..models.grid import Grid
from ..models.model import Model, Options, read_until

NAME, ORDER = "netCDF or zarr with latitude, longitude and time", 100
MODELS = "or netCDF or zarr with latitude and longitude"

_MOVING = ("heat_flux", "burned_fraction", "temperature", "wind_east", "wind_north")
_LEVELS = ("smoke_3d", "temperature_3d", "height_3d", "wind_east_3d", "wind_north_3d", "wind_up_3d")
_STILL = ("elevation", "surface_fuel", "canopy_fuel", "fuel_arrival_time", "fuel_category")


def sniff(path: Path) -> bool:
    """Check whether a file is any netCDF file or zarr store; this reader is tried last."""
    return netcdf.is_netcdf(path) or zarr_store.is_store(path)


def resembles(path: Path) -> bool:
    """Check whether a file begins as netCDF does, or a folder is a zarr store."""
    return netcdf.is_netcdf(path) or (path.is_dir() and zarr_store.is_store(path))


def read(paths: list[Path], options: Options) -> Model:
    """Read the files' times as a model."""
    fields, axes = _mapping(options.mapping)
    files = netcdf.Files(_open)
    ours = sorted(path for path in paths if sniff(path))
    first = files(ours[0])
    source = first.kind.split()[0]
    fields = {name: {"variable": name} for name in (*_MOVING, *_LEVELS, *_STILL) if name in first} | fields
    if not {"heat_flux", "fuel_arrival_time", "burned_fraction"} & set(fields):
        reason = (
            f"does not belong to a known model; map its variables ({_some(first)}) "
            'in a TOML file next to it: [fields] heat_flux = "NAME", or fuel_arrival_time or burned_fraction'
        )
        raise first.error(reason)
    grid, projection = _grid(first, axes, options, next(iter(fields.values()))["variable"])
    land = companion_rasters.find(paths)
    notes: list[str] = []

    def get(name: str, path: Path, *index: int) -> NDArray:
        entry = fields[name]
        values = files(path).read(entry["variable"], *index)
        if "scale" in entry or "offset" in entry:
            values = values * float(entry.get("scale", 1.0)) + float(entry.get("offset", 0.0))
        return values

    def still(name: str) -> NDArray:
        shape = files(ours[0]).shape(fields[name]["variable"])
        return get(name, ours[0], *[0] * (len(shape) - 2))

    def moved(name: str, i: int) -> NDArray:
        return get(name, frames[i][1], frames[i][2])

    def maps_with(arrival: NDArray) -> from_arrival_time.Maps:
        maps = from_arrival_time.Maps(arrival)
        for name in ("surface_fuel", "canopy_fuel", "elevation", "fuel_category"):
            if name in fields:
                setattr(maps, name.removesuffix("_fuel").removeprefix("fuel_"), still(name))
        return maps

    if "heat_flux" not in fields and "fuel_arrival_time" in fields:
        maps = maps_with(still("fuel_arrival_time").astype(np.float64))
        return from_arrival_time.model(maps, grid, land, options, source, ours, notes)

    def moments(path: Path) -> list[datetime]:
        every = _moments(files(path), axes, options)
        return every[: _written(files(path), fields)] if options.growing else every

    frames = sorted(
        (
            (moment, path, i)
            for path in ours
            for i, moment in enumerate(moments(path))
            if read_until(moment, options)
        ),
        key=lambda frame: frame[0],
    )
    if not frames:
        raise first.error("has no times yet")
    frames = [each for k, each in enumerate(frames) if k == 0 or each[0] > frames[k - 1][0]]
    start = frames[0][0]
    if "heat_flux" not in fields:
        times = masks.since([moment for moment, _, _ in frames])
        begun = replace(options, start=start, projection=projection)
        return masks.model(
            times,
            partial(moved, "burned_fraction"),
            grid,
            land,
            begun,
            source,
            ours,
            notes,
            maps_with(np.empty(0)),
        )
    first = files(ours[0])  # it may have been closed to limit open files
    model = Model(
        source=f"{source} (CF)",
        name=str(first.attribute("title", otherwise=ours[0].stem)),
        start=start,
        times=np.array([(moment - start).total_seconds() for moment, _, _ in frames]),
        grid=grid,
        fuel_grid=grid,
        still={name: partial(still, name) for name in _STILL if name in fields},
        moving={name: partial(moved, name) for name in (*_MOVING, *_LEVELS) if name in fields},
        files=ours,
        projection=projection,
        sources=[(path, i) for _, path, i in frames],
        close=files.close,
    )
    model.levels = {name: first.shape(fields[name]["variable"])[1] for name in _LEVELS if name in fields}
    if "fuel_arrival_time" not in fields:
        notes.append("no arrival times: the front is derived from heat fluxes")
    land.complete(model.still, grid, grid, options.projection)
    model.assumptions = notes + land.assumptions
    return model


def _open(path: Path) -> netcdf.File:
    return zarr_store.ZarrFile(path) if zarr_store.is_store(path) else netcdf.File(path)


def _mapping(path: Path | None) -> tuple[dict[str, dict[str, Any]], dict[str, str]]:
    if path is None:
        return {}, {}
    with reading(path):
        data = loads(path, read_text(path, "utf-8-sig", most=SETTINGS_BYTES))
    known = (*_MOVING, *_LEVELS, *_STILL)
    fields = {}
    for name, entry in data.get("fields", {}).items():
        if name not in known:
            raise input_error(path, f"unknown field {name}; fields are {', '.join(known)}")
        fields[name] = {"variable": entry} if isinstance(entry, str) else dict(entry)
        if not isinstance(fields[name].get("variable"), str):
            raise input_error(path, f"{name} has no variable name in quotes")
    return fields, dict(data.get("axes", {}))


def _grid(file: netcdf.File, axes: dict[str, str], options: Options, of: str) -> tuple[Grid, str]:
    latitude, longitude = (
        axes.get(name) or _coordinate(file, name, units)
        for name, units in (("latitude", "degrees_north"), ("longitude", "degrees_east"))
    )
    if latitude and longitude:
        return Grid(*(file.read(name).astype(np.float64) for name in (latitude, longitude))), ""
    x, y = (axes.get(name) or _coordinate(file, f"projection_{name}_coordinate", "") for name in "xy")
    projection = options.projection or _crs(file, of)
    if not (x and y and projection):
        raise file.error(
            "has no latitude and longitude by their units (degrees_north, degrees_east), nor x and y of a "
            'projection; [axes] latitude = "NAME" in a TOML file says which they are'
        )
    across, up = (file.read(name).astype(np.float64) for name in (x, y))
    return Grid.projected(across, up, projection), projection


def _crs(file: netcdf.File, of: str) -> str:
    name = file.attribute("grid_mapping", of)
    if not name or name not in file:
        return ""
    with file.sense():
        variable = file.variables[name]
        return (
            optional_packages.package("pyproj")
            .CRS.from_cf({k: variable.getncattr(k) for k in variable.ncattrs()})
            .to_wkt()
        )


def _coordinate(file: netcdf.File, standard_name: str, units: str) -> str:
    for name in file.variables:
        if file.attribute("standard_name", name) == standard_name or (
            units
            and file.attribute("units", name)
            in (units, units.removesuffix("s"), units.replace("degrees", "degree"))
        ):
            return name
    return ""


def _moments(file: netcdf.File, axes: dict[str, str], options: Options) -> list[datetime]:
    name = axes.get("time") or next(
        (variable for variable in file.variables if " since " in str(file.attribute("units", variable, ""))),
        "",
    )
    if not name:
        raise file.error(
            'has no time by its units ("seconds since ..."); [axes] time = "NAME" in a TOML file says it'
        )
    values = np.atleast_1d(file.read(name)).astype(np.float64)
    units, calendar = (
        str(file.attribute("units", name, "")),
        str(file.attribute("calendar", name, "standard")),
    )
    if options.growing:
        values = values[: _first_unwritten(values)]
    if " since " not in units:
        begin = from_arrival_time.begun(options, file.path)
        return [begin + timedelta(seconds=float(value)) for value in values]
    with file.sense():
        dates = optional_packages.package("netCDF4").num2date(
            values, units, calendar, only_use_cftime_datetimes=False
        )
        return [
            datetime(
                each.year,
                each.month,
                each.day,
                each.hour,
                each.minute,
                each.second,
                each.microsecond,
                tzinfo=UTC,
            )
            for each in np.atleast_1d(dates)
        ]


def _first_unwritten(values: NDArray[np.float64]) -> int:
    """Return the index of the first time that has no value yet, or is not later than the one before."""
    bad = ~np.isfinite(values) | (np.abs(values) >= netcdf.UNWRITTEN)
    bad[1:] |= ~(values[1:] > values[:-1])
    return int(np.argmax(bad)) if bad.any() else len(values)


def _written(file: netcdf.File, fields: dict[str, dict[str, Any]]) -> int:
    """Count the times up to which the fields of a growing file exist: the shortest array counts."""
    names = [fields[name]["variable"] for name in (*_MOVING, *_LEVELS) if name in fields]
    counts = [file.shape(name)[0] for name in names]
    return min([*counts, *([zarr_store.written(file.path, names)] if zarr_store.is_store(file.path) else [])])


def _some(file: netcdf.File) -> str:
    return ", ".join(sorted(file.variables)[:12]) or "none"
