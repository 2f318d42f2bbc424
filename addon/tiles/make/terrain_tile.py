"""Mesh of one tile of terrain, with a skirt that closes gaps to neighbours of other levels."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from ... import ellipsoid
from ...ellipsoid import ecef, enu_axes
from .glb import Mesh
from .lattice import Lattice

Array = NDArray[np.float64]
_MARGIN = 0.05  # m, added to skirts for the rounding of vertices


def mesh(lattice: Lattice, level: int, row: int, column: int, picture: bytes) -> Mesh:
    """Make the mesh of a tile; neighbours of one level share border vertices."""
    stride = lattice.stride(level)
    rows, columns = lattice.block(level, row, column)
    latitude, longitude = lattice.latitude[rows][::stride], lattice.longitude[columns][::stride]
    height = lattice.height[rows, columns][::stride, ::stride].astype(np.float64)
    normal = _normals(lattice, rows, columns, stride, latitude, longitude).reshape(-1, 3)
    lat, lon = (axis.ravel() for axis in np.meshgrid(latitude, longitude, indexing="ij"))
    border = _border(lattice.cells)
    skirt = lattice.edge_gap(level, row, column) + _MARGIN
    below = ecef(np.radians(lat[border]), np.radians(lon[border]), height.ravel()[border] - skirt)
    position = np.vstack([ecef(np.radians(lat), np.radians(lon), height.ravel()), below])
    origin = np.round(position.mean(axis=0))
    uv = np.column_stack([_share(lon), 1.0 - _share(lat)])
    return Mesh(
        origin=origin,
        position=position - origin,
        normal=np.vstack([normal, normal[border]]),
        triangles=_triangles(lattice.cells),
        uv=np.vstack([uv, uv[border]]),
        picture=picture,
    )


def heights(lattice: Lattice, level: int, row: int, column: int) -> tuple[float, float]:
    """Compute the lowest and highest point of a tile's mesh, skirt included, m above the ellipsoid."""
    stride = lattice.stride(level)
    height = lattice.height[lattice.block(level, row, column)][::stride, ::stride]
    skirt = lattice.edge_gap(level, row, column) + _MARGIN
    return float(height.min()) - skirt, float(height.max())


def _normals(
    lattice: Lattice, rows: slice, columns: slice, stride: int, latitude: Array, longitude: Array
) -> Array:
    """Compute unit normals (n, n, 3) by central differences over `stride`, one-sided at the border."""
    scale = ellipsoid.metres_per_degree(float(lattice.latitude.mean()))
    slopes = []
    for axis, (span, degrees, metres) in enumerate(
        zip((rows, columns), (lattice.latitude, lattice.longitude), scale, strict=True)
    ):
        at = np.arange(span.start, span.stop, stride)
        before, after = np.maximum(at - stride, 0), np.minimum(at + stride, len(degrees) - 1)
        run = (degrees[after] - degrees[before]) * metres
        if axis == 0:
            other = np.arange(columns.start, columns.stop, stride)
            rise = lattice.height[np.ix_(after, other)] - lattice.height[np.ix_(before, other)]
            slopes.append(rise / run[:, None])
        else:
            other = np.arange(rows.start, rows.stop, stride)
            rise = lattice.height[np.ix_(other, after)] - lattice.height[np.ix_(other, before)]
            slopes.append(rise / run[None, :])
    axes = enu_axes(*np.broadcast_arrays(np.radians(latitude)[:, None], np.radians(longitude)))
    east, north, up = np.moveaxis(axes, -2, 0)
    normal = up - slopes[1][..., None] * east - slopes[0][..., None] * north
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def _share(axis: Array) -> Array:
    return (axis - axis[0]) / (axis[-1] - axis[0])


def _numbers(cells: tuple[int, int]) -> NDArray[np.int64]:
    rows, columns = (count + 1 for count in cells)
    return np.arange(rows * columns).reshape(rows, columns)


@functools.cache
def _border(cells: tuple[int, int]) -> NDArray[np.int64]:
    """List vertices (b,) along the border, anticlockwise from above, from the south-western corner."""
    number = _numbers(cells)
    return np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])


@functools.cache
def _triangles(cells: tuple[int, int]) -> NDArray[np.int64]:
    """List triangles (t, 3) of the surface and of the skirt, counter-clockwise from outside."""
    number = _numbers(cells)
    low, east = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    north, far = number[1:, :-1].ravel(), number[1:, 1:].ravel()
    border = _border(cells)
    following, below = np.roll(border, -1), number.size + np.arange(len(border))
    beneath = np.roll(below, -1)
    return np.vstack(
        [
            np.column_stack([low, east, north]),
            np.column_stack([east, far, north]),
            np.column_stack([border, below, beneath]),
            np.column_stack([border, beneath, following]),
        ]
    )
