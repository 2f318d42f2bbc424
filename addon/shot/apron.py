"""The ground beyond the run's grid, out to the horizon: invented, so that no edge of the world is seen.

Its rows and columns continue those of the grid with growing spacing, so that the whole ground is one mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import noise

GROWTH = 1.05  # each row beyond the grid is this much wider than the one before
_BANDS = 12  # of height, each with its own fuels
_PATCHES = ((1_700.0, 50), (400.0, 58), (300.0, 54))  # m and random numbers of the fuels' patches
_FORGET = 9_000.0  # m; the heights of the edge fade into the region's within this distance
_LIKE = 3_000.0  # m; in patches that grow rarer so fast, land is as that at the other side of the edge
_DEVIATION = 0.304  # of a wave of gradient noise
_SMOOTH = 20  # cells to each side; relief finer than this crosses the edge as it is


@dataclass(frozen=True)
class Fields:
    """Fields on a rectilinear grid, rows from south to north and columns from west to east.

    Attributes
    ----------
    latitude, longitude
        (ny,), (nx,) degrees, ascending.
    elevation, canopy_fuel, surface_fuel
        (ny, nx) m, kg/m2, kg/m2.
    margin
        How many rows and columns at each side are apron.
    """

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    elevation: NDArray[np.float64]
    canopy_fuel: NDArray[np.float64]
    surface_fuel: NDArray[np.float64]
    margin: int = 0


Known = Callable[[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]


def extend(
    fields: Fields, cell: tuple[float, float], half_width: float, seed: int, known: Known | None = None
) -> Fields:
    """`fields` with an apron that reaches `half_width` metres from the middle.

    Parameters
    ----------
    cell
        Size of a cell, north and east, m.
    known
        Makes heights (ny, nx) of a grid of latitudes and longitudes of invented ones, where more is known.
    """
    rows, columns = fields.elevation.shape
    reach = half_width - 0.5 * min(rows * cell[0], columns * cell[1])
    if reach <= 0.0:
        return fields
    count = int(np.ceil(np.log1p(reach * (GROWTH - 1.0) / min(cell)) / np.log(GROWTH)))
    steps = np.cumsum(GROWTH ** np.arange(1, count + 1))  # distance beyond the edge, in cells
    steps *= reach / min(cell) / steps[-1]
    latitude, longitude = (_continue(axis, steps) for axis in (fields.latitude, fields.longitude))
    y, x = _positions(rows, steps) * cell[0], _positions(columns, steps) * cell[1]
    dy = np.maximum(np.maximum(y[count] - y, y - y[count + rows - 1]), 0.0)
    dx = np.maximum(np.maximum(x[count] - x, x - x[count + columns - 1]), 0.0)
    distance = np.hypot(dy[:, None], dx[None, :])
    spacing = np.maximum(dy[:, None], dx[None, :]) * (GROWTH - 1.0)
    across = tuple(_reflected(side, _positions(side, steps)) for side in (rows, columns))
    apron = distance > 0.0
    yy, xx = (np.broadcast_to(at, distance.shape)[apron] for at in (y[:, None], x[None, :]))
    with ThreadPoolExecutor(1) as beside:
        ranked = [beside.submit(_rank, xx, yy, size, spacing[apron], seed + use) for size, use in _PATCHES]
        elevation = _heights(fields.elevation, across, y, x, distance, spacing, seed)
        if known is not None:
            elevation = np.where(apron, known(latitude, longitude, elevation), elevation)
        ranks = [each.result() for each in ranked]
    canopy, surface = (
        _fuel(fields.elevation, fuel, across, elevation, distance, ranks)
        for fuel in (fields.canopy_fuel, fields.surface_fuel)
    )
    return Fields(latitude, longitude, elevation, canopy, surface, count)


def _continue(axis: NDArray[np.float64], steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """An axis of two values or more with `steps` (cells beyond its ends) added at both ends."""
    before = axis[0] - steps[::-1] * (axis[1] - axis[0])
    return np.concatenate([before, axis, axis[-1] + steps * (axis[-1] - axis[-2])])


def _positions(count: int, steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Row numbers of the continued axis, fractional beyond the grid."""
    return np.concatenate([-steps[::-1], np.arange(count), count - 1 + steps])


def _reflected(count: int, position: NDArray[np.float64]) -> NDArray[np.int64]:
    """The row of a grid of `count` that lies as far within the edge as each of these lies beyond it."""
    whole = 2 * (count - 1)
    around = np.round(position).astype(int) % whole
    return np.minimum(around, whole - around)


