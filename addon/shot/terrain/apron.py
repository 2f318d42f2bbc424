"""The ground beyond the run's grid, out to the horizon: invented, so that no edge of the world is seen.

Its rows and columns continue those of the grid with growing spacing, so that the whole ground is one mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import noise

GROWTH = 1.05  # each row beyond the grid is this much wider than the one before
_BANDS = 12  # of height, each with its own fuels
_PATCHES = ((1_700.0, 50), (400.0, 58), (300.0, 54))  # m and random numbers of the fuels' patches
_FORGET = 9_000.0  # m; the heights of the edge fade into the region's within this distance
_LIKE = 3_000.0  # m; in patches that grow rarer so fast, land is as that at the other side of the edge
_FLAT, _NO_FUEL = 0.05, 0.05  # m from cell to cell and kg/m2 that water has at most
_COAST = 0.25  # part of the edge that is water, from which on it is sea
_DEVIATION = 0.304  # of a wave of gradient noise
_ENOUGH = 720  # rows or columns of a grid that what is said of all of it is taken from
_SMOOTH = 20  # cells to each side; relief finer than this crosses the edge as it is
_BANDS_OF_RELIEF = (2, 6, _SMOOTH)  # cells to each side: what is finer than each, and not than the one before
_FADES = 2.5  # times a band's half-width: where its height at the edge has faded (by eye)


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
    row, column = np.nonzero((dy[:, None] > 0.0) | (dx[None, :] > 0.0))
    points = _Points(
        y[row],
        x[column],
        np.hypot(dy[row], dx[column]),
        np.maximum(dy[row], dx[column]) * (GROWTH - 1.0),
        (np.clip(row - count, 0, rows - 1), np.clip(column - count, 0, columns - 1)),
        (
            _reflected(rows, _positions(rows, steps))[row],
            _reflected(columns, _positions(columns, steps))[column],
        ),
    )
    inside = slice(count, -count)
    with ThreadPoolExecutor(1) as beside:
        ranked = [beside.submit(_rank, points, size, seed + use) for size, use in _PATCHES]
        elevation = np.pad(fields.elevation, count)
        elevation[row, column] = _heights(fields.elevation, y[inside], x[inside], points, seed)
        invented = elevation[row, column]
        if known is not None:
            elevation[row, column] = known(latitude, longitude, elevation)[row, column]
        ranks = [each.result() for each in ranked]
    sea = _sea(fields, points, ranks[1])
    if sea is not None:
        sea &= elevation[row, column] == invented  # an elevation model knows better
        elevation[row[sea], column[sea]] = _level(fields)
    fuels = []
    for fuel in (fields.canopy_fuel, fields.surface_fuel):
        fuels.append(np.pad(fuel, count))
        fuels[-1][row, column] = _fuel(fields.elevation, fuel, elevation[row, column], points, ranks)
        if sea is not None:
            fuels[-1][row[sea], column[sea]] = 0.0
    return Fields(latitude, longitude, elevation, *fuels, count)


def _wet(fields: Fields) -> NDArray[np.bool_]:
    """Which cells (ny, nx) are as level as only water is, and without fuel."""
    level = np.ones(fields.elevation.shape, bool)
    for axis in (0, 1):
        same = np.abs(np.diff(fields.elevation, axis=axis)) < _FLAT
        ahead, behind = ([slice(None)] * 2 for _ in range(2))
        ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
        level[tuple(ahead)] &= same
        level[tuple(behind)] &= same
    return level & (fields.surface_fuel + fields.canopy_fuel < _NO_FUEL)


def _rim(field: NDArray) -> NDArray:
    """The cells of the edge of a grid, once round."""
    return np.concatenate([field[0], field[1:, -1], field[-1, -2::-1], field[-2:0:-1, 0]])


def _level(fields: Fields) -> float:
    """Height of the water at the grid's edge, m."""
    return float(np.median(_rim(fields.elevation)[_rim(_wet(fields))]))


