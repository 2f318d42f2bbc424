"""Landscape of ForeFire, a netCDF-3 file: fuel, altitude and wind, sampled at the points of a map.

Each variable is (NT, NZ, NY, NX) with its own dimensions. All cover the domain, which may be larger than
the map. Values are at cell centres.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import terrain
from numpy.typing import NDArray

from ...errors import input_error
from ...files import read_text
from . import from_arrival_time, given_wind, land_cover, netcdf
from .given_wind import Wind

DOMAIN = ("SWx", "SWy", "Lx", "Ly", "refYear", "refDay", "BBoxWSEN", "t0", "Lt")


def find(paths: list[Path], besides: Path) -> Path | None:
    """Find the landscape file among files; None without one."""
    return next((each for each in paths if each != besides and is_one(each)), None)


def is_one(path: Path) -> bool:
    """Check by its variables whether a file is a landscape."""
    return bool(netcdf.names(path)[1] & {"fuel", "altitude", "windU"})


def domain(path: Path | None) -> dict[str, Any]:
    """Return the corner, size and geographic box of a landscape; empty if it has no size."""
    if path is None:
        return {}
    file = netcdf.File(path)
    try:
        said = {name: file.attribute(name, "domain") for name in DOMAIN} if "domain" in file else {}
    finally:
        file.close()
    return said if (said.get("Lx") or 0) > 0 and (said.get("Ly") or 0) > 0 else {}


@dataclass(frozen=True)
class _Places:
    """Rows and columns of a map as fractions of a landscape's height and width."""

    up: NDArray
    across: NDArray

    def nearest(self, values: NDArray) -> NDArray:
        """Sample nearest-neighbour values at the points."""
        row, column = (
            np.clip(np.floor(share * count), 0, count - 1).astype(int)
            for share, count in zip((self.up, self.across), values.shape, strict=True)
        )
        return values[row[:, None], column[None, :]]

    def between(self, values: NDArray) -> NDArray[np.float32]:
        """Interpolate bilinearly at the points; constant beyond the outermost cell centres."""
        row, column = (
            np.clip(share * count - 0.5, 0, count - 1)
            for share, count in zip((self.up, self.across), values.shape, strict=True)
        )
        return terrain.bilinear(values, row[:, None], column).astype(np.float32)


def take(
    path: Path, paths: list[Path], x: NDArray, y: NDArray, maps: from_arrival_time.Maps, notes: list[str]
) -> None:
    """Sample a landscape's fuel, altitude and wind at points (m), and record their origin in `notes`."""
    box = domain(path)
    if not box:
        notes.append(f"{path.name} has no size: the size of the map is assumed")
        box = {"SWx": 1.5 * x[0] - 0.5 * x[1], "SWy": 1.5 * y[0] - 0.5 * y[1]}
        box |= {"Lx": len(x) * (x[1] - x[0]), "Ly": len(y) * (y[1] - y[0])}
    places = _Places((y - box["SWy"]) / box["Ly"], (x - box["SWx"]) / box["Lx"])
    file = netcdf.File(path)
    try:
        if "altitude" in file:
            values = _first(file, "altitude")
            maps.elevation = places.between(values)
            whole = ", whole metres there" if np.issubdtype(values.dtype, np.integer) else ""
            notes.append(f"elevation is altitude of {path.name}, bilinear between its cells{whole}")
        if "fuel" in file:
            _take_fuel(file, paths, places, maps, notes)
        maps.wind = _wind(file, box, places, notes)
    finally:
        file.close()


def _take_fuel(
    file: netcdf.File, paths: list[Path], places: _Places, maps: from_arrival_time.Maps, notes: list[str]
) -> None:
    """Take fuel by the model's fuels table, or by the legend that the layer's numbers belong to."""
    index, name = places.nearest(_first(file, "fuel")), file.path.name
    if table := next((each for each in paths if _is_table(each)), None):
        maps.surface = np.zeros(maps.arrival.shape, np.float32)
        for number, load in _loads(table).items():
            maps.surface[index == number] = load
        notes.append(f"surface fuel is Sigmad, the dead load, of {table.name}, by the nearest fuel of {name}")
    elif legend := land_cover.categories(index):
        maps.category, said = legend
        notes.append(f"fuel of {name} has the numbers of {said}")
    else:
        numbers = [str(number) for number in np.unique(index)[:6]]
        notes.append(
            f"fuel of {name} is not used: its numbers ({', '.join(numbers)}) belong to no known legend; "
            "add the model's fuels table (Index;Sigmad) to the files"
        )


def _first(file: netcdf.File, name: str) -> NDArray:
    """Return cells (NY, NX) of the first time and level."""
    return file.read(name, *[0] * (len(file.shape(name)) - 2))


def _wind(file: netcdf.File, box: dict[str, Any], places: _Places, notes: list[str]) -> Wind | None:
    """Read WindU and WindV, m/s; several times divide the domain's Lt seconds from t0 evenly."""
    name = file.path.name
    if not {"windU", "windV"} <= set(file.variables):
        if "wind" in file:
            notes.append(f"wind of {name} is the response to an unspecified wind: not used")
        return None
    shapes = [file.shape(component) for component in ("windU", "windV")]
    if shapes[0] != shapes[1] or not 2 <= len(shapes[0]) <= 4:
        raise file.error(f"has windU {shapes[0]} and windV {shapes[1]}, not both (NT, NZ, NY, NX)")
    times, levels = (*[1] * (4 - len(shapes[0])), *shapes[0])[:2]
    if levels > 1:
        notes.append(f"windU and windV of {name} are the response to an unspecified wind: not used")
        return None
    begin, lasts = float(box.get("t0") or 0.0), float(box.get("Lt") or 0.0)
    if times > 1 and not 0 < lasts < np.inf:
        notes.append(f"{name} has {times} winds without their duration (Lt): the first is used")
        times = 1
    leading = len(shapes[0]) - 2
    u, v = (
        [
            places.between(file.read(component, *(index, 0)[2 - leading :] if leading else ()))
            for index in range(times)
        ]
        for component in ("windU", "windV")
    )
    notes.append(f"wind is windU and windV of {name} (m/s), bilinear between its cells")
    return given_wind.steps(np.stack(u), np.stack(v), begin, lasts / times)


def _is_table(path: Path) -> bool:
    """Check whether a file is a fuels table; fronts and scripts of the model also end in .ff."""
    if path.suffix.lower() not in (".ff", ".csv"):
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        return {"Index", "Sigmad"} <= set(file.readline(10_000).strip().split(";"))


def _loads(path: Path) -> dict[int, float]:
    rows = csv.DictReader(read_text(path, errors="replace").splitlines(), delimiter=";")
    try:
        return {int(row["Index"]): float(row["Sigmad"]) for row in rows}
    except (KeyError, ValueError, TypeError):
        raise input_error(
            path, "not a fuels table of ForeFire (columns Index and Sigmad are missing)"
        ) from None
