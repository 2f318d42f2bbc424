"""Reader of ForeFire: arrival times written by ``save[]``, with landscape, fuels table and fronts.

The layout was measured on ForeFire 2.5.0's own files: rows from the south, -9999 for unburned without a fill
attribute, no coordinates; cells of Lx/DIMX by Ly/DIMY, which need not be square.
"""

from __future__ import annotations

import json
import re
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from ...files import read_text
from ..models import companion_rasters, forefire_land, from_arrival_time, netcdf, one_run
from ..models.grid import Grid
from ..models.model import Model, Options
from ..models.raster import local

NAME, ORDER = "ForeFire output", 30
MODELS = "ForeFire"

_UNBURNED = -9999.0
_FAR = 84.0  # degrees; the model writes fronts of domains with a UTM corner beyond it


def sniff(path: Path) -> bool:
    """Check whether a file has the model's map of arrival times."""
    dimensions, variables = netcdf.names(path)
    return {"DIMX", "DIMY"} <= dimensions and {"arrival_time_of_front", "domain"} <= variables


def read(paths: list[Path], options: Options) -> Model:
    """Read the map as a model."""
    path = one_run.of_one([path for path in paths if sniff(path)])
    file = netcdf.File(path)
    values = file.read("arrival_time_of_front").astype(np.float64)
    # ignition cells have negative times and are burned
    arrival = np.where(values == _UNBURNED, np.nan, values)
    domain = {name: file.attribute(name, "domain") for name in forefire_land.DOMAIN}
    file.close()
    if not (domain["Lx"] and domain["Ly"] and domain["Lx"] > 0 and domain["Ly"] > 0):
        raise input_error(path, "its domain has no Lx and Ly (size of the map)")
    notes = [
        "a cell that the front touched counts as burned, so areas are 2 to 10 % above the fronts' polygons"
    ]
    fronts = _fronts(paths, notes)
    options = _begun(options, domain, arrival, fronts, notes)
    ny, nx = arrival.shape
    x = domain["SWx"] + domain["Lx"] / nx * (np.arange(nx) + 0.5)
    y = domain["SWy"] + domain["Ly"] / ny * (np.arange(ny) + 0.5)
    land = companion_rasters.find(paths)
    scape = forefire_land.find(paths, path)
    grid = _grid(x, y, domain, arrival, fronts, options, scape, notes)
    maps = from_arrival_time.Maps(arrival)
    if scape:
        forefire_land.take(scape, paths, x, y, maps, notes)
    return from_arrival_time.model(maps, grid, land, options, "ForeFire", [path], notes)


def _begun(options: Options, domain: dict, arrival: NDArray, fronts: list, notes: list[str]) -> Options:
    """Set the start: times count from midnight (UTC) of the reference day, unless dated fronts differ."""
    if options.start is not None or not domain["refYear"] or not domain["refDay"]:
        return options
    day = datetime(int(domain["refYear"]), 1, 1, tzinfo=UTC) + timedelta(days=int(domain["refDay"]) - 1)
    last = float(np.nanmax(arrival)) if np.isfinite(arrival).any() else 0.0
    dated = [front[0] for front in fronts if front[0]]
    if dated and (max(dated) - day).total_seconds() < 0.999 * last - 1:
        dated = []
    if dated and (max(dated) - day).total_seconds() > last + max(600.0, 0.5 * last):
        start = max(dated) - timedelta(seconds=float(np.ceil(last)))
        notes.append(
            f"the last front is of {max(dated):%Y-%m-%d %H:%M:%S} UTC: times count from {start:%H:%M:%S}"
        )
        return from_arrival_time.with_start(options, start)
    notes.append("times count from midnight (UTC) of refDay in refYear; the files give no other time of day")
    return from_arrival_time.with_start(options, day)


def _fronts(paths: list[Path], notes: list[str]) -> list[tuple[datetime | None, float, float, float, float]]:
    """Read date and bounding box (west, south, east, north) of each GeoJSON or KML front."""
    fronts = []
    own: list[str] = []
    far: list[str] = []
    for path in paths:
        if path.suffix.lower() not in (".geojson", ".json", ".kml"):
            continue
        text = read_text(path, errors="replace")
        moment = None
        if path.suffix.lower() == ".kml":
            places = [tuple(map(float, each)) for each in re.findall(r"(-?[\d.]+),(-?[\d.]+),-?[\d.]+", text)]
        else:
            try:
                data = json.loads(text)
                # numbers as text with units, positions in metres, not degrees
                if "fronts" in data:
                    own.append(path.name)
                    continue
                if "valid_at" in data:
                    moment = datetime.fromisoformat(data["valid_at"]).astimezone(UTC)
                places = list(_corners([each["geometry"]["coordinates"] for each in data["features"]]))
            except (ValueError, KeyError, TypeError, RecursionError):
                raise input_error(path, "is not GeoJSON of fronts; remove it") from None
        if not places:
            continue
        x, y = np.array(places, np.float64)[:, :2].T
        if np.abs(y).max() > _FAR:
            far.append(path.name)
            continue
        fronts.append((moment, x.min(), y.min(), x.max(), y.max()))
    for unused, reason in (
        (own, "the model's own JSON, which has no degrees"),
        (far, "beyond 84 degrees, as fronts of a UTM corner are written"),
    ):
        if unused:
            names = unused[0] if len(unused) == 1 else f"{len(unused)} files ({unused[0]} to {unused[-1]})"
            notes.append(f"fronts that are not used: {names}: {reason}")
    return fronts


def _corners(coordinates: object):  # noqa: ANN202
    if isinstance(coordinates, list) and coordinates and isinstance(coordinates[0], int | float):
        yield coordinates[:2]
    elif isinstance(coordinates, list):
        for coordinate in coordinates:
            yield from _corners(coordinate)


def _grid(
    x: NDArray, y: NDArray, domain: dict, arrival: NDArray, fronts: list, options: Options,
    scape: Path | None, notes: list[str],
) -> Grid:  # fmt: skip
    """Georeference the map: by --projection or --at, by the file's box, or by the largest front."""
    if options.projection:
        return Grid.projected(x, y, options.projection)
    boxed = domain if domain["BBoxWSEN"] else forefire_land.domain(scape)
    if not options.at and boxed.get("BBoxWSEN"):
        west, south, east, north = _box(str(boxed["BBoxWSEN"]), scape)
        notes.append("degrees are linear in metres within BBoxWSEN, as in the model's own fronts")
        across, up = (x - boxed["SWx"]) / boxed["Lx"], (y - boxed["SWy"]) / boxed["Ly"]
        return Grid(south + (north - south) * up, west + (east - west) * across)
    if not options.at and fronts and np.isfinite(arrival).any():
        _, west, south, east, north = max(fronts, key=lambda each: (each[3] - each[1]) * (each[4] - each[2]))
        up, across = (np.flatnonzero(np.isfinite(arrival).any(axis=axis)) for axis in (1, 0))
        notes.append("the map is placed so that the middles of what burned and of the largest front agree")
        middle = (x[across[0]] + x[across[-1]]) / 2, (y[up[0]] + y[up[-1]]) / 2
        return Grid.metres(x - middle[0], y - middle[1], ((south + north) / 2, (west + east) / 2))
    grid, said = local(x, y, options.at)
    notes.append(said)
    return grid


def _box(text: str, path: Path | None) -> tuple[float, float, float, float]:
    try:
        west, south, east, north = (float(each) for each in text.split(","))
    except ValueError:
        reason = f"its BBoxWSEN is {text!r}, not west, south, east and north in degrees"
        raise input_error(path or "", reason) from None
    return west, south, east, north