def _sea(fields: Fields, points: _Points, rank: NDArray[np.float64]) -> NDArray[np.bool_] | None:
    """Which points (n,) are sea that goes on beyond the grid, with a ragged coast; None: it has no sea.

    That is water along much of its edge, and of one height: lakes are less.
    """
    wet = _wet(fields)
    rim = _rim(wet)
    if rim.mean() < _COAST or np.ptp(_rim(fields.elevation)[rim]) > 20.0 * _FLAT:
        return None
    reach = max(len(rim) // 24, 1)
    window = np.ones(2 * reach + 1) / (2 * reach + 1)
    round_it = np.convolve(np.concatenate([rim[-reach:], rim, rim[:reach]]).astype(float), window, "valid")
    numbers = np.zeros(wet.shape, np.int64)
    rows, columns = wet.shape
    place = _rim(np.arange(rows * columns).reshape(rows, columns))
    numbers.ravel()[place] = np.arange(len(place))
    own = rim[numbers[points.edge]]
    away = noise.smoothstep(0.0, 4000.0, points.distance)
    part = (1.0 - away) * own + away * round_it[numbers[points.edge]]
    return part + (rank - 0.5) * 0.6 * away > 0.5


class _Points(NamedTuple):
    """Points of the apron, n of them.

    Attributes
    ----------
    y, x
        (n,) m from the grid's first row and column.
    distance, spacing
        (n,) m from the grid; between points there.
    edge, across
        Rows and columns (n,) of the grid: of its nearest point, and of that as far within its edge.
    """

    y: NDArray[np.float64]
    x: NDArray[np.float64]
    distance: NDArray[np.float64]
    spacing: NDArray[np.float64]
    edge: tuple[NDArray[np.int64], NDArray[np.int64]]
    across: tuple[NDArray[np.int64], NDArray[np.int64]]


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
    y: NDArray[np.float64],
    x: NDArray[np.float64],
    points: _Points,
    seed: int,
) -> NDArray[np.float64]:
    """Edge heights that fade into the region's plane with hills; hills finer than the mesh are left out.

    The grid's rows and columns are at `y` and `x`, m. Relief finer than `_SMOOTH` goes on as it is within the
    edge, turned over so that slopes go on; its height at the edge fades the sooner the finer it is, as it
    would be drawn out into ridges across the edge.
    """
    part = _part(known.shape)
    some, y, x = known[part], y[part[0]], x[part[1]]
    design = np.stack(np.broadcast_arrays(1.0, y[:, None], x[None, :]), axis=-1).reshape(-1, 3)
    plane = np.linalg.lstsq(design.T @ design, design.T @ some.ravel(), rcond=None)[0]
    low, high = np.percentile(some, [2, 98])

    def trend(y: NDArray, x: NDArray) -> NDArray[np.float64]:
        return np.clip(plane[0] + plane[1] * y + plane[2] * x, low - 200.0, high + 300.0)

    relief = float(np.std(some - trend(y[:, None], x[None, :])))
    hills, amplitude = np.zeros(points.x.shape), 1.0
    for octave in range(7):
        size = 14_000.0 / 2.0**octave
        fine = noise.smoothstep(size / 2.0, size / 4.0, points.spacing)
        hills += amplitude * fine * noise.perlin(points.x / size, points.y / size, seed + octave)
        amplitude *= 0.5
    like = np.exp(-points.distance / _LIKE)
    cell = abs(y[1] - y[0]) / (part[0].step or 1)
    smooth, turned = known, np.zeros(points.x.shape)
    for cells in _BANDS_OF_RELIEF:
        finer, smooth = smooth, _blurred(known, cells)
        fine = finer - smooth
        near = noise.smoothstep(_FADES * cells * cell, 0.0, points.distance)
        turned += 2.0 * near * fine[points.edge] - fine[points.across]
    far = 1.0 - np.exp(-points.distance / _FORGET)
    edge = smooth[points.edge]
    return (
        edge + far * (trend(points.y, points.x) - edge) + like * turned + (1.0 - like) * 2.2 * relief * hills
    )


def _part(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Rows and columns of a grid that what is said of all of it is taken from: all, of a large one some."""
    rows, columns = (max(count // _ENOUGH, 1) for count in shape)
    return slice(None, None, rows), slice(None, None, columns)


def _blurred(field: NDArray[np.float64], cells: int) -> NDArray[np.float64]:
    """Means over so many cells to each side along both axes, twice; beyond its ends it goes on level."""
    window = 2 * cells + 1
    for _ in range(4):
        total = np.cumsum(np.pad(field, [(cells + 1, cells), (0, 0)], "edge"), axis=0)
        field = ((total[window:] - total[:-window]) / window).T
    return field


def _fuel(
    known_height: NDArray[np.float64],
    known_fuel: NDArray[np.float64],
    height: NDArray[np.float64],
    points: _Points,
    ranks: list[NDArray[np.float64]],
) -> NDArray[np.float64]:
    """The apron's fuel (n,): first as across the edge, farther out as at such a height of the grid, patchy.

    Not only its mean but all its distribution is that of the grid: as much ground has to be bare.
    `ranks` are 0..1 at the apron's points: of its fuels, its height, and whether it is as across the edge.
    """
    part = _part(known_height.shape)
    some_heights, some_fuels = known_height[part].ravel(), known_fuel[part].ravel()
    edges = np.quantile(some_heights, np.linspace(0.0, 1.0, _BANDS + 1))
    band = np.clip(np.searchsorted(edges, some_heights) - 1, 0, _BANDS - 1)
    parts = np.linspace(0.0, 1.0, 65)
    found = [some_fuels[band == k] for k in range(_BANDS)]
    quantiles = np.array([np.quantile(fuel if len(fuel) else some_fuels, parts) for fuel in found])
    which = np.interp(height, 0.5 * (edges[1:] + edges[:-1]), np.arange(_BANDS))
    which = np.clip(np.round(which + ranks[1] - 0.5), 0, _BANDS - 1).astype(int)
    at = ranks[0] * (len(parts) - 1)
    low = np.minimum(at.astype(int), len(parts) - 2)
    usual = quantiles[which, low] + (at - low) * (quantiles[which, low + 1] - quantiles[which, low])
    return np.where(np.exp(-points.distance / _LIKE) > ranks[2], known_fuel[points.across], usual)


def _rank(points: _Points, size: float, seed: int) -> NDArray[np.float64]:
    """Noise at the apron's points (n,) spread evenly from 0 to 1, in patches of `size` metres.

    Where the grid is too coarse for them they are larger, else they would be streaks.
    """
    x, y = points.x, points.y
    largest = np.maximum(size, 4.0 * points.spacing)
    total, square = np.zeros(x.shape), np.zeros(x.shape)
    for octave in range(-2, 2 + int(np.ceil(np.log2(largest.max() / size)))):
        wave = size * 2.0**octave
        finer = np.log2(largest / wave)
        strength = np.where(finer < 0.0, 1.0 + finer, np.exp2(-finer)) * np.clip(3.0 - finer, 0.0, 1.0)
        some = np.flatnonzero(strength > 0.0)
        total[some] += strength[some] * noise.perlin(x[some] / wave, y[some] / wave, seed + octave % 4)
        square[some] += strength[some] ** 2
    return 1.0 / (1.0 + np.exp(-1.702 / _DEVIATION * total / np.sqrt(square)))  # nearly normal
