"""Fuels and heights from rasters beside a model's files: an LCP, or LANDFIRE's and ELMFIRE's layers."""

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
_UNSAID = 1.0  # kg/m2, where nothing says what burned


@dataclass
class Land:
    """Layers by role, in m and kg/m3, what was assumed of them, and which files nobody named."""

    layers: dict[str, raster.Raster]
    assumptions: list[str] = field(default_factory=list)
    unnamed: set[Path] = field(default_factory=set)

    @property
    def projection(self) -> str:
        """The first that a layer says, else nothing."""
        return next((each.projection for each in self.layers.values() if each.projection), "")

    def on(self, name: str, grid: Grid, projection: str) -> NDArray[np.float32] | None:
        """A layer's nearest values on a grid, NaN where it has none; None: there is no such layer."""
        layer = self.layers.get(name)
        if layer is None:
            return None
        if layer.projection or projection:
            found = layer.on(grid, projection)
            if np.isfinite(found).any():
                return found
            self.say(f"{layer.path.name} lies nowhere on the model's grid and is not used")
            del self.layers[name]
            return None
        if layer.values.shape == grid.shape:
            return layer.values
        if layer.path in self.unnamed:
            self.say(f"{layer.path.name} lies beside it but says no projection, and is not used")
            del self.layers[name]
            return None
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
                still[name] = partial(np.asarray, find(where, projection))
        number = self.category(fuel_grid, projection)
        if "fuel_category" not in still and number is not None:
            still["fuel_category"] = lambda: number

    def say(self, text: str) -> None:
        """An assumption, said once."""
        if text not in self.assumptions:
            self.assumptions.append(text)


def find(paths: list[Path], look: bool = False) -> Land:
    """Layers among files, by LCP header or by raster and name; `look`: else of those that lie beside them."""
    land = Land({})
    for path in paths:
        land.layers |= _layers(path)
    if look and "category" not in land.layers:
        _look_beside(land, paths)
    return land


def _layers(path: Path) -> dict[str, raster.Raster]:
    """Those of a file."""
    if path.suffix.lower() == ".lcp":
        return raster.landscape(path)
    name = raster.role(path)
    return {name: _in_units(raster.read(path), name)} if name in _LAYERS and raster.is_raster(path) else {}


def _look_beside(land: Land, paths: list[Path]) -> None:
    """Add layers of files that nobody named: in the same folders, and in ELMFIRE's `inputs` beside them."""
    folders = {path.parent for path in paths} | {path.parent.parent / "inputs" for path in paths}
    there = [each for folder in sorted(folders) if folder.is_dir() for each in sorted(folder.iterdir())]
    roles: dict[str, list[Path]] = {}
    for path in there:
        role = "LCP" if path.suffix.lower() == ".lcp" else raster.role(path)
        if path not in paths and path.is_file() and (role == "LCP" or role in _LAYERS):
            roles.setdefault(role, []).append(path)
    for role, found in roles.items():
        if len(found) > 1:
            land.say(f"{len(found)} files beside it could be its {role}; name one with it to use it")
            continue
        try:
            layers = {k: v for k, v in _layers(found[0]).items() if k not in land.layers}
        except Error as error:
            land.say(f"what lies beside it is not used: {error}")
            continue
        land.layers, land.unnamed = land.layers | layers, land.unnamed | {found[0]}
        if layers:
            land.say(f"{found[0].name}, which lies beside it, says {', '.join(layers)}")


def _in_units(layer: raster.Raster, name: str) -> raster.Raster:
    """LANDFIRE and ELMFIRE write heights as whole m x 10, bulk density as whole kg/m3 x 100."""
    scale = {"height": 0.1, "base_height": 0.1, "bulk_density": 0.01}.get(name, 1.0)
    if not layer.whole or scale == 1.0:
        return layer
    values = layer.values * np.float32(scale)
    return raster.Raster(layer.path, values, layer.x, layer.y, layer.projection)
