"""Fuels and heights from rasters beside a model's files: an LCP, or LANDFIRE's and ELMFIRE's layers."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from . import fuels, raster
from .grid import Grid
from .model import Still

_LAYERS = ("elevation", "category", "bulk_density", "base_height", "height")
_UNSAID = 1.0  # kg/m2, where nothing says what burned


@dataclass
class Land:
    """Layers by role, in m and kg/m3, and what was assumed of them."""

    layers: dict[str, raster.Raster]
    assumptions: list[str] = field(default_factory=list)

    def on(self, name: str, grid: Grid, projection: str) -> NDArray[np.float32] | None:
        """A layer's nearest values on a grid, NaN where it has none; None: there is no such layer."""
        layer = self.layers.get(name)
        if layer is None:
            return None
        if layer.projection or projection:
            return layer.on(grid, projection)
        if layer.values.shape == grid.shape:
            return layer.values
        reason = "does not say its projection; put a .prj beside it, or say --projection EPSG:..."
        raise input_error(layer.path, 0, 0, reason)

    def category(self, grid: Grid, projection: str) -> NDArray[np.float32] | None:
        """Number of the fuel model in each cell."""
        return self.on("category", grid, projection)

    def surface(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Surface fuel (kg/m2), of the fuel models, else one load wherever."""
        number = self.category(grid, projection)
        if number is not None:
            self.say("surface fuel is the whole load of the standard fuel model's number, dead and live")
            return fuels.loads(number)
        self.say(f"nothing says what fuel there is: {_UNSAID:g} kg/m2 of surface fuel everywhere is assumed")
        return np.full(grid.shape, _UNSAID, np.float32)

    def canopy(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Canopy fuel (kg/m2): canopy bulk density times the crowns' depth, 0 without the layers."""
        density, height = (self.on(name, grid, projection) for name in ("bulk_density", "height"))
        if density is None or height is None:
            self.say("nothing says what canopy there is: none is assumed")
            return np.zeros(grid.shape, np.float32)
        base = self.on("base_height", grid, projection)
        depth = np.maximum(height - (0.0 if base is None else base), 0.0)
        self.say("canopy fuel is canopy bulk density times height above the canopy's base")
        return np.nan_to_num(density * depth)

    def elevation(self, grid: Grid, projection: str) -> NDArray[np.float32]:
        """Height of the ground (m), 0 where nothing says it."""
        found = self.on("elevation", grid, projection)
        if found is None:
            self.say("nothing says how high the ground lies: it is flat, at 0 m")
            return np.zeros(grid.shape, np.float32)
        return np.nan_to_num(found, nan=float(np.nanmin(found)) if np.isfinite(found).any() else 0.0)

    def complete(self, still: dict[str, Still], grid: Grid, fuel_grid: Grid, projection: str) -> None:
        """Add elevation and fuels where a model's files lack them; found here, so that all of it is said."""
        for name, find, where in (
            ("elevation", self.elevation, grid),
            ("surface_fuel", self.surface, fuel_grid),
            ("canopy_fuel", self.canopy, fuel_grid),
        ):
            if name not in still:
                values = find(where, projection)
                still[name] = lambda values=values: values
        number = self.category(fuel_grid, projection)
        if "fuel_category" not in still and number is not None:
            still["fuel_category"] = lambda: number

    def say(self, text: str) -> None:
        """An assumption, said once."""
        if text not in self.assumptions:
            self.assumptions.append(text)


def find(paths: list[Path]) -> Land:
    """Layers among files, by LCP header or by raster and name."""
    land = Land({})
    for path in paths:
        if path.suffix.lower() == ".lcp":
            land.layers |= raster.landscape(path)
        elif (name := raster.role(path)) in _LAYERS and raster.is_raster(path):
            land.layers[name] = _in_units(raster.read(path), name)
    return land


def _in_units(layer: raster.Raster, name: str) -> raster.Raster:
    """LANDFIRE and ELMFIRE write heights as whole m x 10, bulk density as whole kg/m3 x 100."""
    scale = {"height": 0.1, "base_height": 0.1, "bulk_density": 0.01}.get(name, 1.0)
    if not layer.whole or scale == 1.0:
        return layer
    values = layer.values * np.float32(scale)
    return raster.Raster(layer.path, values, layer.x, layer.y, layer.projection)
