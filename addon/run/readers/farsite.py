"""Reader of FARSITE and FlamMap: arrival times as ASCII grid or GeoTIFF, other layers and landscape (LCP).

Such a raster has no metadata on its content, so FlamMap's file name ("arrival") decides.
"""

from __future__ import annotations

from pathlib import Path

from ..models import from_arrival_time, probability_maps, raster
from ..models.model import Model, Options

NAME, ORDER = "FARSITE or FlamMap output", 50
MODELS = "FARSITE, FlamMap"
RASTER = "FIRE_Arrival Time.asc as FlamMap does (min)"

MINUTE = 60.0
"""Unit of arrival times, s."""
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
    notes = [
        "arrival times are in minutes, intensity in kW/m, rate of spread in m/min, heat per area in kJ/m2"
    ]
    roles = {path: raster.role(path) for path in paths if raster.is_raster(path)}
    layers = [(path, role, _UNITS[role]) for path, role in roles.items() if role in _UNITS]
    return from_arrival_time.read_rasters(first, MINUTE, layers, paths, options, "FARSITE or FlamMap", notes)
