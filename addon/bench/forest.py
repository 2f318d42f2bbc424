"""Fuel grid -> trees and grass (Algorithm 2), beside vectorised NumPy.

The rival that counts grows the very same plants. NumPy's own stream of random numbers is quicker, but with it
a changed cell changes every tree after it; it is shown without a bound.
"""

from __future__ import annotations

import numpy as np
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .geodesy import ORIGIN
from .harness import OURS, Bench, threads
from .numpy_forest import Draw, Plants, grass, keyed, one_stream, trees

SIDES = (36, 144, 720, 2880)
TREES, GRASS = 363_632 / 720**2, 419_048 / 720**2  # shares of the paper's cells
RIVALS = {"NumPy": keyed, "NumPy, one stream": one_stream}
Grid = tuple[NDArray, NDArray, NDArray, NDArray, NDArray]


def fuel_grid(side: int) -> Grid:
    """Canopy and surface fuel (side, side) kg/m2, latitude, longitude, elevation."""
    rng = np.random.default_rng(3)
    shape = (side, side)
    canopy = np.where(rng.random(shape) < TREES, 0.02 + rng.gamma(2, 0.6, shape), 0).astype(np.float32)
    surface = np.where(rng.random(shape) < GRASS, 0.1 + rng.random(shape), 0).astype(np.float32)
    latitude, longitude = np.linspace(38.69, 39.17, side), np.linspace(-120.85, -120.23, side)
    return canopy, surface, latitude, longitude, rng.uniform(300, 2900, shape).astype(np.float32)


def rival(grid: Grid, draw: Draw) -> tuple[Plants, Plants]:
    """Trees and grass in NumPy."""
    canopy, surface, *place = grid
    return trees(canopy, *place, ORIGIN, 5, draw), grass(surface, *place, ORIGIN, 5, draw)


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
        seconds: dict[int | str, float] = {}
        for number in (1, 2):
            with threads(number):
                seconds[number] = bench.best(lambda: our_forest(grid), 5)  # noqa: B023
            bench.row(f"{side} x {side}", OURS, seconds[number], plants, "plant", threads=number)
        if side <= 720 or bench.full:
            for tool, draw in RIVALS.items():
                seconds[tool] = bench.best(lambda: rival(grid, draw), 3)  # noqa: B023
                bench.row(f"{side} x {side}", tool, seconds[tool], plants, "plant")
        if side == 720:
            for number, word in ((1, "one thread"), (2, "two threads")):
                bench.target(f"{word} faster than NumPy", seconds["NumPy"] / seconds[number], 10, "x")
            bench.target("mask of 1 % costs, of the whole", 100.0 * _masked(bench, grid), 3, "%", True)
            bench.target("same on 1, 2, 4, 16 threads: arrays that differ", _differences(grid), 0, "", True)


def _masked(bench: Bench, grid: Grid) -> float:
    """Time for the trees of a square of 1 % of the cells over that for all, on one thread, by turns."""
    canopy, _, *place = grid
    frame = LocalFrame(*ORIGIN)
    mask = np.zeros(canopy.shape, bool)
    tenth = len(canopy) // 10
    mask[4 * tenth : 5 * tenth, 4 * tenth : 5 * tenth] = True
    with threads(1):
        times = [
            [bench.best(lambda: forest.trees(canopy, *place, frame, seed=5, mask=m), 3) for m in (mask, None)]  # noqa: B023
            for _ in range(5)
        ]
    part, whole = np.median(times, axis=0)
    return float(part / whole)


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
