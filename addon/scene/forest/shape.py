"""Mesh builder of tree models: collects triangles of leaf and wood of one level of detail."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Colour = tuple[float, float, float]

FOLIAGE, BARK = 0, 1


@dataclass
class Shape:
    """A mesh that is being collected; metres for a model a metre tall.

    Attributes
    ----------
    points, triangles, materials, colours
        Chunks of (n, 3) m, (m, 3) point indices, (m,) FOLIAGE or BARK, (n, 3) linear reflectance.
    """

    points: list[Array] = field(default_factory=list)
    triangles: list[NDArray[np.int64]] = field(default_factory=list)
    materials: list[NDArray[np.int64]] = field(default_factory=list)
    colours: list[Array] = field(default_factory=list)
    count: int = 0

    def add(self, points: Array, triangles: NDArray[np.int64], material: int, colour: Array | Colour) -> None:
        """Add points (n, 3), triangles (m, 3) with indices from 0, and the colour of every point."""
        self.points.append(points)
        self.triangles.append(triangles + self.count)
        self.materials.append(np.full(len(triangles), material))
        self.colours.append(np.broadcast_to(np.asarray(colour, float), points.shape))
        self.count += len(points)

    def leaves(self, corners: Array, colour: Array) -> None:
        """Add leaf triangles with corners (n, 3, 3), and their colours (n, 3)."""
        numbers = np.arange(3 * len(corners)).reshape(-1, 3)
        self.add(corners.reshape(-1, 3), numbers, FOLIAGE, np.repeat(colour, 3, axis=0))

    def limbs(self, ways: Array, thick: Array, sides: int, colour: Colour) -> None:
        """Add tapered tubes for limbs.

        Parameters
        ----------
        ways
            (n, k, 3) polylines of n limbs, m.
        thick
            (n, k) radii, m.
        sides
            Sides of the tube; 2 for a flat ribbon.
        """
        n, k = thick.shape
        along = np.gradient(ways, axis=1)
        along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1.0e-12)
        other = np.where(np.abs(along[..., 2:]) > 0.7, [[[1.0, 0.0, 0.0]]], [[[0.0, 0.0, 1.0]]])
        across = np.cross(along, other)
        across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1.0e-12)
        up = np.cross(across, along)
        angle = 2.0 * np.pi * np.arange(sides)[:, None] / sides + 0.8
        ring = np.cos(angle) * across[:, :, None] + np.sin(angle) * up[:, :, None]
        points = ways[:, :, None] + ring * thick[:, :, None, None]
        here, after = np.arange(sides), (np.arange(sides) + 1) % sides
        if sides == 2:
            here, after = here[:1], after[:1]
        step = (np.arange(n)[:, None] * k + np.arange(k - 1)).reshape(-1, 1) * sides
        a, b, c, d = step + here, step + after, step + after + sides, step + here + sides
        triangles = np.concatenate(
            [np.stack(each, axis=-1).reshape(-1, 3) for each in ((a, b, c), (a, c, d))]
        )
        self.add(points.reshape(-1, 3), triangles, BARK, colour)

    def scaled(self, height: float) -> Shape:
        """Scale by 1 / `height`."""
        self.points = [points / height for points in self.points]
        return self

    def mesh(self) -> tuple[Array, NDArray[np.int64], NDArray[np.int64], Array]:
        """All points, triangles, materials and colours, concatenated."""
        return (
            np.concatenate(self.points),
            np.concatenate(self.triangles),
            np.concatenate(self.materials),
            np.concatenate(self.colours),
        )
