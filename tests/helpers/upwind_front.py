"""Arrival times of a front over uneven ground, as a level set method computes them."""

import numpy as np


def arrival(slowness: np.ndarray, cell: float) -> np.ndarray:
    """Solve the first-order upwind eikonal equation (Rouy and Tourin 1992) from the middle of a square grid.

    Parameters
    ----------
    slowness
        (n, n) s/m.
    cell
        Side of a cell, m.
    """
    step, came = slowness * cell, np.full(slowness.shape, np.inf)
    start = slowness.shape[0] // 2, slowness.shape[1] // 2
    while True:
        padded = np.pad(came, 1, constant_values=np.inf)
        x = np.minimum(padded[1:-1, :-2], padded[1:-1, 2:])
        y = np.minimum(padded[:-2, 1:-1], padded[2:, 1:-1])
        with np.errstate(invalid="ignore"):
            both = 0.5 * (x + y + np.sqrt(2.0 * step**2 - (x - y) ** 2))
            found = np.where(np.abs(x - y) < step, both, np.minimum(x, y) + step)
        found[start] = 0.0
        if np.array_equal(found, came):
            return came
        came = found
