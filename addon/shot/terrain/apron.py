"""Apron: synthetic terrain beyond the run's grid, out to the horizon.

Its rows and columns continue the grid's with growing spacing, so that all terrain is one mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import noise

GROWTH = 1.05  # ratio of spacings of successive apron rows
_BANDS = 12  # height bands, each with its own distribution of fuels
_PATCHES = ((1_700.0, 50), (400.0, 58), (300.0, 54))  # m and seeds of the fuel patches
_FADE_LENGTH = 9_000.0  # m; distance within which edge heights fade into the regional plane
_MIRROR_LENGTH = 3_000.0  # m; e-folding distance of patches that mirror the land across the edge
_FLAT, _NO_FUEL = 0.05, 0.05  # m between cells and kg/m2, upper limits for water
_COAST = 0.25  # water fraction of the edge from which it counts as sea
_DEVIATION = 0.304  # standard deviation of one octave of gradient noise
_MAX_STATISTICS = 720  # rows or columns at most for statistics of the whole grid
_SMOOTH = 20  # cells to each side; finer relief is mirrored across the edge
_BANDS_OF_RELIEF = (2, 6, _SMOOTH)  # cells to each side, upper limits of the relief bands
_FADES = 2.5  # half-widths of a band over which its height at the edge fades (by eye)


@dataclass(frozen=True)
class TerrainFields:
    """Fields on a rectilinear grid, rows from south to north and columns from west to east.

    Attributes
    ----------
    latitude, longitude
        (ny,), (nx,) degrees, ascending.
    elevation, canopy_fuel, surface_fuel
        (ny, nx) m, kg/m2, kg/m2.
    margin
        Number of apron rows and columns at each side.
    """

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    elevation: NDArray[np.float64]
    canopy_fuel: NDArray[np.float64]
    surface_fuel: NDArray[np.float64]
    margin: int = 0


Known = Callable[[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]


def extend(
    fields: TerrainFields,
    cell: tuple[float, float],
    half_width: float,
    seed: int,
    measured: Known | None = None,
) -> TerrainFields:
    """Extend fields by an apron that reaches `half_width` metres from the centre.

    Parameters
    ----------
    cell
        Cell size north and east, m.
    measured
        Function that replaces synthetic heights (ny, nx) on a grid of latitudes and longitudes by known ones.
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
        max(cell),
    )
    inside = slice(count, -count)
    with ThreadPoolExecutor(1) as beside:
        ranked = [beside.submit(_rank, points, size, seed + use) for size, use in _PATCHES]
        elevation = np.pad(fields.elevation, count)
        elevation[row, column] = _heights(fields.elevation, y[inside], x[inside], points, seed)
        invented = elevation[row, column]
        if measured is not None:
            elevation[row, column] = measured(latitude, longitude, elevation)[row, column]
        ranks = [each.result() for each in ranked]
    sea = _sea(fields, points, ranks[1])
    if sea is not None:
        sea &= elevation[row, column] == invented  # an elevation model overrides it
        elevation[row[sea], column[sea]] = _level(fields)
    canopy, surface = np.pad(fields.canopy_fuel, count), np.pad(fields.surface_fuel, count)
    for fuel, whole in ((fields.canopy_fuel, canopy), (fields.surface_fuel, surface)):
        whole[row, column] = _fuel(fields.elevation, fuel, elevation[row, column], points, ranks)
        if sea is not None:
            whole[row[sea], column[sea]] = 0.0
    return TerrainFields(latitude, longitude, elevation, canopy, surface, count)


def _wet(fields: TerrainFields) -> NDArray[np.bool_]:
    """Water cells (ny, nx): level ground without fuel."""
    level = np.ones(fields.elevation.shape, bool)
    for axis in (0, 1):
        same = np.abs(np.diff(fields.elevation, axis=axis)) < _FLAT
        ahead, behind = ([slice(None)] * 2 for _ in range(2))
        ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
        level[tuple(ahead)] &= same
        level[tuple(behind)] &= same
    return level & (fields.surface_fuel + fields.canopy_fuel < _NO_FUEL)


def _rim(field: NDArray) -> NDArray:
    """Edge cells of a grid, once around."""
    return np.concatenate([field[0], field[1:, -1], field[-1, -2::-1], field[-2:0:-1, 0]])


def _level(fields: TerrainFields) -> float:
    """Water level at the grid's edge, m."""
    return float(np.median(_rim(fields.elevation)[_rim(_wet(fields))]))