def _heights(
    known: NDArray[np.float64],
    across: tuple[NDArray[np.int64], NDArray[np.int64]],
    y: NDArray[np.float64],
    x: NDArray[np.float64],
    distance: NDArray[np.float64],
    spacing: NDArray[np.float64],
    seed: int,
) -> NDArray[np.float64]:
    """Edge heights that fade into the region's plane with hills; hills finer than the mesh are left out.

    Relief finer than `_SMOOTH` goes on as it is within the edge (`across`), turned over so that slopes go on.
    """
    margin, inside = (len(y) - known.shape[0]) // 2, distance == 0.0
    yy, xx = np.broadcast_arrays(y[:, None], x[None, :])
    design = np.stack([np.ones(inside.sum()), yy[inside], xx[inside]], axis=1)
    normal = design.T @ design
    plane = np.linalg.lstsq(normal, design.T @ known.ravel(), rcond=None)[0]
    trend = plane[0] + plane[1] * yy + plane[2] * xx
    low, high = np.percentile(known, [2, 98])
    trend = np.clip(trend, low - 200.0, high + 300.0)
    relief = float(np.std(known.ravel() - trend[inside]))
    hills, amplitude, away = np.zeros(distance.shape), 1.0, ~inside
    for octave in range(7):
        size = 14_000.0 / 2.0**octave
        fine = noise.smoothstep(size / 2.0, size / 4.0, spacing[away])
        hills[away] += amplitude * fine * noise.perlin(xx[away] / size, yy[away] / size, seed + octave)
        amplitude *= 0.5
    smooth = _blurred(known)
    fine = known - smooth
    like = np.exp(-distance / _LIKE)
    turned = (
        2.0 * np.pad(fine, margin, "edge") * noise.smoothstep(1500.0, 0.0, distance) - fine[np.ix_(*across)]
    )
    far = 1.0 - np.exp(-distance / _FORGET)
    edge = np.pad(smooth, margin, "edge")
    made = edge + far * (trend - edge) + like * turned + (1.0 - like) * 2.2 * relief * hills
    made[inside] = known.ravel()
    return made


def _blurred(field: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means over `_SMOOTH` cells to each side along both axes, twice; beyond its ends it goes on level."""
    window = 2 * _SMOOTH + 1
    for axis in (0, 1, 0, 1):
        padded = np.pad(field, [(_SMOOTH + 1, _SMOOTH) if k == axis else (0, 0) for k in (0, 1)], "edge")
        total = np.cumsum(padded, axis=axis)
        count = field.shape[axis]
        field = (total.take(range(window, window + count), axis) - total.take(range(count), axis)) / window
    return field


def _fuel(
    known_height: NDArray[np.float64],
    known_fuel: NDArray[np.float64],
    across: tuple[NDArray[np.int64], NDArray[np.int64]],
    height: NDArray[np.float64],
    distance: NDArray[np.float64],
    ranks: list[NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Fuel and the apron's: as across the edge at first, farther out as at such a height of the grid, patchy.

    Not only its mean but all its distribution is that of the grid: as much ground has to be bare.
    `ranks` are 0..1 at the apron's points: of its fuels, its height, and whether it is as across the edge.
    """
    apron = distance > 0.0
    edges = np.quantile(known_height, np.linspace(0.0, 1.0, _BANDS + 1))
    band = np.clip(np.searchsorted(edges, known_height) - 1, 0, _BANDS - 1)
    parts = np.linspace(0.0, 1.0, 65)
    found = [known_fuel[band == k] for k in range(_BANDS)]
    quantiles = np.array([np.quantile(fuel if len(fuel) else known_fuel, parts) for fuel in found])
    which = np.interp(height[apron], 0.5 * (edges[1:] + edges[:-1]), np.arange(_BANDS))
    which = np.clip(np.round(which + ranks[1] - 0.5), 0, _BANDS - 1).astype(int)
    at = ranks[0] * (len(parts) - 1)
    low = np.minimum(at.astype(int), len(parts) - 2)
    usual = quantiles[which, low] + (at - low) * (quantiles[which, low + 1] - quantiles[which, low])
    found = known_fuel[np.ix_(*across)]
    found[apron] = np.where(np.exp(-distance[apron] / _LIKE) > ranks[2], found[apron], usual)
    return found


def _rank(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    size: float,
    spacing: NDArray[np.float64],
    seed: int,
) -> NDArray[np.float64]:
    """Noise at places (n,) spread evenly from 0 to 1, in patches of `size` metres.

    Where the grid is too coarse for them (`spacing`, (n,) m) they are larger, else they would be streaks.
    """
    largest = np.maximum(size, 4.0 * spacing)
    total, square = np.zeros(x.shape), np.zeros(x.shape)
    for octave in range(-2, 2 + int(np.ceil(np.log2(largest.max() / size)))):
        wave = size * 2.0**octave
        finer = np.log2(largest / wave)
        strength = np.where(finer < 0.0, 1.0 + finer, np.exp2(-finer)) * np.clip(3.0 - finer, 0.0, 1.0)
        some = np.flatnonzero(strength > 0.0)
        total[some] += strength[some] * noise.perlin(x[some] / wave, y[some] / wave, seed + octave % 4)
        square[some] += strength[some] ** 2
    return 1.0 / (1.0 + np.exp(-1.702 / _DEVIATION * total / np.sqrt(square)))  # nearly normal
