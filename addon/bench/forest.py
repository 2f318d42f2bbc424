"""Fuel grid -> trees and grass (Algorithm 2), beside a vectorised NumPy version of the same."""

from __future__ import annotations

import numpy as np
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .geodesy import ORIGIN, numpy_enu
from .harness import OURS, Bench, threads

SIDES = (36, 144, 720, 2880)
TREES, GRASS = 363_632 / 720**2, 419_048 / 720**2  # shares of the paper's cells
Grid = tuple[NDArray, NDArray, NDArray, NDArray, NDArray]


def fuel_grid(side: int) -> Grid:
    """Canopy and surface fuel (side, side) kg/m2, latitude, longitude, elevation."""
    rng = np.random.default_rng(3)
    shape = (side, side)
    canopy = np.where(rng.random(shape) < TREES, 0.02 + rng.gamma(2, 0.6, shape), 0).astype(np.float32)
    surface = np.where(rng.random(shape) < GRASS, 0.1 + rng.random(shape), 0).astype(np.float32)
    latitude, longitude = np.linspace(38.69, 39.17, side), np.linspace(-120.85, -120.23, side)
    return canopy, surface, latitude, longitude, rng.uniform(300, 2900, shape).astype(np.float32)


def numpy_places(mask: NDArray, grid: Grid, rng: np.random.Generator) -> NDArray:
    """Jittered (n, 3) places of the cells in `mask`, heights bilinear."""
    _, _, latitude, longitude, elevation = grid
    y, x = np.nonzero(mask)
    row, column = y + rng.random(len(y)) - 0.5, x + rng.random(len(x)) - 0.5
    i = np.clip(np.floor(row).astype(int), 0, len(latitude) - 2)
    j = np.clip(np.floor(column).astype(int), 0, len(longitude) - 2)
    v, u = np.clip(row - i, 0, 1), np.clip(column - j, 0, 1)
    height = (1 - v) * ((1 - u) * elevation[i, j] + u * elevation[i, j + 1])
    height += v * ((1 - u) * elevation[i + 1, j] + u * elevation[i + 1, j + 1])
    lat = latitude[0] + row * (latitude[1] - latitude[0])
    lon = longitude[0] + column * (longitude[1] - longitude[0])
    return numpy_enu(lat, lon, height)


def numpy_forest(grid: Grid) -> int:
    """Algorithm 2 in NumPy; the number of plants."""
    canopy, surface = grid[:2]
    rng = np.random.Generator(np.random.Philox(5))
    mask = canopy > 0.01
    place, fuel = numpy_places(mask, grid, rng), canopy[mask].astype(float)
    large, medium = fuel >= 1.6, (fuel >= 0.8) & (fuel < 1.6)
    low = np.where(large, 1.1, np.where(medium, 0.9, 0.7))
    multiplier = (low + 0.3 * rng.random(len(fuel))) * (0.8 + 0.4 * rng.random(len(fuel)))
    scale = (6 + 12 * np.clip(fuel / canopy.max(), 0, 1)) * multiplier
    model = (rng.random(len(fuel)) * np.where(large, 2, 4)).astype(np.uint8)
    rotation = 2 * np.pi * rng.random(len(fuel))
    clumps = numpy_places(surface > 0, grid, rng) - [0, 0, 0.7]
    turn = 2 * np.pi * rng.random(len(clumps))
    assert len(scale) == len(model) == len(rotation)
    return len(place) + len(turn)


def our_forest(grid: Grid) -> tuple[forest.Trees, forest.Grass]:
    """The same with the core."""
    canopy, surface, *place = grid
    frame = LocalFrame(*ORIGIN)
    return forest.trees(canopy, *place, frame, seed=5), forest.grass(surface, *place, frame, seed=5)


def run(bench: Bench) -> None:
    """Grids of growing size, on one and two threads."""
    for side in SIDES:
        grid = fuel_grid(side)
        plants = sum(map(len, our_forest(grid)))
        seconds = {}
        for number in (1, 2):
            with threads(number):
                seconds[number] = bench.best(lambda: our_forest(grid), 5)  # noqa: B023
            bench.row(f"{side} x {side}", OURS, seconds[number], plants, "plant", threads=number)
        if side <= 720 or bench.full:
            rival = bench.best(lambda: numpy_forest(grid), 3)  # noqa: B023
            bench.row(f"{side} x {side}", "NumPy", rival, numpy_forest(grid), "plant")
        if side == 720:
            bench.target("one thread faster than NumPy", rival / seconds[1], 10, "x")
            bench.target("two threads faster than NumPy", rival / seconds[2], 10, "x")
            bench.target("same on 1, 2, 4, 16 threads: arrays that differ", _differences(grid), 0, "", True)


def _differences(grid: Grid) -> int:
    """How many arrays are not bit for bit those of one thread."""
    names = ("cell", "position", "scale", "rotation")
    with threads(1):
        alone = our_forest(grid)
    differ = 0
    for number in (2, 4, 16):
        with threads(number):
            shared = our_forest(grid)
        for a, b in zip(alone, shared, strict=True):
            differ += sum(not np.array_equal(getattr(a, n), getattr(b, n)) for n in names)
    return differ
