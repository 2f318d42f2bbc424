"""ELMFIRE: ``time_of_arrival_<case>_<seconds>.tif`` and its layers, its inputs (fbfm40, cbd, ...) beside.

Names and units: ELMFIRE, build/source/elmfire_io.f90 and docs/user_guide/io.rst.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ...errors import input_error
from ..models import companion_rasters, from_arrival_time, raster
from ..models.model import Model, Options

NAME = "ELMFIRE output"

_ARRIVAL = re.compile(r"time_of_arrival_(\d{7})_(\d+)$")
_FOOT_A_MINUTE = 0.3048 / 60.0
_UNITS = {"flin": ("intensity", 1e3), "vs": ("speed", _FOOT_A_MINUTE), "hpua": ("per_area", 1e3)}


def sniff(path: Path) -> bool:
    """Whether it is a raster of the model's own name for arrival times: the numbers themselves do not say."""
    return bool(_ARRIVAL.search(path.stem)) and raster.is_raster(path)


def read(paths: list[Path], options: Options) -> Model:
    """One case as a model: that of the latest arrival map."""
    ours = sorted((path for path in paths if sniff(path)), key=lambda path: _key(path)[::-1])
    first = ours[-1]
    case, seconds = _key(first)
    cases = sorted({_key(path)[0] for path in ours})
    told = ["time_of_arrival is in s, flin in kW/m, vs in ft/min, hpua in kJ/m2"]
    if len(cases) > 1:
        told.append(f"of {len(cases)} cases it is {case}")
    arrival = raster.read(first)
    land = companion_rasters.find(paths, look=True)
    projection = options.projection or arrival.projection or land.projection
    grid, said = arrival.grid(projection, options.at)
    maps = from_arrival_time.Maps(np.where(arrival.values < 0, np.nan, arrival.values))
    files = [first]
    for path in paths:
        found = re.fullmatch(rf"(flin|vs|hpua)_{case}_{seconds:0>7}", path.stem)
        if found and raster.is_raster(path):
            layer = raster.read(path)
            if layer.values.shape != arrival.values.shape:
                raise input_error(path, 0, 0, "has another grid than the arrival times")
            name, unit = _UNITS[found[1]]
            setattr(maps, name, np.where(layer.values > 0, layer.values * np.float64(unit), np.nan))
            files.append(path)
    made_of = Options(options.start, options.at, projection, options.interval)
    return from_arrival_time.model(
        maps, grid, land, made_of, "ELMFIRE", files, [*told, said] if said else told
    )


def _key(path: Path) -> tuple[str, str]:
    found = _ARRIVAL.search(path.stem)
    return (found[1], found[2]) if found else ("", "")
