"""Tree models one metre tall: ten conifers for Algorithm 2's classes, foothill oaks, snags, and grass.

Up to 4,000 triangles, which instances share: uneven whorls of branches with sprays of needles round a trunk
that shows. Every model is made from its own seed, so a scene's trees are always the same.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FIRST_MODEL = {2: 0, 1: 2, 0: 6}  # Algorithm 2's size class (LARGE 2, MEDIUM 1, SMALL 0) -> its first model
OAKS = (10, 11)
SNAGS = (12, 13, 14)
GRASS = (0, 1)
REACH = 0.6  # of a tree's height: no part of its model is farther from its middle
_FOLIAGE, _BARK = 0, 1


@dataclass(frozen=True)
class Conifer:
    """Shape of a conifer; lengths in tree heights.

    Attributes
    ----------
    bare
        Height of the lowest branches.
    width
        Length of the longest branches.
    whorls, branches
        Rings of branches, and branches in each.
    droop
        Fall of a branch's tip below its root, in branch lengths; negative rises.
    taper
        How pointed the crown is: 1 a cone, below 1 rounder, above 1 a spire.
    irregular
        Spread of branch lengths.
    """

    bare: float
    width: float
    whorls: int
    branches: int
    droop: float
    taper: float
    irregular: float


FIR = Conifer(0.10, 0.20, 15, 6, 0.35, 0.95, 0.18)
RED_FIR = Conifer(0.20, 0.17, 15, 6, 0.25, 0.80, 0.22)
PINE = Conifer(0.34, 0.23, 11, 7, -0.10, 0.55, 0.40)
SUGAR_PINE = Conifer(0.42, 0.26, 9, 6, 0.15, 0.45, 0.50)
CEDAR = Conifer(0.06, 0.18, 16, 6, 0.55, 0.75, 0.15)
YOUNG = Conifer(0.04, 0.28, 11, 6, 0.25, 1.0, 0.20)

# In the order of Algorithm 2: two LARGE, four MEDIUM, four SMALL.
SPECIES = (SUGAR_PINE, RED_FIR, PINE, FIR, CEDAR, RED_FIR, YOUNG, PINE, CEDAR, FIR)


@dataclass
class Shape:
    """A mesh being collected."""

    points: list[Array] = field(default_factory=list)
    faces: list[tuple[int, ...]] = field(default_factory=list)
    materials: list[int] = field(default_factory=list)
    count: int = 0

    def add(self, points: Array, faces: list[tuple[int, ...]], material: int) -> None:
        """Add points (n, 3) and faces that count from 0."""
        self.points.append(points)
        self.faces += [tuple(self.count + i for i in face) for face in faces]
        self.materials += [material] * len(faces)
        self.count += len(points)


def conifer(kind: Conifer, seed: int) -> Shape:
    """Model of a conifer."""
    random, shape = np.random.default_rng(seed), Shape()
    lean = random.normal(0.0, 0.006, 2)
    _trunk(shape, 0.014, lean, 5)
    heights = kind.bare + (0.97 - kind.bare) * np.linspace(0.0, 1.0, kind.whorls) ** 0.92
    for height in heights:
        up = (height - kind.bare) / (0.97 - kind.bare)
        reach = kind.width * max((1.0 - up) ** kind.taper, 0.10)
        reach *= min(1.0, 0.55 + 2.2 * up)  # the lowest branches are shaded out
        start = random.uniform(0.0, 2.0 * np.pi)
        number = kind.branches if up < 0.8 else max(kind.branches - 2, 4)
        for k in range(number):
            if random.random() < 0.35 * kind.irregular:
                continue  # a gap in the crown
            angle = start + 2.0 * np.pi * (k + random.uniform(-0.25, 0.25)) / number
            length = reach * np.exp(random.normal(0.0, kind.irregular * 0.6))
            z = height + random.normal(0.0, 0.4) * 0.9 / kind.whorls
            droop = kind.droop * (1.0 - 0.7 * up) + random.normal(0.0, 0.08)
            _branch(shape, lean, z, angle, length, droop, random)
    _leader(shape, lean, kind.width * 0.10)
    top = max(float(points[:, 2].max()) for points in shape.points)
    shape.points = [points / top for points in shape.points]
    return shape


def _trunk(shape: Shape, radius: float, lean: Array, sides: int, top: float = 1.0) -> None:
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=-1)
    rings = []
    for z, width in ((-0.05, 1.25), (0.03, 1.0), (0.5 * top, 0.62), (top, 0.06)):
        rings.append(ring * radius * width + np.array([lean[0] * z, lean[1] * z, z]))
    faces = [
        (i * sides + k, i * sides + (k + 1) % sides, (i + 1) * sides + (k + 1) % sides, (i + 1) * sides + k)
        for i in range(3)
        for k in range(sides)
    ]
    shape.add(np.concatenate(rings), faces, _BARK)


def _branch(
    shape: Shape,
    lean: Array,
    z: float,
    angle: float,
    length: float,
    droop: float,
    random: np.random.Generator,
) -> None:
    """A branch that bends down, and sprays of needles along both its sides: folded, pointed blades."""
    out = np.array([np.cos(angle), np.sin(angle), 0.0])
    side = np.array([-np.sin(angle), np.cos(angle), 0.0])
    root = np.array([lean[0] * z, lean[1] * z, z])

    def spine(s: float) -> Array:
        return root + out * s * length + np.array([0.0, 0.0, -droop * s**1.6 * length])

    _blade(shape, spine(0.05), spine(1.0), spine(0.6), side * 0.13 * length)
    for s in (0.22, 0.42, 0.62, 0.82):
        for hand in (-1.0, 1.0):
            long = length * 0.52 * (1.12 - s) * random.uniform(0.75, 1.25)
            turn = np.radians(random.uniform(38.0, 62.0)) * hand
            ahead = out * np.cos(turn) + side * np.sin(turn)
            fall = np.array([0.0, 0.0, -random.uniform(0.12, 0.45) - 0.5 * max(droop, 0.0)])
            across = np.cross(ahead, [0.0, 0.0, 1.0]) * 0.34 * long
            start = spine(s)
            _blade(
                shape,
                start,
                start + (ahead + fall) * long,
                start + (ahead + 0.35 * fall) * 0.5 * long,
                across,
            )


def _blade(shape: Shape, root: Array, tip: Array, middle: Array, across: Array) -> None:
    """Two folded faces from root to tip, as wide as 2 `across` in the middle, where the edges hang."""
    hang = np.array([0.0, 0.0, -0.45 * float(np.linalg.norm(across))])
    points = np.array([root, middle + across + hang, tip, middle - across + hang, middle])
    shape.add(points, [(0, 1, 2, 4), (0, 4, 2, 3)], _FOLIAGE)


def _leader(shape: Shape, lean: Array, width: float) -> None:
    """The tip of the crown."""
    angle = 2.0 * np.pi * np.arange(4) / 4
    base = np.stack([np.cos(angle) * width, np.sin(angle) * width, np.full(4, 0.93)], axis=-1)
    points = np.vstack([base, [[0.0, 0.0, 1.0]]]) + np.array([lean[0], lean[1], 0.0])
    shape.add(points, [(k, (k + 1) % 4, 4) for k in range(4)], _FOLIAGE)


def oak(seed: int) -> Shape:
    """Model of a foothill oak: a short forked trunk under a broad crown of leaf clusters."""
    random, shape = np.random.default_rng(seed), Shape()
    _trunk(shape, 0.035, random.normal(0.0, 0.05, 2), 5, 0.7)
    for _ in range(46):
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        centre = np.array([0.0, 0.0, 0.62]) + direction * np.array([0.42, 0.42, 0.30]) * random.uniform(
            0.55, 1.0
        )
        _cluster(shape, centre, random.uniform(0.10, 0.17), random)
    return shape


def _cluster(shape: Shape, centre: Array, radius: float, random: np.random.Generator) -> None:
    """A clump of leaves: an uneven octahedron."""
    axes = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 0.8], [0, 0, -0.6]], float)
    turn = random.uniform(0.0, np.pi)
    c, s = np.cos(turn), np.sin(turn)
    axes = axes @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    points = centre + axes * radius * random.uniform(0.7, 1.3, (6, 1))
    points[:, 2] = np.minimum(points[:, 2], 1.0)
    faces = [(k, (k + 1) % 4, 4) for k in range(4)] + [((k + 1) % 4, k, 5) for k in range(4)]
    shape.add(points, faces, _FOLIAGE)


def snag(seed: int, stubs: int, top: float) -> Shape:
    """Model of a burned tree: a bare trunk, often broken, with stubs of branches."""
    random, shape = np.random.default_rng(seed), Shape()
    lean = random.normal(0.0, 0.02, 2)
    _trunk(shape, 0.016, lean, 5, top)
    for _ in range(stubs):
        z = random.uniform(0.25, 0.95) * top
        angle = random.uniform(0.0, 2.0 * np.pi)
        length = random.uniform(0.03, 0.11) * (1.15 - z)
        out = np.array([np.cos(angle), np.sin(angle), random.uniform(-0.5, 0.3)])
        root = np.array([lean[0] * z, lean[1] * z, z])
        side = np.array([-np.sin(angle), np.cos(angle), 0.0]) * 0.004
        lift = np.array([0.0, 0.0, 0.005])
        points = np.array([root - side, root + side, root + lift, root + out * length])
        shape.add(points, [(0, 1, 3), (1, 2, 3), (2, 0, 3)], _BARK)
    return shape


def grass(seed: int) -> Shape:
    """Model of a clump of grass and low shrubs, 1.6 m tall: 0.9 m shows where it stands 0.7 m deep."""
    random, shape = np.random.default_rng(seed), Shape()
    for _ in range(70):
        place = random.normal(0.0, 0.8, 2)
        tall = random.uniform(0.9, 1.6)
        bend = random.normal(0.0, 0.25, 2)
        angle = random.uniform(0.0, np.pi)
        side = np.array([np.cos(angle), np.sin(angle), 0.0]) * random.uniform(0.03, 0.09)
        foot = np.array([*place, 0.0])
        middle = foot + np.array([*(0.4 * bend), 0.6 * tall])
        tip = foot + np.array([*bend, tall])
        points = np.array([foot - side, foot + side, middle + 0.6 * side, middle - 0.6 * side, tip])
        shape.add(points, [(0, 1, 2, 3), (3, 2, 4)], _FOLIAGE)
    return shape


def trees() -> list[Shape]:
    """All tree models, in the order of their numbers."""
    living = [conifer(kind, 100 + k) for k, kind in enumerate(SPECIES)] + [oak(120), oak(121)]
    return [*living, snag(130, 30, 1.0), snag(131, 22, 0.85), snag(132, 14, 0.95)]


def clumps() -> list[Shape]:
    """All models of grass, in the order of their numbers."""
    return [grass(140 + k) for k in GRASS]
