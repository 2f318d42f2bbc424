"""Reader of FARSITE and FlamMap: arrival times as ASCII grid or GeoTIFF, other layers and landscape (LCP).

Such a raster has no metadata on its content, so FlamMap's file name ("arrival") decides.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...errors import input_error
from ..models import companion_rasters, from_arrival_time, probability_maps, raster
from ..models.model import Model, Options

NAME, ORDER = "FARSITE or FlamMap output", 50
MODELS = "FARSITE, FlamMap"
RASTER = "FIRE_Arrival Time.asc as FlamMap does (min)"

_UNITS = {"intensity": 1e3, "speed": 1 / 60.0, "per_area": 1e3}  # kW/m, m/min, kJ/m2


def sniff(path: Path) -> bool:
    """Check by its name whether a raster has arrival times of one simulation, in minutes."""
    return (
        raster.is_raster(path) and raster.role(path) == "arrival" and probability_maps.refusal(path) is None
    )


def resembles(path: Path) -> bool:
    """Check whether a file is a raster, or has the suffix of a landscape."""
    return raster.is_raster(path) or (path.suffix.lower() == ".lcp" and path.is_file())


def why(paths: list[Path]) -> str:
    """Say that a landscape is not enough."""
    lands = any(path.suffix.lower() == ".lcp" for path in paths)
    return "a landscape without a fire: give its arrival times too" if lands else ""


def read(paths: list[Path], options: Options) -> Model:
    """Read the raster and the files next to it as a model."""
    first = next(path for path in paths if sniff(path))
    arrival = raster.read(first)
    notes = [
        "arrival times are in minutes, intensity in kW/m, rate of spread in m/min, heat per area in kJ/m2"
    ]
    values = arrival.values * np.float64(60.0)
    maps = from_arrival_time.Maps(np.where(values < 0, np.nan, values))
    files = [first]
    for path in paths:
        role = raster.role(path)
        if role in _UNITS and raster.is_raster(path):
            layer = raster.read(path)
            if layer.values.shape != arrival.values.shape:
                raise input_error(path, "has another grid than the arrival times")
            setattr(maps, role, np.where(layer.values > 0, layer.values * np.float64(_UNITS[role]), np.nan))
            files.append(path)
    land = companion_rasters.find(paths, look=True)
    projection = options.projection or arrival.projection or land.projection
    grid, said = arrival.grid(projection, options.at)
    made_of = Options(options.start, options.at, projection, options.interval)
    return from_arrival_time.model(
        maps, grid, land, made_of, "FARSITE or FlamMap", files, [*notes, said] if said else notes
    )
