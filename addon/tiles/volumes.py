"""Bounding volumes as boxes that are widened by a radius; a sphere is a box without extent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import ecef, enu_axes
from .json_text import Node

_SQUARE = 1e-14  # cosine of the angle between edges at right angles


@dataclass(frozen=True)
class Volumes:
    """Bounding volumes of n tiles.

    Attributes
    ----------
    centre
        (n, 3) m.
    axis
        (n, 3, 3) orthonormal directions of the edges, as rows.
    half
        (n, 3) half lengths of the edges, m.
    padding
        (n,) radius of the sphere that is swept along the box (Minkowski sum), m.
    """

    centre: NDArray[np.float64]
    axis: NDArray[np.float64]
    half: NDArray[np.float64]
    padding: NDArray[np.float64]

    @property
    def radius(self) -> NDArray[np.float64]:
        """(n,) radii of the bounding spheres about `centre`, m."""
        return np.linalg.norm(self.half, axis=1) + self.padding

    def corners(self) -> NDArray[np.float64]:
        """Compute the corners (n, 8, 3) of the boxes, m."""
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1], indexing="ij")).reshape(3, 8).T
        edges = self.axis * self.half[:, :, None]
        return self.centre[:, None] + np.einsum("kj,nji->nki", signs.astype(float), edges)

    def moved(self, matrices: NDArray[np.float64], which: NDArray[np.int64]) -> Volumes:
        """Transform by ``matrices[which]``, (m, 4, 4) and (n,); radii grow by the largest scale."""
        if len(matrices) == 1 and np.array_equal(matrices[0], np.eye(4)):
            return self
        linear = matrices[which, :3, :3]
        centre = np.einsum("nij,nj->ni", linear, self.centre) + matrices[which, :3, 3]
        edges = np.einsum("nij,nkj->nki", linear, self.axis * self.half[:, :, None])
        axis, half = orthonormal(edges)
        return Volumes(centre, axis, half, self.padding * largest_scale(matrices[:, :3, :3])[which])

    def take(self, which: NDArray[np.int64]) -> Volumes:
        """Select volumes by index."""
        return Volumes(self.centre[which], self.axis[which], self.half[which], self.padding[which])

    @staticmethod
    def concatenate(parts: list[Volumes]) -> Volumes:
        """Concatenate several sets of volumes."""
        if not parts:
            return Volumes(np.empty((0, 3)), np.empty((0, 3, 3)), np.empty((0, 3)), np.empty(0))
        return Volumes(
            *(
                np.concatenate([getattr(p, name) for p in parts])
                for name in ("centre", "axis", "half", "padding")
            )
        )


def largest_scale(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the largest scale (n,) of matrices (n, 3, 3): their largest singular value."""
    return np.linalg.svd(linear, compute_uv=False)[..., 0] if len(linear) else np.empty(0)


def orthonormal(edges: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute the smallest aligned box around the body spanned by half edges (n, 3, 3).

    Edges at right angles keep their lengths. Otherwise the longest keeps its direction.

    Returns
    -------
    Orthonormal directions (n, 3, 3) as rows, and half lengths (n, 3), m.
    """
    if not len(edges):
        return np.empty((0, 3, 3)), np.empty((0, 3))
    half = np.sqrt(np.einsum("nki,nki->nk", edges, edges))
    axis = edges / np.where(half > 0.0, half, 1.0)[:, :, None]
    askew = np.einsum("nki,nki->nk", axis, axis[:, [1, 2, 0]])
    odd = (np.abs(askew).max(axis=1) > _SQUARE) | (half.min(axis=1) == 0.0)
    axis[odd], half[odd] = _fitted(edges[odd])
    return axis, half


def _fitted(edges: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute `orthonormal` of edges that are flat or not at right angles."""
    order = np.argsort(-np.linalg.norm(edges, axis=2), axis=1, kind="stable")
    sorted_edges = np.take_along_axis(edges, order[:, :, None], axis=1)
    # Unit lengths avoid rounding of flat boxes; columns are edges.
    scale = np.linalg.norm(sorted_edges[:, :1], axis=2, keepdims=True)
    q, _ = np.linalg.qr(np.swapaxes(sorted_edges / np.where(scale > 0.0, scale, 1.0), 1, 2))
    axis = np.swapaxes(q, 1, 2)
    half = np.abs(np.einsum("nki,nji->nkj", axis, edges)).sum(axis=2)
    return axis, half


def of_boxes(numbers: NDArray[np.float64]) -> Volumes:
    """Convert boxes of 3D Tiles (n, 12): centre and three half edges, m; may be flat or slanted."""
    numbers = np.reshape(numbers, (-1, 12))
    axis, half = orthonormal(numbers[:, 3:].reshape(-1, 3, 3))
    return Volumes(numbers[:, :3], axis, half, np.zeros(len(numbers)))


def of_spheres(numbers: NDArray[np.float64]) -> Volumes:
    """Convert spheres of 3D Tiles (n, 4): centre and radius, m."""
    numbers = np.reshape(numbers, (-1, 4))
    n = len(numbers)
    return Volumes(numbers[:, :3], np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3)), numbers[:, 3])


