"""Fuel grid -> trees and grass (Algorithm 2), compared with vectorised NumPy that grows identical plants.

NumPy with a single stream of random numbers is faster, but there a changed cell changes every later tree; it
is measured without a target. Then a stand of ten million stems.
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
STEMS, LIMIT = 10_000_000, 5.0  # stems, and s for them on two threads
RIVALS = {"NumPy": keyed, "NumPy, one stream": one_stream}


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
        found = bench.race(f"{side} x {side}", tools, sum(map(len, mine())), "plant")
    for tool, word in ((tools[0], "one thread"), (tools[1], "two threads")):
        faster = found[tool.label].faster_than(found["NumPy"])
        bench.target(f"Planting speed / NumPy, {side} x {side} cells, {word}", faster, 10, "x")
    masked = _masked(bench, grid)
    bench.target("Time for the trees of 1 % of the cells / time for all", masked, 3, "%", most=True)
    quantity = "Arrays that differ between 1, 2, 4 and 16 threads"
    bench.target(quantity, _differences(grid), 0, "", most=True)
    _stand(bench, grid)


def _stand(bench: Bench, grid: Grid) -> None:
    call = partial(stand, grid, part(grid, STEMS), drone())
    stems, runner = len(call()[0]), Runner(OURS, call, threads=2)
    found = bench.race(f"a stand of {STEMS:,} stems", [runner], stems, "stem")
    seconds = [STEMS / speed for speed in found[runner.label].speed(stems)]
    bench.target("Time for 10 million stems, two threads", seconds, LIMIT, "s", most=True)


def _masked(bench: Bench, grid: Grid) -> list[float]:
    """Return the time for the trees of a square of 1 % of the cells, % of the time for all, repeatedly."""
    canopy, _, *place = grid
    frame = LocalFrame(*ORIGIN)
    mask = np.zeros(canopy.shape, bool)
    tenth = len(canopy) // 10
    mask[4 * tenth : 5 * tenth, 4 * tenth : 5 * tenth] = True
    plant = partial(forest.trees, canopy, *place, frame, seed=5)
    found = bench.time([Runner("all", plant), Runner("masked", partial(plant, mask=mask))])
    return [100.0 / times for times in found["masked"].faster_than(found["all"])]


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
