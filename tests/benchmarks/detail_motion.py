"""Does the detail below a flow's cells move as its air does? Without Blender, in seconds.

    python tests/benchmarks/detail_motion.py [--seconds 4] [--json]

A steady fire in a wind that grows with height, on cells as small as a shot's nest; its smoke is painted as a
shot's is and drawn from the side, each voxel as bright as the light from above that reaches it, every second
for as long as a phase of the noise begins anew in. Optical flow between pictures (`optical`) is held against
the solver's wind as the camera sees it (`lines_of_sight`). Prints the median way, the median difference in
pixels and in per cent of that way, the share of the flow's way that pictures go, and pops: the largest change
from frame to frame over the median one.
"""

from __future__ import annotations

import argparse
import itertools
import json
from pathlib import Path

import numpy as np
from firetwin.smoke.domains import Box, Domain
from firetwin_core import flow
from lines_of_sight import STEP, Grid, SolvedWind, expected, rays
from numpy.typing import NDArray
from optical import displacement

SPACING, SHAPE, LEVELS, DEPTH = 66.7, (48, 96), 40, 55.0  # m, rows and columns, levels of so many m
VOXEL = 28.0  # m
POWER = 6e9  # W
FRAMES, EVERY = 24, 4  # s of film; s from one comparison to the next
RESOLUTION, FIELD, DISTANCE = (200, 110), 0.36, 5000.0  # px, tangent of half the width, m to the plume
PATCH, OPAQUE = 20, 0.7  # px, share of the light that smoke stops in a patch's middle

Array = NDArray[np.float64]


class Camera:
    """Looks north at the plume from the side."""

    position = np.array([[2450.0, 0.5 * SHAPE[0] * SPACING - DISTANCE, 780.0]])
    rotation = np.array([[[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]])
    half = (FIELD, FIELD * RESOLUTION[1] / RESOLUTION[0])


def begin() -> tuple[flow.Solver, flow.Drift]:
    """The fire after six minutes, its detail carried for four."""
    levels = np.arange(LEVELS + 1) * DEPTH
    high = levels[-1]
    profile = flow.Profile([0.0, high], [300.0, 300.0 + 0.004 * high], [[5.0, 0.0], [12.0, 0.0]])
    settings = flow.SolverSettings(gust_strength=0.9, gust_size=180.0, gust_time=45.0)
    solver = flow.Solver(flow.Domain(levels, SHAPE, SPACING), profile, settings)
    place = np.array([0.2 * SHAPE[1], 0.5 * SHAPE[0]]) * SPACING
    place = place + np.random.default_rng(1).uniform(-150, 150, (40, 2))
    solver.set_sources(place, np.full(40, POWER / 40), np.full(40, 1.2e-9 * POWER / 40))
    solver.step(3.0, 40)
    drift = flow.Drift(solver)
    for _ in range(80):
        solver.step(3.0)
        drift.advance()
    return solver, drift


def painted(solver: flow.Solver, drift: flow.Drift) -> Grid:
    """Extinction of the smoke now, with its detail, 1/m."""
    middle = 0.5 * (solver.levels[1:] + solver.levels[:-1])
    even = np.zeros(SHAPE)
    moved = drift.values()
    for axis, count in enumerate(solver.shape):
        moved = _doubled(moved, axis, count)
    detail = flow.Detail(
        spacing=SPACING,
        corner=(0.0, 0.0),
        levels=middle,
        heights=np.broadcast_to(middle[:, None, None], solver.shape),
        ground=even,
        smoke=solver.smoke(),
        age=solver.age(),
        rise=solver.velocity()[..., 2],
        temperature_excess=solver.temperature_excess(),
        drift=moved,
        weights=tuple(drift.weights),
        turns=tuple(drift.turns),
        blur=(3.5, 2.5, 2.5),
    )
    columns, rows, layers = (int(side / VOXEL) for side in (SHAPE[1] * SPACING, SHAPE[0] * SPACING, 2000.0))
    flat = np.zeros((columns, rows))
    extinction, _, _ = detail.paint((0.0, 0.0, 0.0), VOXEL, flat, flat + 1.0, layers)
    return Grid(np.asarray(extinction), np.zeros(3), VOXEL)


def drawn(smoke: Grid) -> Array:
    """A picture (rows, columns) of smoke that is lit from above, 0 to 1, before black."""
    above = np.cumsum(smoke.values[:, :, ::-1], axis=2)[:, :, ::-1] * smoke.step
    light = Grid(np.exp(-0.15 * above).astype(np.float32), smoke.low, smoke.step)
    width, height = RESOLUTION
    pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).reshape(-1, 2).astype(float)
    direction = rays(Camera, pixels, RESOLUTION)
    through, found = np.ones(len(pixels)), np.zeros(len(pixels))
    for distance in np.arange(DISTANCE - 0.6 * SHAPE[0] * SPACING, DISTANCE + 0.6 * SHAPE[0] * SPACING, STEP):
        place = Camera.position[0] + distance * direction
        stopped = through * -np.expm1(-STEP * smoke.at(place).astype(float))
        through -= stopped
        found += stopped * light.at(place)
    return found.reshape(height, width)


