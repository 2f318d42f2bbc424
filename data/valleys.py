"""Which way the valleys run and how exposed the land is: the fields behind the channelled wind."""

import numpy as np
from numpy.typing import NDArray

from .grid import MODEL_CELL_SIZE, block_mean
from .noise import smooth
from .weather import Channel

WIDTH = 900.0  # m, half width of a canyon
DEPTH = 350.0  # m below the surroundings where a valley fully steers the wind


def channel(elevation: NDArray, seed_scale: float = WIDTH) -> Channel:
    """Valley axes from the structure tensor of the smoothed terrain (Kass & Witkin 1987), fuel grid -> model grid.

    Parameters
    ----------
    elevation
        (fy, fx) metres on the fuel grid.
    seed_scale
        Smoothing length in metres before slopes are taken.
    """
    coarse = block_mean(elevation)
    near = smooth(coarse, seed_scale / 2 / MODEL_CELL_SIZE)
    north, east = np.gradient(near, MODEL_CELL_SIZE)
    spread = 2 * seed_scale / MODEL_CELL_SIZE
    ee, en, nn = (smooth(product, spread) for product in (east * east, east * north, north * north))
    across = 0.5 * np.arctan2(2 * en, ee - nn)  # direction of the steepest change; valleys run square to it
    strength = np.hypot(ee - nn, 2 * en) / np.maximum(ee + nn, 1e-9)
    below = smooth(coarse, 3000 / MODEL_CELL_SIZE) - near
    along = np.clip(below / DEPTH, 0, 1) * strength
    exposure = np.clip(1 - 0.0012 * below, 0.7, 1.3)
    return Channel(-np.sin(across), np.cos(across), along, exposure)
