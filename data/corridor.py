"""The way of the fire's run of 17 September 2014: over the Georgetown Divide and up the Rubicon canyon.

That run made its own wind, which neither the schedule of weather.py nor a spread model of the ground knows.
Along this way the sample's wind is turned and quickened, and the simulated fire spreads faster.
"""

import numpy as np
from numpy.typing import NDArray

from .fractal import fractal, smooth
from .grid import FUEL_CELL_SIZE, cell_of

# From the head of that morning to Hell Hole Reservoir: latitude, longitude.
WAY = (
    (38.800, -120.585), (38.850, -120.580), (38.890, -120.570), (38.930, -120.562), (38.962, -120.543),
    (38.985, -120.505), (39.015, -120.462), (39.050, -120.420), (39.075, -120.375),
)  # fmt: skip


def nearness(shape: tuple[int, int], width: float, seed: int = 31) -> NDArray[np.float64]:
    """1 on the way, exp(-(d / width)^2) at d metres from it, on the fuel grid; its edges wander."""
    distance, _, _ = _nearest(shape)
    wander = np.exp(0.3 * fractal(shape, seed, 80, 8, 1.2))
    return np.exp(-((distance * FUEL_CELL_SIZE / (width * wander)) ** 2))


def direction(shape: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """East and north parts of the unit vector along the nearest stretch of the way, bends rounded."""
    _, east, north = _nearest(shape)
    east, north = smooth(east, 12), smooth(north, 12)
    length = np.hypot(east, north)
    return east / length, north / length


def _nearest(shape: tuple[int, int]) -> tuple[NDArray, NDArray, NDArray]:
    """Distance in cells of every cell from the way, and the direction of the nearest stretch."""
    row, column = (array.astype(float) for array in cell_of(*np.array(WAY).T))
    y, x = np.indices(shape)
    distance = np.full(shape, np.inf)
    east, north = np.zeros(shape), np.zeros(shape)
    for i in range(len(row) - 1):
        dy, dx = row[i + 1] - row[i], column[i + 1] - column[i]
        length = np.hypot(dy, dx)
        t = np.clip(((y - row[i]) * dy + (x - column[i]) * dx) / length**2, 0, 1)
        here = np.hypot(y - row[i] - t * dy, x - column[i] - t * dx)
        closer = here < distance
        distance[closer] = here[closer]
        east[closer], north[closer] = dx / length, dy / length
    return distance, east, north