def measured(seconds: int) -> dict[str, float]:
    """All numbers."""
    solver, drift = begin()
    levels = tuple(float(level) for level in solver.levels)
    part = Domain(Box(levels, SHAPE, SPACING, (0.0, 0.0)), np.zeros(SHAPE), 0.0, levels[-1], Path())
    half = PATCH // 2
    centre = np.stack(np.meshgrid(*[np.arange(half, side - half, 8) for side in RESOLUTION]), -1).reshape(
        -1, 2
    )
    pictures, ways = [], {}
    for frame in range(FRAMES):
        smoke = painted(solver, drift)
        pictures.append(drawn(smoke))
        if frame % EVERY == 0:
            wind = SolvedWind(part, solver.velocity())
            ways[frame] = expected(Camera, [smoke], wind, centre.astype(float), RESOLUTION, seconds)
        solver.step(1.0)
        drift.advance()
    seen, flown = [], []
    for frame, (way, light) in ways.items():
        if frame + seconds < FRAMES:
            smoky = light > OPAQUE
            shift, trusted = displacement(pictures[frame], pictures[frame + seconds], centre[smoky], PATCH)
            seen.append(shift[trusted])
            flown.append(way[smoky][trusted])
    change = [float(np.abs(b - a).mean()) for a, b in itertools.pairwise(pictures)]
    return agreement(np.concatenate(seen), np.concatenate(flown)) | {
        "largest_change_over_median": max(change) / float(np.median(change)),
    }


def agreement(seen: Array, flown: Array) -> dict[str, float]:
    """How well ways (n, 2) px in pictures and in the flow agree."""
    off, long = np.linalg.norm(seen - flown, axis=1), np.linalg.norm(flown, axis=1)
    return {
        "patches": float(len(off)),
        "median_way_px": float(np.median(long)),
        "median_error_px": float(np.median(off)),
        "median_error_percent": 100.0 * float(np.median(off) / np.median(long)),
        "way_over_flow": float(np.sum(seen * flown) / np.sum(flown * flown)),
    }


def _doubled(values: NDArray[np.float32], axis: int, count: int) -> NDArray[np.float32]:
    """Values of every other one of `count` places, at all of them; linear between."""
    values = np.moveaxis(values, axis, 0)
    found = np.repeat(values, 2, 0)
    found[1:-1:2] = 0.5 * (values[:-1] + values[1:])
    return np.moveaxis(found[:count], 0, axis)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=int, default=4)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    result = measured(given.seconds)
    if given.json:
        print(json.dumps(result))
        return
    for name, value in result.items():
        print(f"{name:28} {value:10.4g}")


if __name__ == "__main__":
    main()
