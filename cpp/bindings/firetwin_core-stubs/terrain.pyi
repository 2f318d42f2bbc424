"""Terrain surface with procedural relief, and its adaptive triangle mesh."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def perlin(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Gradient noise (n,) of wavelength 1 at places (n,) of the plane, about -1..1 (Perlin 2002: quintic fade).

    Quickest where neighbours in the list are neighbours on the plane.
    """

def perlin_in_space(place: ArrayLike) -> NDArray[np.float64]:
    """Gradient noise (n,) of wavelength 1 at places (n, 3), about -1..1 (Perlin 2002).

    Its slopes are chosen by the hash of Jenkins (lookup3, 2006), as in the noise texture of Cycles.
    """

def uniform(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Random numbers 0..1 that depend on integers x and y, which broadcast, and the seed alone."""

def bilinear(field: ArrayLike, row: ArrayLike, column: ArrayLike) -> NDArray[np.float64]:
    """Values of a field (ny, nx) or (ny, nx, bands) between its points, at fractional rows and columns.

    Rows and columns broadcast: `row[:, None], column` are all crossings. The result has their shape, followed
    by the bands. Beyond its ends the field goes on as between the last two points; a single row or column
    goes on level. Beside a missing value (NaN) the result is NaN.
    """

class Surface:
    """Terrain surface between grid points: Catmull-Rom interpolation with fractal relief.

    Parameters
    ----------
    elevation
        (ny, nx) m, two rows and columns or more.
    steep
        (ny, nx) weight of the relief of 45 degree slopes, 0..1.
    dry
        (ny, nx) 0 on water, where there is no relief, 1 elsewhere.
    cell
        Distance of rows and of columns, m.
    octaves
        Wavelength (m) and weight of each wave of the relief.
    strength
        Of the relief where slopes are 45 degrees, m; on level ground `level` of it.
    sharp
        Depth of a wave's valleys below its ridges (ridged noise).
    mean
        Mean of the sum of waves, which is subtracted.
    seed
        Seed of the noise.
    patch
        Heights known more finely in a part of the grid: its first row and column, how many points it has to
        a cell, their heights (m, n) less the grid's bilinear ones in metres, and shares (m, n) 0..1: how far
        they count in place of smoothness and relief.
    """

    def __init__(
        self,
        elevation: ArrayLike,
        steep: ArrayLike,
        dry: ArrayLike,
        cell: tuple[float, float],
        octaves: Sequence[tuple[float, float]],
        strength: float,
        level: float,
        sharp: float,
        mean: float,
        seed: int,
        patch: tuple[int, int, int, ArrayLike, ArrayLike] | None = None,
    ) -> None: ...
    def detail(self, row: ArrayLike, column: ArrayLike) -> NDArray[np.float64]:
        """Height (n,) of the surface above the bilinear one, at fractional rows and columns (n,); m.

        Between grid points the surface is that of Catmull and Rom 1974, with gradient noise (Perlin 2002).
        """

def mesh(
    place: ArrayLike,
    tolerance: ArrayLike,
    fine: ArrayLike | None = None,
    surface: Surface | None = None,
    eye: ArrayLike | None = None,
    radius: float = 0.0,
    margin: int = 0,
    widest: int = 4,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Adaptive triangle mesh without cracks: its vertical error is nowhere above the tolerance.

    The error is tested at grid points and at points of refined cells. Right triangles with a larger error are
    bisected, and their neighbours with them (newest vertex bisection; Lindstrom et al. 1996; Evans
    et al. 2001). The same for any number of threads.

    Parameters
    ----------
    place
        (ny, nx, 3) points of the ground, m; x ascends with columns, y with rows.
    tolerance
        (ny, nx) largest vertical error, m. Between the grid's points the least of the four counts.
    fine
        (ny - 1, nx - 1) how often each cell is halved, so that heights between the grid's points count.
    surface, eye, radius
        What is added to the bilinear ground within `radius` (m) of the eyes (m, 3): all of it within 0.6 of
        that, nothing beyond.
    margin, widest
        Triangles that reach into so many rows and columns at each side span at most `widest` cells.

    Returns
    -------
    row, column
        (n,) vertices: fractional rows and columns of the grid.
    triangle
        (m, 3) vertices of each, counter-clockwise seen from above.
    """
