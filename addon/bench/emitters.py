"""Heat flux at one time -> emitters (Algorithm 1), their distance levels and the nearest, against NumPy."""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin_core import flux, lod
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .harness import ORIGIN, OURS, Bench
from .timing import Runner

SIDES = (144, 720)
BUDGET = 1000
CAMERA = np.array([[500.0, -2000.0, 3000.0]])
HIGHEST = 1e5  # W/m2


def burning(side: int) -> tuple[NDArray, NDArray]:
    """Make a broad ring of fire: flux (side, side) W/m2 and positions (side, side, 3) m."""
    rng = np.random.default_rng(4)
    y, x = np.mgrid[:side, :side] / side - 0.5
    flux = np.where(np.abs(np.hypot(y, x) - 0.3) < 0.05, rng.lognormal(9, 1, (side, side)), 0)
    latitude, longitude = np.linspace(38.69, 39.17, side), np.linspace(-120.85, -120.23, side)
    position = LocalFrame(*ORIGIN).forward_grid(latitude, longitude, rng.uniform(300, 2900, (side, side)))
    return flux.astype(np.float32), position


def ours(field: NDArray, position: NDArray) -> tuple[NDArray, NDArray]:
    """Return the indices of the nearest emitters and their levels, by the core."""
    made = flux.emitters(field, position, 0.0, HIGHEST)
    chosen = lod.select_nearest(made.position, CAMERA, BUDGET)
    return made.cell[chosen], lod.levels(np.linalg.norm(made.position[chosen] - CAMERA[0], axis=1))


def with_numpy(field: NDArray, position: NDArray) -> tuple[NDArray, NDArray]:
    """Return the indices of the nearest emitters and their levels, by NumPy."""
    cell = np.flatnonzero(field > 0)
    place = position.reshape(-1, 3)[cell]
    curved = np.clip(field.ravel()[cell].astype(float) / HIGHEST, 0, 1) ** 1.5
    scale, colour = 100 + 50 * curved, 100 + 400 * curved
    assert len(scale) == len(colour)
    distance = np.linalg.norm(place - CAMERA[0], axis=1)
    chosen = np.argsort(distance, kind="stable")[:BUDGET]
    return cell[chosen], np.digitize(distance[chosen], (1500.0, 3500.0), right=True)


def run(bench: Bench) -> None:
    """Measure on the model grid and on the fuel grid."""
    for side in SIDES:
        field, position = burning(side)
        if not all(map(np.array_equal, ours(field, position), with_numpy(field, position))):
            bench.target("Differences from NumPy's emitters", 1, 0, "", most=True)
        mine = partial(ours, field, position)
        tools = [
            Runner(OURS, mine),
            Runner(OURS, mine, threads=2),
            Runner("NumPy", partial(with_numpy, field, position)),
        ]
        times = bench.race(f"{side} x {side}", tools, side * side, "cell")
        if side == 144:
            milliseconds = [1e3 * seconds for seconds in times[OURS].seconds]
            bench.target(
                "Time for emitters, distance levels and the nearest 1,000, 144 x 144 cells",
                milliseconds,
                1,
                "ms",
                most=True,
            )
