"""Snapshot of a flow: smoke on a small box of cells, for subgrid detail."""

import numpy as np

N, SPACING, DEPTH, VOXEL = 12, 100.0, 80.0, 25.0


def moment(**changed):
    """A snapshot with smoke in the middle of a box: old, calm and cool."""
    z, y, x = np.meshgrid(*(np.arange(N) - (N - 1) / 2,) * 3, indexing="ij")
    levels = (np.arange(N) + 0.5) * DEPTH
    fields = {
        "spacing": SPACING,
        "corner": (0.0, 0.0),
        "levels": levels,
        "heights": np.broadcast_to(levels[:, None, None], (N, N, N)),
        "ground": np.zeros((N, N)),
        "smoke": 3e-6 * np.exp(-(x**2 + y**2 + z**2) / 3.0),
        "age": np.full((N, N, N), 2000.0),
        "rise": np.zeros((N, N, N)),
        "temperature_excess": np.zeros((N, N, N)),
        "drift": np.zeros((N, N, N, 2, 3)),
        "weights": (0.6, 0.8),
        "turns": (0, 0),
    }
    return fields | changed