def of_regions(numbers: NDArray[np.float64]) -> Volumes:
    """Bound regions of 3D Tiles (n, 6): west, south, east, north, rad; lowest, highest, m (EPSG:4979).

    The box of a region at most half a turn wide is aligned with the east-north-up frame of its middle. The
    extremes are at its corners, middle meridian or the equator. Boxes of wider regions are aligned with
    the Earth's axes.
    """
    numbers = np.reshape(numbers, (-1, 6))
    west, south, east, north = numbers[:, :4].T
    low, high = np.minimum(numbers[:, 4], numbers[:, 5]), np.maximum(numbers[:, 4], numbers[:, 5])
    width = np.where(east < west, east + 2.0 * np.pi, east) - west
    middle = west + 0.5 * width
    wide = width > np.pi
    axis = enu_axes(np.where(wide, 0.0, 0.5 * (south + north)), middle)
    latitudes = np.stack([south, 0.5 * (south + north), north, np.clip(0.0, south, north)])
    offsets = np.stack([-0.5 * width, np.zeros_like(width), 0.5 * width])
    offsets[:, wide] = np.array([-0.5, 0.0, 0.5])[:, None] * np.pi
    places = [
        ecef(latitude, middle + offset, height)
        for latitude in latitudes
        for offset in offsets
        for height in (low, high)
    ]
    along = np.einsum("nki,pni->pnk", axis, np.stack(places))
    least, most = along.min(axis=0), along.max(axis=0)
    least[wide, 2] = -most[wide, 2]  # up, of the frame on the equator: also behind the Earth
    centre = np.einsum("nki,nk->ni", axis, 0.5 * (least + most))
    return Volumes(centre, axis, 0.5 * (most - least), np.zeros(len(numbers)))


KINDS = {"box": 12, "sphere": 4, "region": 6}
"""Kinds of bounding volumes, and how many numbers each has."""
_ROUNDING = 1e-6  # rad beyond a pole or half a turn


def read(node: Node) -> tuple[str, list[float]]:
    """Read the kind and numbers of a bounding volume.

    Raises
    ------
    InputError
        Its kind is unknown, or its numbers are invalid.
    """
    for kind, count in KINDS.items():
        if (found := node.get(kind)) is not None:
            numbers = found.numbers(count)
            _check(found, kind, numbers)
            return kind, numbers
    others = ", ".join([*node.object(), *(node.value.get("extensions") or {})])[:120]
    raise node.error(f"has no box, region or sphere ({others or 'nothing'})")


def _check(node: Node, kind: str, numbers: list[float]) -> None:
    if max(map(abs, numbers)) > 1e15:
        raise node.error("has a number beyond 1e15")
    if kind == "sphere" and numbers[3] < 0.0:
        raise node.error("has a negative radius")
    if kind == "region":
        west, south, east, north = numbers[:4]
        steepest = 0.5 * np.pi + _ROUNDING
        if not -steepest <= south <= north <= steepest:
            raise node.error("must have south <= north within -pi/2..pi/2 (rad)")
        if max(abs(west), abs(east)) > 2.0 * np.pi + _ROUNDING:
            raise node.error("has a longitude beyond a turn (rad)")


def from_numbers(kind: str, numbers: NDArray[np.float64]) -> Volumes:
    """Convert the numbers of volumes of one kind."""
    return {"box": of_boxes, "sphere": of_spheres, "region": of_regions}[kind](numbers)
