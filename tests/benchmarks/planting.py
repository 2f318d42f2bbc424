"""Fuel grid -> trees and grass (Algorithm 2), compared with vectorised NumPy that grows identical plants.

NumPy with a single stream of random numbers is the fast form that one would write; there a changed cell
changes every later tree. Trees that depend on their cell alone should not take longer.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin.bench.forest import Grid, fuel_grid, planted
from firetwin.bench.harness import ORIGIN, OURS, Bench
from firetwin.bench.timing import Runner, threads
from numpy_forest import Draw, Plants, grass, keyed, one_stream, trees

SIDES = (144, 720)
STREAM = "NumPy with one stream"
RIVALS = {"NumPy by cell": keyed, STREAM: one_stream}


def rival(grid: Grid, draw: Draw) -> tuple[Plants, Plants]:
    """Plant trees and grass with NumPy."""
    canopy, surface, *place = grid
    return trees(canopy, *place, ORIGIN, 5, draw), grass(surface, *place, ORIGIN, 5, draw)


def run(bench: Bench) -> None:
    """Measure two grids, on one and two threads."""
    for side in SIDES:
        grid = fuel_grid(side)
        mine = partial(planted, grid)
        tools = [Runner(OURS, mine), Runner(OURS, mine, threads=2)]
        tools += [Runner(tool, partial(rival, grid, draw)) for tool, draw in RIVALS.items()]
        times = bench.race(f"{side} x {side}", tools, sum(map(len, mine())), "plant")
    for tool, word in ((tools[0], "one thread"), (tools[1], "two threads")):
        faster = times[tool.label].faster_than(times[STREAM])
        bench.target(f"Planting speed / {STREAM}, {side} x {side} cells, {word}", faster, 1, "x")
    quantity = "Arrays that differ between 1, 2, 4 and 16 threads"
    bench.target(quantity, _differences(grid), 0, "", most=True)


def _differences(grid: Grid) -> int:
    """Count the arrays that are not bit for bit equal to the result of one thread."""
    names = ("cell", "position", "scale", "rotation")
    with threads(1):
        alone = planted(grid)
    differ = 0
    for number in (2, 4, 16):
        with threads(number):
            shared = planted(grid)
        for a, b in zip(alone, shared, strict=True):
            differ += sum(not np.array_equal(getattr(a, n), getattr(b, n)) for n in names)
    return differ
