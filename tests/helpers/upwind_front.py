"""Arrival times of a front over uneven ground, as a level set method computes them."""

import numpy as np


def arrival(slowness: np.ndarray, cell: float, spots: int = 0, seed: int = 7) -> np.ndarray:
    """Solve the first-order upwind eikonal equation (Rouy and Tourin 1992) from the middle of a square grid.

    Spot fires begin at 0.4 to 0.9 of the time at which the front would arrive, and merge with it.

    Parameters
    ----------
    slowness
        (n, n) s/m.
    cell
        Side of a cell, m.
    spots
        Number of spot fires, at random places.
    """
    start = np.full(slowness.shape, np.inf)
    start[slowness.shape[0] // 2, slowness.shape[1] // 2] = 0.0
    came = _solve(slowness * cell, start)
    if spots == 0:
        return came
    chance = np.random.default_rng(seed)
    place = tuple(chance.integers(0, slowness.shape[0], (2, spots)))
    start[place] = np.minimum(came[place] * chance.uniform(0.4, 0.9, spots), start[place])
    return _solve(slowness * cell, start)


def _solve(step: np.ndarray, came: np.ndarray) -> np.ndarray:
    """Iterate to arrival times (s); `came` has those of ignitions, and `step` the time to cross a cell."""
    start = came
    while True:
        padded = np.pad(came, 1, constant_values=np.inf)
        x = np.minimum(padded[1:-1, :-2], padded[1:-1, 2:])
        y = np.minimum(padded[:-2, 1:-1], padded[2:, 1:-1])
        with np.errstate(invalid="ignore"):
            both = 0.5 * (x + y + np.sqrt(2.0 * step**2 - (x - y) ** 2))
            found = np.where(np.abs(x - y) < step, both, np.minimum(x, y) + step)
        found = np.minimum(found, start)
        if np.array_equal(found, came):
            return came
        came = found