def _sea(fields: TerrainFields, points: _Points, rank: NDArray[np.float64]) -> NDArray[np.bool_] | None:
    """Sea mask (n,) of apron points, with a ragged coast; None without sea.

    Sea is water along much of the edge at one height. A smaller share counts as lakes.
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
        (n,) m from the grid's edge, and mesh spacing there.
    edge, across
        Rows and columns (n,) of the grid: the nearest point, and its mirror image within the edge.
    cell
        Cell size of the grid, m.
    """

    y: NDArray[np.float64]
    x: NDArray[np.float64]
    distance: NDArray[np.float64]
    spacing: NDArray[np.float64]
    edge: tuple[NDArray[np.int64], NDArray[np.int64]]
    across: tuple[NDArray[np.int64], NDArray[np.int64]]
    cell: float

    def mirrored(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sample a field (ny, nx) at the mirror images, in square blocks as large as the mesh is coarse.

        Rows and columns of the mesh have different spacings, so single cells would become streaks.
        """
        block = np.maximum(np.round(self.spacing / self.cell), 1.0).astype(int)
        at = (
            np.minimum(index // block * block + block // 2, size - 1)
            for index, size in zip(self.across, field.shape, strict=True)
        )
        return field[tuple(at)]


def _continue(axis: NDArray[np.float64], steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Extend an axis of two or more values by `steps` (in cells) beyond both ends."""
    before = axis[0] - steps[::-1] * (axis[1] - axis[0])
    return np.concatenate([before, axis, axis[-1] + steps * (axis[-1] - axis[-2])])


def _positions(count: int, steps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Row numbers of the extended axis, fractional beyond the grid."""
    return np.concatenate([-steps[::-1], np.arange(count), count - 1 + steps])


def _reflected(count: int, position: NDArray[np.float64]) -> NDArray[np.int64]:
    """Mirror rows at the edges of a grid of `count` rows."""
    whole = 2 * (count - 1)
    around = np.round(position).astype(int) % whole
    return np.minimum(around, whole - around)


def _heights(
    heights: NDArray[np.float64],
    y: NDArray[np.float64],
    x: NDArray[np.float64],
    points: _Points,
    seed: int,
) -> NDArray[np.float64]:
    """Apron heights: edge heights that fade into the regional plane, with hills no finer than the mesh.

    The grid's rows and columns are at `y` and `x`, m. Relief finer than `_SMOOTH` is mirrored across the edge
    with inverted sign, so that slopes continue. Its offset at the edge fades faster the finer it is; else it
    would form ridges across the edge.
    """
    part = _part(heights.shape)
    some, y, x = heights[part], y[part[0]], x[part[1]]
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
    like = np.exp(-points.distance / _MIRROR_LENGTH)
    cell = abs(y[1] - y[0]) / (part[0].step or 1)
    smooth, turned = heights, np.zeros(points.x.shape)
    for cells in _BANDS_OF_RELIEF:
        finer, smooth = smooth, _blurred(heights, cells)
        fine = finer - smooth
        near = noise.smoothstep(_FADES * cells * cell, 0.0, points.distance)
        turned += 2.0 * near * fine[points.edge] - fine[points.across]
    far = 1.0 - np.exp(-points.distance / _FADE_LENGTH)
    edge = smooth[points.edge]
    return (
        edge + far * (trend(points.y, points.x) - edge) + like * turned + (1.0 - like) * 2.2 * relief * hills
    )


def _part(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Subset of rows and columns for statistics of the whole grid: all, or a stride of a large grid."""
    rows, columns = (max(count // _MAX_STATISTICS, 1) for count in shape)
    return slice(None, None, rows), slice(None, None, columns)


def _blurred(field: NDArray[np.float64], cells: int) -> NDArray[np.float64]:
    """Box blur, applied twice along both axes, over so many cells to each side; edges are extended level."""
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
    """Apron fuel (n,): near the edge as mirrored there, farther out by height band of the grid, in patches.

    The complete distribution matches the grid, not only the mean, so that the share of bare ground is
    the same. `ranks` are 0..1 at the apron's points: for the fuel, its height, and the choice of mirrored
    fuel.
    """
    part = _part(known_height.shape)
    some_heights, some_fuels = known_height[part].ravel(), known_fuel[part].ravel()
    edges = np.quantile(some_heights, np.linspace(0.0, 1.0, _BANDS + 1))
    band = np.clip(np.searchsorted(edges, some_heights) - 1, 0, _BANDS - 1)
    parts = np.linspace(0.0, 1.0, 65)
    by_band = [some_fuels[band == k] for k in range(_BANDS)]
    quantiles = np.array([np.quantile(fuel if len(fuel) else some_fuels, parts) for fuel in by_band])
    which = np.interp(height, 0.5 * (edges[1:] + edges[:-1]), np.arange(_BANDS))
    which = np.clip(np.round(which + ranks[1] - 0.5), 0, _BANDS - 1).astype(int)
    at = ranks[0] * (len(parts) - 1)
    low = np.minimum(at.astype(int), len(parts) - 2)
    usual = quantiles[which, low] + (at - low) * (quantiles[which, low + 1] - quantiles[which, low])
    return np.where(np.exp(-points.distance / _MIRROR_LENGTH) > ranks[2], points.mirrored(known_fuel), usual)


def _rank(points: _Points, size: float, seed: int) -> NDArray[np.float64]:
    """Noise rank (n,) at the apron's points, uniform in 0..1, in patches of `size` metres.

    Patches grow where the mesh is too coarse for them; else they would become streaks.
    """
    x, y = points.x, points.y
    largest = np.maximum(size, 4.0 * points.spacing)
    total, square = np.zeros(x.shape), np.zeros(x.shape)
    for octave in range(-2, 2 + int(np.ceil(np.log2(largest.max() / size)))):
        wave = size * 2.0**octave
        finer = np.log2(largest / wave)
        strength = np.where(finer < 0.0, 1.0 + finer, np.exp2(-finer)) * np.clip(3.0 - finer, 0.0, 1.0)
        strength *= np.clip(wave / points.spacing - 1.0, 0.0, 1.0)  # two points of the mesh or more
        some = np.flatnonzero(strength > 0.0)
        total[some] += strength[some] * noise.perlin(x[some] / wave, y[some] / wave, seed + octave % 4)
        square[some] += strength[some] ** 2
    # logistic approximation of the normal distribution
    return 1.0 / (1.0 + np.exp(-1.702 / _DEVIATION * total / np.sqrt(square)))
