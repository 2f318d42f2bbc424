"""Fuel grid -> trees and grass (Algorithm 2), beside vectorised NumPy that grows the very same plants.

NumPy's own stream of random numbers is quicker, but with it
a changed cell changes every tree after it; it is shown without a bound.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .geodesy import ORIGIN
from .harness import OURS, Bench
from .numpy_forest import Draw, Plants, grass, keyed, one_stream, trees
from .timing import Runner, threads

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
        mine = partial(our_forest, grid)
        tools = [Runner(OURS, mine), Runner(OURS, mine, threads=2)]
        if side <= 720 or bench.full:
            tools += [Runner(tool, partial(rival, grid, draw)) for tool, draw in RIVALS.items()]
        found = bench.race(f"{side} x {side}", tools, plants, "plant")
        if side == 720:
            for tool, word in ((tools[0], "one thread"), (tools[1], "two threads")):
                faster = found[tool.label].faster_than(found["NumPy"])
                bench.target(f"speed of planting 720 x 720 cells on {word}, over NumPy's", faster, 10, "x")
            bench.target(
                "time for the trees of 1 % of the cells, of that for all",
                _masked(bench, grid),
                3,
                "%",
                most=True,
            )
            differ = _differences(grid)
            bench.target("arrays that differ between 1, 2, 4 and 16 threads", differ, 0, "", most=True)


def _masked(bench: Bench, grid: Grid) -> list[float]:
    """Time for the trees of a square of 1 % of the cells over that for all, %, of each repetition."""
    canopy, _, *place = grid
    frame = LocalFrame(*ORIGIN)
    mask = np.zeros(canopy.shape, bool)
    tenth = len(canopy) // 10
    mask[4 * tenth : 5 * tenth, 4 * tenth : 5 * tenth] = True
    plant = partial(forest.trees, canopy, *place, frame, seed=5)
    found = bench.time([Runner("all", plant), Runner("masked", partial(plant, mask=mask))])
    return [100.0 / times for times in found["masked"].faster_than(found["all"])]


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
