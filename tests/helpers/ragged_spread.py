"""Arrival times of a fire with a ragged front: fuel and gusts vary, slopes matter, islands stay unburned.

The front is the minimum of all travel times over a grid. A step between two cells takes the time of the
elliptical spread in wind, times the mean slowness of both cells and the effect of the slope between them.
The numbers of `BANDS`, `ISLANDS` and `FINGER` are chosen by eye.
"""

from collections.abc import Callable

import numpy as np

BANDS = ((4000.0, 0.3), (1000.0, 0.45), (300.0, 0.55), (120.0, 0.45), (50.0, 0.4), (20.0, 0.3))
"""Wavelength (m) and standard deviation of the logarithm of the rate of spread, of each band of noise.
Bands wider than the grid or narrower than two cells have no effect."""
FINGER = 3.0
"""Length of patterns along the wind over their width."""
ISLANDS = ((250.0, 1.0), (80.0, 0.5), (30.0, 0.25))
"""Wavelength (m) and weight of each band of noise that places islands, at least an eighth of the grid's side
for the widest."""
UNBURNED = 0.03
"""Share of the area on islands."""
SLOPE = 0.069
"""Growth of the logarithm of the rate of spread per degree of slope (Noble et al. 1980, after McArthur)."""
STEEPEST = 10.0
"""Slopes count up to this many degrees, up and down (assumed)."""


def arrival(
    x: np.ndarray,
    y: np.ndarray,
    height: np.ndarray,
    fires: tuple,
    travel: Callable[[np.ndarray, np.ndarray], np.ndarray],
    along: tuple[float, float],
    seed: int,
) -> np.ndarray:
    """Solve the arrival times of ragged fires.

    Parameters
    ----------
    x, y, height
        Metres east, north and up, (n, n), on a square grid.
    fires
        Ignitions: metres east and north, and time, s.
    travel
        Seconds of the undisturbed spread over metres east and north.
    along
        Direction of the wind, any length; zero: none.

    Returns
    -------
    np.ndarray
        Seconds, (n, n); infinite on islands. As much area has burned after the undisturbed fire's median
        arrival as without raggedness.
    """
    even = np.min([when + travel(x - east, y - north) for east, north, when in fires], axis=0)
    chance, cell = np.random.default_rng(seed), x[0, 1] - x[0, 0]
    fits = [band for band in BANDS if 2.0 * cell <= band[0] <= len(x) * cell]
    slowness = np.exp(-sum(sigma * noise(x.shape, cell, size, along, chance) for size, sigma in fits))
    scale = max(1.0, len(x) * cell / 8.0 / ISLANDS[0][0])
    patches = sum(part * noise(x.shape, cell, scale * size, along, chance) for size, part in ISLANDS)
    started = np.min([np.hypot(x - east, y - north) for east, north, _ in fires], axis=0)
    island = (patches > np.quantile(patches, 1.0 - UNBURNED)) & (started > 6.0 * cell)
    slowness[island] = np.inf
    came = np.full(x.shape, np.inf)
    for east, north, when in fires:
        nearest = np.unravel_index(np.argmin(np.hypot(x - east, y - north)), x.shape)
        came[nearest] = min(came[nearest], when)
    came = _relax(came, slowness, height, cell, travel)
    first, median = even.min(), np.median(even)
    return first + (came - first) * (median - first) / (np.median(came) - first)


def noise(shape: tuple, cell: float, size: float, along: tuple, chance: np.random.Generator) -> np.ndarray:
    """Make Gaussian noise of one wavelength (m), stretched along the wind: mean 0, deviation 1."""
    north, east = np.meshgrid(*(np.fft.fftfreq(n, cell) for n in shape), indexing="ij")
    strength = np.hypot(*along)
    if strength > 0.0:
        ahead = (east * along[0] + north * along[1]) / strength
        across = (north * along[0] - east * along[1]) / strength
        east, north = ahead * np.sqrt(FINGER), across / np.sqrt(FINGER)
    band = np.exp(-((size * np.hypot(east, north)) ** 2))
    band[0, 0] = 0.0
    made = np.fft.ifft2(band * np.fft.fft2(chance.standard_normal(shape))).real
    return made / made.std()


def _relax(
    came: np.ndarray, slowness: np.ndarray, height: np.ndarray, cell: float, travel: Callable
) -> np.ndarray:
    """Lower arrival times by steps to 32 directions until none gets earlier."""
    reach = range(-3, 4)
    steps = [(i, j) for i in reach for j in reach if np.gcd(i, j) == 1]
    times = [_step_time(slowness, height, cell, travel, *step) for step in steps]
    while True:
        before = came.copy()
        for (i, j), time in zip(steps, times, strict=True):
            to, source = _shifted(came, i, j)
            np.minimum(to, source + time, out=to)
        if np.array_equal(before, came):
            return came


def _shifted(field: np.ndarray, i: int, j: int) -> tuple[np.ndarray, np.ndarray]:
    """Views of the cells that a step of i rows and j columns reaches, and of the cells it leaves."""
    rows, columns = field.shape
    to = field[max(i, 0) : rows + min(i, 0), max(j, 0) : columns + min(j, 0)]
    source = field[max(-i, 0) : rows + min(-i, 0), max(-j, 0) : columns + min(-j, 0)]
    return to, source


def _step_time(
    slowness: np.ndarray, height: np.ndarray, cell: float, travel: Callable, i: int, j: int
) -> np.ndarray:
    """Seconds of a step of i rows and j columns to each cell that it reaches."""
    to, source = _shifted(slowness, i, j)
    above, below = _shifted(height, i, j)
    slope = np.degrees(np.arctan((above - below) / (cell * np.hypot(i, j))))
    return (
        travel(j * cell, i * cell)
        * 0.5
        * (to + source)
        * np.exp(-SLOPE * np.clip(slope, -STEEPEST, STEEPEST))
    )
