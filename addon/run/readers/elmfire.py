"""Reader of ELMFIRE: ``time_of_arrival_<case>_<seconds>.tif``, its layers, and its inputs (fbfm40, cbd, ...).

Names and units: ELMFIRE, build/source/elmfire_io.f90 and docs/user_guide/io.rst.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ...errors import input_error
from ..models import companion_rasters, from_arrival_time, raster
from ..models.model import Model, Options

NAME, ORDER = "ELMFIRE output", 40
MODELS = "ELMFIRE"
RASTER = "time_of_arrival_0000001_0003600.tif as ELMFIRE does (s)"

_ARRIVAL = re.compile(r"time_of_arrival_(\d{7})_(\d+)$")
_FOOT_A_MINUTE = 0.3048 / 60.0
_UNITS = {"flin": ("intensity", 1e3), "vs": ("speed", _FOOT_A_MINUTE), "hpua": ("per_area", 1e3)}


def sniff(path: Path) -> bool:
    """Check whether a raster has the model's name for arrival times, as its values do not identify it."""
    return bool(_ARRIVAL.search(path.stem)) and raster.is_raster(path)


def read(paths: list[Path], options: Options) -> Model:
    """Read one case as a model: the case with the latest arrival map."""
    ours = sorted((path for path in paths if sniff(path)), key=lambda path: _key(path)[::-1])
    first = ours[-1]
    case, seconds = _key(first)
    cases = sorted({_key(path)[0] for path in ours})
    notes = ["time_of_arrival is in s, flin in kW/m, vs in ft/min, hpua in kJ/m2"]
    if len(cases) > 1:
        notes.append(f"of {len(cases)} cases it is {case}")
    arrival = raster.read(first)
    land = companion_rasters.find(paths, look=True)
    projection = options.projection or arrival.projection or land.projection
    grid, said = arrival.grid(projection, options.at)
    maps = from_arrival_time.Maps(np.where(arrival.values < 0, np.nan, arrival.values))
    files = [first]
    for path in paths:
        match = re.fullmatch(rf"(flin|vs|hpua)_{case}_{seconds:0>7}", path.stem)
        if match and raster.is_raster(path):
            layer = raster.read(path)
            if layer.values.shape != arrival.values.shape:
                raise input_error(path, "has another grid than the arrival times")
            name, unit = _UNITS[match[1]]
            setattr(maps, name, np.where(layer.values > 0, layer.values * np.float64(unit), np.nan))
            files.append(path)
    made_of = Options(options.start, options.at, projection, options.interval)
    return from_arrival_time.model(
        maps, grid, land, made_of, "ELMFIRE", files, [*notes, said] if said else notes
    )


def _key(path: Path) -> tuple[str, str]:
    match = _ARRIVAL.search(path.stem)
    return (match[1], match[2]) if match else ("", "")
