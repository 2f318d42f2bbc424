"""Which way the valleys run and how exposed the land is: the fields behind the channelled wind."""

import numpy as np
from numpy.typing import NDArray

from . import corridor
from .fractal import smooth
from .grid import MODEL_CELL_SIZE, block_mean
from .weather import Channel

WIDTH = 900.0  # m, half width of a canyon
RUN_WIDTH = 1800.0  # m, half width of the way of the run
DEPTH = 350.0  # m below the surroundings where a valley fully steers the wind


def channel(elevation: NDArray) -> Channel:
    """Valley axes on the model grid, from the structure tensor of smoothed terrain (Kass & Witkin 1987).

    Parameters
    ----------
    elevation
        (fy, fx) metres on the fuel grid.
    """
    coarse = block_mean(elevation)
    near = smooth(coarse, WIDTH / 2 / MODEL_CELL_SIZE)
    north, east = np.gradient(near, MODEL_CELL_SIZE)
    spread = 2 * WIDTH / MODEL_CELL_SIZE
    ee, en, nn = (smooth(product, spread) for product in (east * east, east * north, north * north))
    across = 0.5 * np.arctan2(2 * en, ee - nn)  # direction of the steepest change; valleys run square to it
    strength = np.hypot(ee - nn, 2 * en) / np.maximum(ee + nn, 1e-9)
    below = smooth(coarse, 3000 / MODEL_CELL_SIZE) - near
    along = np.clip(below / DEPTH, 0, 1) * strength
    exposure = np.clip(1 - 0.0012 * below, 0.7, 1.3)
    east, north = -np.sin(across), np.cos(across)
    run = block_mean(corridor.nearness(elevation.shape, RUN_WIDTH))
    run_east, run_north = (block_mean(part) for part in corridor.direction(elevation.shape))
    facing = np.where(east * run_east + north * run_north < 0, -1, 1)  # an axis has no sense: make them agree
    east = facing * east * (1 - run) + run_east * run
    north = facing * north * (1 - run) + run_north * run
    length = np.hypot(east, north)
    return Channel(east / length, north / length, np.maximum(along, run), np.maximum(exposure, 1.2 * run))
