"""Reference implementations (oracles) of Algorithms 1 and 2 of the FIRETWIN paper, plain and slow.

They do not use firetwin_core. Positions are latitude, longitude and height; `geodesy.enu` converts them to
local metres.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MASK = (1 << 64) - 1
PLACE, TREE, GRASS = 0, 1, 2
SMALL, MEDIUM, LARGE = 0, 1, 2


def algorithm1(flux: NDArray, flux_min: float, flux_max: float) -> list[tuple[int, float, float, float]]:
    """Algorithm 1 -> (cell, F_curved, scale, colour) of each cell with flux > 0, in order."""
    result = []
    rows, columns = flux.shape
    for y in range(rows):
        for x in range(columns):
            value = float(flux[y, x])
            if not value > 0:
                continue
            normalised = min(max((value - flux_min) / (flux_max - flux_min), 0.0), 1.0)
            curved = normalised**1.5
            scale = 100 + (150 - 100) * curved
            colour = 100 + (500 - 100) * curved
            result.append((y * columns + x, curved, scale, colour))
    return result


def philox(counter: tuple[int, int, int, int], key: tuple[int, int]) -> tuple[int, int, int, int]:
    """Philox4x64-10 (Salmon et al. 2011) in Python's integers."""
    c0, c1, c2, c3 = counter
    k0, k1 = key
    for _ in range(10):
        a, b = 0xD2E7470EE14C6C93 * c0, 0xCA5A826395121157 * c2
        c0, c1, c2, c3 = (b >> 64) ^ c1 ^ k0, b & MASK, (a >> 64) ^ c3 ^ k1, a & MASK
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) & MASK, (k1 + 0xBB67AE8584CAA73B) & MASK
    return c0, c1, c2, c3


def _multiply(a: int, b: NDArray) -> tuple[NDArray, NDArray]:
    """Upper and lower 64 bits of a 64 x 64 bit product, by long multiplication."""
    half = np.uint64(32)
    low_mask = np.uint64(0xFFFFFFFF)
    a_high, a_low = np.uint64(a >> 32), np.uint64(a & 0xFFFFFFFF)
    b_high, b_low = b >> half, b & low_mask
    low_low, high_low, low_high = a_low * b_low, a_high * b_low, a_low * b_high
    middle = (low_low >> half) + (high_low & low_mask) + low_high
    return a_high * b_high + (high_low >> half) + (middle >> half), np.uint64(a) * b


def uniform(seed: int, cells: NDArray, use: int) -> NDArray:
    """Four uniform numbers in [0, 1) per cell -> (n, 4): the same Philox over all cells at once."""
    c0 = cells.astype(np.uint64)
    c1, c2, c3 = np.full_like(c0, use), np.zeros_like(c0), np.zeros_like(c0)
    k0, k1 = seed, 0
    for _ in range(10):
        a_high, a_low = _multiply(0xD2E7470EE14C6C93, c0)
        b_high, b_low = _multiply(0xCA5A826395121157, c2)
        c0, c1, c2, c3 = b_high ^ c1 ^ np.uint64(k0), b_low, a_high ^ c3 ^ np.uint64(k1), a_low
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) & MASK, (k1 + 0xBB67AE8584CAA73B) & MASK
    return np.stack([(c >> np.uint64(11)).astype(np.float64) * 2.0**-53 for c in (c0, c1, c2, c3)], axis=1)


@dataclass(frozen=True)
class Plant:
    cell: int
    latitude: float
    longitude: float
    height: float
    size_class: int
    model: int
    scale: float
    rotation: float


def _jittered(axis: list[float], index: int, random: float, jitter: float) -> float:
    before = axis[index] - axis[index - 1] if index > 0 else axis[1] - axis[0]
    after = axis[index + 1] - axis[index] if index + 1 < len(axis) else before
    first, last = axis[index] - 0.5 * before, axis[index] + 0.5 * after
    return axis[index] + jitter * (first + random * (last - first) - axis[index])


def _between(axis: list[float], index: int, value: float) -> tuple[int, float]:
    """Interval next to `index` that contains the value, and its fraction within it."""
    sign = 1 if axis[1] > axis[0] else -1
    lower = index if sign * value >= sign * axis[index] else index - 1
    lower = min(max(lower, 0), len(axis) - 2)
    return lower, min(max((value - axis[lower]) / (axis[lower + 1] - axis[lower]), 0.0), 1.0)


def _height(elevation: list[list[float]], y: tuple[int, float], x: tuple[int, float]) -> float:
    (j, v), (i, u) = y, x
    return (
        (1 - v) * (1 - u) * elevation[j][i]
        + (1 - v) * u * elevation[j][i + 1]
        + v * (1 - u) * elevation[j + 1][i]
        + v * u * elevation[j + 1][i + 1]
    )


def _lerp(low: float, high: float, t: float) -> float:
    return low + t * (high - low)


def _tree(fuel: float, max_fuel: float, random: list[float]) -> tuple[int, int, float, float]:
    if fuel >= 1.6:
        size, multiplier, models = LARGE, _lerp(1.1, 1.4, random[0]), 2
    elif fuel >= 0.8:
        size, multiplier, models = MEDIUM, _lerp(0.9, 1.2, random[0]), 4
    else:
        size, multiplier, models = SMALL, _lerp(0.7, 1.0, random[0]), 4
    normalised = min(max(fuel / max_fuel, 0.0), 1.0)
    scale = _lerp(6.0, 18.0, normalised) * multiplier * _lerp(0.8, 1.2, random[1])
    return size, int(random[2] * models), scale, 2 * math.pi * random[3]


def algorithm2(
    canopy: NDArray,
    surface: NDArray,
    latitude: NDArray,
    longitude: NDArray,
    elevation: NDArray,
    seed: int,
    jitter: float = 1.0,
) -> tuple[list[Plant], list[Plant]]:
    """Algorithm 2 -> trees and grass in the order of their cells; grass before it is lowered by 0.70 m."""
    rows, columns = canopy.shape
    cells = np.arange(rows * columns)
    place, tree, clump = (uniform(seed, cells, use).tolist() for use in (PLACE, TREE, GRASS))
    lat, lon, ground = latitude.tolist(), longitude.tolist(), elevation.tolist()
    canopy_fuel, surface_fuel = canopy.tolist(), surface.tolist()
    max_fuel = float(canopy.max())
    trees, grass = [], []
    for y in range(rows):
        for x in range(columns):
            cell = y * columns + x
            fuel = canopy_fuel[y][x]
            if not (fuel > 0.01 or surface_fuel[y][x] > 0):
                continue
            north = _jittered(lat, y, place[cell][0], jitter)
            east = _jittered(lon, x, place[cell][1], jitter)
            height = _height(ground, _between(lat, y, north), _between(lon, x, east))
            if fuel > 0.01:
                trees.append(Plant(cell, north, east, height, *_tree(fuel, max_fuel, tree[cell])))
            if surface_fuel[y][x] > 0:
                turn = 2 * math.pi * clump[cell][0]
                grass.append(Plant(cell, north, east, height, 0, 0, 1.0, turn))
    return trees, grass
