"""Fuel grid -> stands of up to 10 million stems: scattered, culled by what a drone sees, and levelled."""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin_core import forest, lod
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .forest import Grid, fuel_grid
from .geodesy import ORIGIN
from .harness import OURS, Bench
from .timing import Runner

SIDE = 720
STEMS = (100_000, 1_000_000, 10_000_000)
CELL = 74.0**2  # m2
FRAMES = 48
LIMIT = 5.0  # s for 10 million on two threads


def drone() -> lod.Sight:
    """What a drone sees that flies 5 km and looks down a little, ahead."""
    camera = np.column_stack([np.linspace(0.0, 5000.0, FRAMES), np.zeros(FRAMES), np.full(FRAMES, 3500.0)])
    down = np.radians(17.0)
    right, up = (0.0, -1.0, 0.0), (np.sin(down), 0.0, np.cos(down))
    back = (-np.cos(down), 0.0, np.sin(down))
    rotation = np.broadcast_to(np.column_stack([right, up, back]), (FRAMES, 3, 3))
    return lod.Sight(camera, rotation, np.tile([0.64, 0.36], (FRAMES, 1)))


def part(grid: Grid, stems: int) -> NDArray[np.float32]:
    """What part of the stems of each cell (fy, fx) to keep for so many in all."""
    return np.full(grid[0].shape, stems / (forest.stems(grid[0]).sum() * CELL), np.float32)


def levelled(grid: Grid, kept: NDArray, sight: lod.Sight) -> tuple[forest.Stems, NDArray]:
    """The stems, and the level of each that is seen."""
    canopy, _, *place = grid
    stems = forest.stand(canopy, *place, LocalFrame(*ORIGIN), seed=5, kept=kept)
    seen = lod.seen(stems.position, 0.6 * stems.scale, sight)
    return stems, lod.levels(lod.distance(stems.position[seen], sight))


def run(bench: Bench) -> None:
    """The same domain with more and more of its stems, on one and two threads."""
    grid, sight = fuel_grid(SIDE), drone()
    for wanted in STEMS if bench.full else STEMS[::2]:
        kept = part(grid, wanted)
        stems = len(levelled(grid, kept, sight)[0])
        call = partial(levelled, grid, kept, sight)
        found = bench.race(f"{wanted:,}", [Runner(OURS, call), Runner(OURS, call, threads=2)], stems, "stem")
    ours = found[Runner(OURS, call, threads=2).label]
    seconds = [STEMS[-1] / speed for speed in ours.speed(stems)]
    bench.target("time for 10 million stems on two threads", seconds, LIMIT, "s", most=True)
