"""Terrain surface with procedural relief, and its adaptive triangle mesh."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def perlin(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Compute 2-D gradient noise (n,) of wavelength 1 at points (n,), about -1..1 (Perlin 2002).

    Fastest if consecutive points are close to each other.
    """

def perlin_in_space(place: ArrayLike) -> NDArray[np.float64]:
    """Compute 3-D gradient noise (n,) of wavelength 1 at points (n, 3); about -1..1 (Perlin 2002).

    Gradients are chosen by Jenkins's hash (lookup3, 2006), as in the noise texture of Cycles.
    """

def uniform(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Draw uniform numbers 0..1 that depend only on the integers x and y, which broadcast, and the seed."""

def bilinear(field: ArrayLike, row: ArrayLike, column: ArrayLike) -> NDArray[np.float64]:
    """Interpolate a field (ny, nx) or (ny, nx, bands) bilinearly at fractional rows and columns.

    Rows and columns broadcast: `row[:, None], column` gives a grid. The result has their shape, followed by
    the bands. The field is extrapolated linearly beyond its ends; a single row or column is extrapolated as a
    constant. The result is NaN next to a missing value (NaN).
    """

class Surface:
    """Terrain surface between grid points: Catmull-Rom interpolation with fractal relief.

    Parameters
    ----------
    elevation
        (ny, nx) m, at least two rows and columns.
    steep
        (ny, nx) weight of the relief of 45 degree slopes, 0..1.
    dry
        (ny, nx) 0 on water, which has no relief, 1 elsewhere.
    cell
        Spacing of rows and of columns, m.
    octaves
        Wavelength (m) and weight of each octave of the relief.
    strength, level
        Amplitude of the relief on slopes of 45 degrees, m, and the fraction of it on level ground.
    sharp
        Sharpness of ridges (ridged noise).
    mean
        Mean of the sum of octaves, which is subtracted.
    seed
        Seed of the noise.
    patch
        Heights of a finer elevation model in a part of the grid: first row and column, points per cell,
        heights (m, n) in metres above the bilinear grid, and weights (m, n) 0..1 relative to the procedural
        surface.
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
        """Compute heights (n,) above the bilinear grid at fractional rows and columns (n,), m.

        The surface is a Catmull-Rom interpolation (Catmull and Rom 1974) with gradient noise (Perlin 2002).
        """

def mesh(
    place: ArrayLike,
    tolerance: ArrayLike,
    subdivision: ArrayLike | None = None,
    surface: Surface | None = None,
    camera: ArrayLike | None = None,
    radius: float = 0.0,
    margin: int = 0,
    max_span: int = 4,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Create an adaptive triangle mesh without cracks whose vertical error is within a tolerance.

    The error is tested at grid points and at points of subdivided cells. Right triangles with a larger error
    are bisected together with their neighbours (newest vertex bisection; Lindstrom et al. 1996; Evans et al.
    2001). The result does not depend on the number of threads.

    Parameters
    ----------
    place
        (ny, nx, 3) points of the ground, m; x ascends with columns, y with rows.
    tolerance
        (ny, nx) maximum vertical error, m. The minimum of the four corners applies within a cell.
    subdivision
        (ny - 1, nx - 1) number of bisections of each cell, so that heights between grid points are tested
        too.
    surface, camera, radius
        Detail added to the bilinear ground near the cameras (m, 3): in full within 0.6 `radius` (m), none
        beyond `radius`.
    margin, max_span
        Triangles within `margin` rows or columns of a side span at most `max_span` cells.

    Returns
    -------
    row, column
        (n,) fractional row and column of each vertex.
    triangle
        (m, 3) vertices of the triangles, counter-clockwise seen from above.
    """
