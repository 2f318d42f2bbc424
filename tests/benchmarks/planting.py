"""Fuel grid -> trees and grass (Algorithm 2), beside vectorised NumPy that grows the very same plants.

NumPy's own stream of random numbers is quicker, but with it a changed cell changes every tree after it; it is
shown without a bound. Then a stand of ten million stems.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin.bench.forest import Grid, drone, fuel_grid, part, planted, stand
from firetwin.bench.harness import ORIGIN, OURS, Bench
from firetwin.bench.timing import Runner, threads
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from numpy_forest import Draw, Plants, grass, keyed, one_stream, trees

SIDES = (144, 720)
STEMS, LIMIT = 10_000_000, 5.0  # s for so many on two threads
RIVALS = {"NumPy": keyed, "NumPy, one stream": one_stream}


def rival(grid: Grid, draw: Draw) -> tuple[Plants, Plants]:
    """Trees and grass in NumPy."""
    canopy, surface, *place = grid
    return trees(canopy, *place, ORIGIN, 5, draw), grass(surface, *place, ORIGIN, 5, draw)


def run(bench: Bench) -> None:
    """Two grids, on one and two threads."""
    for side in SIDES:
        grid = fuel_grid(side)
        mine = partial(planted, grid)
        tools = [Runner(OURS, mine), Runner(OURS, mine, threads=2)]
        tools += [Runner(tool, partial(rival, grid, draw)) for tool, draw in RIVALS.items()]
        found = bench.race(f"{side} x {side}", tools, sum(map(len, mine())), "plant")
    for tool, word in ((tools[0], "one thread"), (tools[1], "two threads")):
        faster = found[tool.label].faster_than(found["NumPy"])
        bench.target(f"speed of planting {side} x {side} cells on {word}, over NumPy's", faster, 10, "x")
    masked = _masked(bench, grid)
    bench.target("time for the trees of 1 % of the cells, of that for all", masked, 3, "%", most=True)
    promise = "arrays that differ between 1, 2, 4 and 16 threads"
    bench.target(promise, _differences(grid), 0, "", most=True)
    _stand(bench, grid)


def _stand(bench: Bench, grid: Grid) -> None:
    call = partial(stand, grid, part(grid, STEMS), drone())
    stems, runner = len(call()[0]), Runner(OURS, call, threads=2)
    found = bench.race(f"a stand of {STEMS:,} stems", [runner], stems, "stem")
    seconds = [STEMS / speed for speed in found[runner.label].speed(stems)]
    bench.target("time for 10 million stems on two threads", seconds, LIMIT, "s", most=True)


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
        alone = planted(grid)
    differ = 0
    for number in (2, 4, 16):
        with threads(number):
            shared = planted(grid)
        for a, b in zip(alone, shared, strict=True):
            differ += sum(not np.array_equal(getattr(a, n), getattr(b, n)) for n in names)
    return differ
