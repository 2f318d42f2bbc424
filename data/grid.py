"""The sample's two grids: 144 x 144 model cells of 370 m and 720 x 720 fuel cells of 74 m over one square.

Both have evenly spaced WGS84 latitudes (ascending) and longitudes; a cell is 370 m or 74 m wide at the
centre.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import metres_per_degree

CENTRE_LATITUDE = 38.93
CENTRE_LONGITUDE = -120.52
MODEL_CELLS = 144
MODEL_CELL_SIZE = 370.0  # m
FUEL_CELLS = 720
FUEL_CELL_SIZE = 74.0  # m
REFINEMENT = FUEL_CELLS // MODEL_CELLS


def axes(cells: int, cell_size: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Latitudes and longitudes (cells,) of the centres of square cells of `cell_size` metres."""
    offset = (np.arange(cells) - (cells - 1) / 2) * cell_size
    north, east = metres_per_degree(CENTRE_LATITUDE)
    return CENTRE_LATITUDE + offset / north, CENTRE_LONGITUDE + offset / east


def local(latitude: ArrayLike, longitude: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Metres east and north of the centre on the flat grid (the sample's own map, not the tangent plane)."""
    north, east = metres_per_degree(CENTRE_LATITUDE)
    x = (np.asarray(longitude, dtype=float) - CENTRE_LONGITUDE) * east
    y = (np.asarray(latitude, dtype=float) - CENTRE_LATITUDE) * north
    return x, y


def cell_of(
    latitude: ArrayLike, longitude: ArrayLike, cells: int = FUEL_CELLS, cell_size: float = FUEL_CELL_SIZE
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Row and column of the cell that holds each point; may lie outside 0..cells-1."""
    x, y = local(latitude, longitude)
    row = np.floor(y / cell_size + cells / 2).astype(int)
    column = np.floor(x / cell_size + cells / 2).astype(int)
    return row, column


def block_mean(fine: NDArray, factor: int = REFINEMENT) -> NDArray:
    """Mean over factor x factor blocks: (fy, fx) -> (fy / factor, fx / factor), in float64."""
    ny, nx = fine.shape[0] // factor, fine.shape[1] // factor
    return fine.reshape(ny, factor, nx, factor).mean(axis=(1, 3), dtype=np.float64)
