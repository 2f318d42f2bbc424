"""Companion rasters: fuels and elevation from files next to a model's output, as LCP or LANDFIRE layers."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import Error, input_error
from . import fuels, raster
from .grid import Grid
from .model import Still

_LAYERS = ("elevation", "category", "bulk_density", "base_height", "height")
_DEFAULT_LOAD = 1.0  # kg/m2, fuel load if no file has one


@dataclass
class LandRasters:
    """Layers by role, in m and kg/m3, with assumptions about them and files not named by the user."""

    layers: dict[str, raster.Raster]
    assumptions: list[str] = field(default_factory=list)
    unnamed: set[Path] = field(default_factory=set)

    @property
    def projection(self) -> str:
        """Projection of the first layer that has one, else empty."""
        return next((layer.projection for layer in self.layers.values() if layer.projection), "")

    def on(self, name: str, grid: Grid, projection: str) -> NDArray[np.float32] | None:
        """Resample a layer to a grid by nearest neighbour, NaN without data; None without such a layer."""
        layer = self.layers.get(name)
        if layer is None:
            return None
        if layer.projection or projection:
            values = layer.on(grid, projection)
            if np.isfinite(values).any():
                return values
            self.say(f"{layer.path.name} does not overlap the model's grid and is not used")
            del self.layers[name]
            return None
        if layer.values.shape == grid.shape:
            return layer.values
        if layer.path in self.unnamed:
            self.say(f"{layer.path.name} has no projection and is not used")
            del self.layers[name]
            return None
        reason = "has no projection; add a .prj of the same name, or give --projection EPSG:..."
        raise input_error(layer.path, reason)

    def category(self, grid: Grid, projection: str) -> NDArray[np.float32] | None:
        """Return the fuel model number of each cell."""
        return self.on("category", grid, projection)

    def surface(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Return the surface fuel (kg/m2) by fuel model number, or one load everywhere without numbers."""
        number = self.category(grid, projection)
        if number is not None:
            self.say("surface fuel is the whole load of the standard fuel model's number, dead and live")
            return fuels.loads(number)
        self.say(f"no fuel data: {_DEFAULT_LOAD:g} kg/m2 of surface fuel is assumed everywhere")
        return np.full(grid.shape, _DEFAULT_LOAD, np.float32)

    def canopy(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Compute canopy fuel (kg/m2): canopy bulk density times crown depth; 0 without these layers."""
        density, height = (self.on(name, grid, projection) for name in ("bulk_density", "height"))
        if density is None or height is None:
            self.say("no canopy data: none is assumed")
            return np.zeros(grid.shape, np.float32)
        base = self.on("base_height", grid, projection)
        depth = np.maximum(height - (0.0 if base is None else base), 0.0)
        self.say("canopy fuel is canopy bulk density times height above the canopy's base")
        return np.nan_to_num(density * depth)

    def elevation(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Return the elevation (m); 0 without data."""
        heights = self.on("elevation", grid, projection)
        if heights is None:
            self.say("no elevation data: the ground is flat, at 0 m")
            return np.zeros(grid.shape, np.float32)
        return np.nan_to_num(heights, nan=float(np.nanmin(heights)) if np.isfinite(heights).any() else 0.0)

    def complete(self, still: dict[str, Still], grid: Grid, fuel_grid: Grid, projection: str) -> None:
        """Add elevation and fuels if they are missing in a model's files, and collect the assumptions."""
        for name, find, where in (
            ("elevation", self.elevation, grid),
            ("surface_fuel", self.surface, fuel_grid),
            ("canopy_fuel", self.canopy, fuel_grid),
        ):
            if name not in still:
                still[name] = partial(np.asarray, find(where, projection))
        number = self.category(fuel_grid, projection)
        if "fuel_category" not in still and number is not None:
            still["fuel_category"] = lambda: number

    def say(self, text: str) -> None:
        """Record an assumption, without duplicates."""
        if text not in self.assumptions:
            self.assumptions.append(text)


def find(paths: list[Path], look: bool = False) -> LandRasters:
    """Collect layers by LCP header or by raster name; `look`: also from files in the same folders."""
    land = LandRasters({})
    for path in paths:
        land.layers |= _layers(path)
    if look and "category" not in land.layers:
        _find_unnamed(land, paths)
    return land


def _layers(path: Path) -> dict[str, raster.Raster]:
    """Return layers of a file, by role."""
    if path.suffix.lower() == ".lcp":
        return raster.landscape(path)
    name = raster.role(path)
    return {name: _in_units(raster.read(path), name)} if name in _LAYERS and raster.is_raster(path) else {}


def _find_unnamed(land: LandRasters, paths: list[Path]) -> None:
    """Add layers of files not named by the user: in the same folders, and in ELMFIRE's `inputs`."""
    folders = {path.parent for path in paths} | {path.parent.parent / "inputs" for path in paths}
    there = [file for folder in sorted(folders) if folder.is_dir() for file in sorted(folder.iterdir())]
    roles: dict[str, list[Path]] = {}
    for path in there:
        role = "LCP" if path.suffix.lower() == ".lcp" else raster.role(path)
        if path not in paths and path.is_file() and (role == "LCP" or role in _LAYERS):
            roles.setdefault(role, []).append(path)
    for role, candidates in roles.items():
        if len(candidates) > 1:
            land.say(f"{len(candidates)} files next to it could be its {role}; name one of them to use it")
            continue
        try:
            layers = {k: v for k, v in _layers(candidates[0]).items() if k not in land.layers}
        except Error as error:
            land.say(f"companion rasters are not used: {error}")
            continue
        land.layers, land.unnamed = land.layers | layers, land.unnamed | {candidates[0]}
        if layers:
            land.say(f"{candidates[0].name}, a companion raster, supplies {', '.join(layers)}")


def _in_units(layer: raster.Raster, name: str) -> raster.Raster:
    """Convert units: LANDFIRE and ELMFIRE store heights as integer m x 10, bulk density as kg/m3 x 100."""
    scale = {"height": 0.1, "base_height": 0.1, "bulk_density": 0.01}.get(name, 1.0)
    if not layer.whole or scale == 1.0:
        return layer
    values = layer.values * np.float32(scale)
    return raster.Raster(layer.path, values, layer.x, layer.y, layer.projection)
