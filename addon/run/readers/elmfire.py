"""Reader of ELMFIRE: ``time_of_arrival_<case>_<seconds>.tif``, its layers, and its inputs (fbfm40, cbd, ...).

Names and units: ELMFIRE, build/source/elmfire_io.f90 and docs/user_guide/io.rst.
"""

from __future__ import annotations

import re
from pathlib import Path

from ..models import from_arrival_time, raster
from ..models.model import Model, Options

NAME, ORDER = "ELMFIRE output", 40
MODELS = "ELMFIRE"
RASTER = "time_of_arrival_0000001_0003600.tif as ELMFIRE does (s)"

_ARRIVAL = re.compile(r"time_of_arrival_(\d{7})_(\d+)$")
SECOND = 1.0
"""Unit of arrival times, s."""
_FOOT_A_MINUTE = 0.3048 / 60.0
_UNITS = {"flin": ("intensity", 1e3), "vs": ("speed", _FOOT_A_MINUTE), "hpua": ("per_area", 1e3)}


def sniff(path: Path) -> bool:
    """Check whether a raster has the model's name for arrival times, as its values do not identify it."""
    return bool(_ARRIVAL.search(path.stem)) and raster.is_raster(path)


def read(paths: list[Path], options: Options) -> Model:
    """Read one case as a model: the case with the latest arrival map."""
    ours = sorted((path for path in paths if sniff(path)), key=lambda path: case_of(path)[::-1])
    case, seconds = case_of(ours[-1])
    cases = {case_of(path)[0] for path in ours}
    notes = ["time_of_arrival is in s, flin in kW/m, vs in ft/min, hpua in kJ/m2"]
    if len(cases) > 1:
        notes.append(f"of {len(cases)} cases it is {case}")
    layers = []
    for path in paths:
        match = re.fullmatch(rf"(flin|vs|hpua)_{case}_{seconds:0>7}", path.stem)
        if match and raster.is_raster(path):
            layers.append((path, *_UNITS[match[1]]))
    return from_arrival_time.read_rasters(ours[-1], SECOND, layers, paths, options, "ELMFIRE", notes)


def case_of(path: Path) -> tuple[str, str]:
    """Return the case and the seconds in the name of an arrival map; empty for other files."""
    match = _ARRIVAL.search(path.stem)
    return (match[1], match[2]) if match else ("", "")
