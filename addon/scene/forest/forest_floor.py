"""Models of the forest floor: logs, rocks, tufts of grass, fallen twigs and burned brush.

Models are a metre tall, as trees are; the height of a log is its diameter. Shapes and numbers are chosen by
eye.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .branching import grown
from .habit import Habit
from .shape import BARK, FOLIAGE, Array, Shape

_DEAD_WOOD = (0.085, 0.068, 0.052)  # weathered
_OLD_BARK, _FRESH_BARK = (0.120, 0.075, 0.048), (0.300, 0.225, 0.155)
_STRAW = (0.150, 0.118, 0.058)
_STONE = (0.16, 0.155, 0.145)
_TURNS = (4, 3, 2, 1)  # by level of detail 0 to 3: subdivisions of a rock's faces
_GOLDEN = 2.399963  # rad


def log(seed: int, level: int) -> Shape:
    """Model a fallen trunk along x, 12 to 20 times as long as thick, a little crooked, with stubs."""
    random, shape = np.random.default_rng(seed), Shape()
    length, sides = random.uniform(12.0, 20.0), (11, 9, 7, 5)[level]
    at = np.linspace(-0.5, 0.5, (9, 7, 5, 3)[level]) * length
    thick = 0.5 - 0.20 * (at / length + 0.5) + 0.03 * np.sin(5.0 * at / length + seed)
    ends = np.array([at[0] - 0.02, *at, at[-1] + 0.02])  # closed by rings of radius zero
    bend = 0.35 * np.sin(2.2 * ends / length + random.uniform(0.0, 6.0))
    up = np.interp(ends, at, thick) - 0.10 + 0.05 * np.cos(3.0 * ends / length)
    way = np.stack([ends, bend, up], axis=-1)
    shape.limbs(way[None], np.array([[0.01, *thick, 0.01]]), sides, _DEAD_WOOD)
    if level < 3:
        n = (14, 10, 6)[level]
        foot = random.uniform(-0.45, 0.45, n) * length
        turn = random.uniform(0.1, np.pi - 0.1, n)  # no stub goes into the ground
        ahead = np.stack([0.4 * np.ones(n), np.cos(turn), np.sin(turn)], axis=-1)
        root = np.stack([foot, np.interp(foot, ends, bend), np.interp(foot, ends, up)], axis=-1)
        reach = random.uniform(0.6, 2.0, (n, 1, 1))
        shape.limbs(
            root[:, None] + ahead[:, None] * reach * np.array([0.2, 1.0])[None, :, None],
            np.broadcast_to([0.07, 0.03], (n, 2)),
            3,
            _DEAD_WOOD,
        )
    return shape


def rock(seed: int, level: int) -> Shape:
    """Model a boulder: a rough ball split along three sets of joints; a quarter of it is below ground."""
    random, shape = np.random.default_rng(seed), Shape()
    points, faces = _ball(_TURNS[level])
    points = points * (1.0 + _lumps(random, points, 2.2, 0.04))[:, None]
    for normal in _joints(random):
        over = np.maximum(points @ normal - random.uniform(0.42, 0.90), 0.0)
        points = points - over[:, None] * normal
    for frequency, depth in ((9.0, 0.012), (21.0, 0.006)):
        points = points * (1.0 + _lumps(random, points, frequency, depth))[:, None]
    points *= random.uniform([0.8, 0.6, 0.5], [1.2, 1.0, 0.75])
    low, high = points[:, 2].min(), points[:, 2].max()
    points[:, 2] -= low + 0.25 * (high - low)
    shape.add(points, faces, BARK, _STONE)
    return shape.scaled(float(points[:, 2].max()))


def _joints(random: np.random.Generator) -> Array:
    """Return unit normals (18, 3) of the planes that split granite: three directions and breaks across."""
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    sets = np.repeat(np.concatenate([axes, -axes]), 2, axis=0) + random.normal(0.0, 0.16, (12, 3))
    normals = np.concatenate([sets, random.normal(size=(6, 3))])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _lumps(random: np.random.Generator, points: Array, frequency: float, depth: float) -> Array:
    """Return relative heights (n,) of waves in six directions over points (n, 3)."""
    waves = random.normal(0.0, frequency, (6, 3))
    return depth * np.sin(points @ waves.T + random.uniform(0.0, 6.0, 6)).sum(1)


def tuft(seed: int, level: int, burned: bool = False) -> Shape:
    """Model a bunch of dry grass; burned, its black stubble: few short stalks, scattered."""
    random, shape = np.random.default_rng(seed), Shape()
    n, wider = ((70, 1.0), (48, 1.3), (24, 1.9), (10, 3.0))[level]
    if burned:
        n, wider = n // 3, 0.8 * wider
    angle = _GOLDEN * np.arange(n) + random.normal(0.0, 0.3, n)
    out = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
    tall = random.uniform(*((0.03, 0.22) if burned else (0.45, 1.0)), (n, 1))
    lean = random.uniform(0.1, 0.8, (n, 1)) * tall
    foot = out * random.uniform(0.02, 0.60 if burned else 0.22, (n, 1))
    side = np.cross(out, [0.0, 0.0, 1.0]) * (0.016 * wider) * random.uniform(0.7, 1.3, (n, 1))
    rise = np.array([0.0, 0.0, 1.0])
    middle = foot + 0.35 * lean * out + 0.6 * tall * rise
    points = np.stack([foot - side, foot + side, middle + side, middle - side], axis=1)
    tip = foot + lean * out + tall * (1.0 - 0.25 * lean) * rise
    points = np.concatenate([points, tip[:, None]], axis=1)
    faces = (np.arange(n)[:, None, None] * 5 + np.array([(0, 1, 2), (0, 2, 3), (3, 2, 4)])).reshape(-1, 3)
    colour = np.array(_STRAW) * random.uniform(0.6, 1.3, (n, 1))
    shape.add(points.reshape(-1, 3), faces, FOLIAGE, np.repeat(colour, 5, axis=0))
    return shape.scaled(1.0 if burned else float(tip[:, 2].max()))


def stubble(seed: int, level: int) -> Shape:
    """Burned remains of a tuft."""
    return tuft(seed, level, burned=True)


def twigs(seed: int, level: int) -> Shape:
    """Fallen twigs and small branches, eight times as wide as tall."""
    random, shape, n = np.random.default_rng(seed), Shape(), (26, 20, 12, 6)[level]
    middle, half = _scattered(random, n, 1.9, 0.3, 0.25, 0.1)
    bend = random.normal(0.0, 0.12, (n, 3)) * [1.0, 1.0, 0.3]
    way = np.stack([middle - half, middle + bend, middle + half], axis=1)
    way[..., 2] = np.maximum(way[..., 2], 0.0)
    thick = random.uniform(0.05, 0.14, (n, 1)) * (26.0 / n) ** 0.5 * np.array([1.0, 0.8, 0.5])
    shape.limbs(way, thick, 3, _DEAD_WOOD)
    return shape.scaled(float(way[..., 2].max() + 0.05))


def bark_strips(seed: int, level: int) -> Shape:
    """Model strips of bark that eucalypts shed: long and curled, some pale, wider than tall."""
    random, shape, n = np.random.default_rng(seed), Shape(), (22, 16, 10, 5)[level]
    middle, half = _scattered(random, n, 1.7, 0.25, 0.15, 0.2)
    bend = random.normal(0.0, 0.30, (n, 3)) * [1.0, 1.0, 0.5]
    way = np.stack([middle - half, middle - 0.3 * half + bend, middle + 0.4 * half, middle + half], axis=1)
    way[..., 2] = np.maximum(way[..., 2], 0.0)
    thick = random.uniform(0.08, 0.22, (n, 1)) * (22.0 / n) ** 0.5 * np.array([0.5, 1.0, 0.9, 0.3])
    dark = random.uniform(0.0, 1.0, n) < 0.5
    for chosen, colour in ((dark, _OLD_BARK), (~dark, _FRESH_BARK)):
        if chosen.any():
            shape.limbs(way[chosen], thick[chosen], 2, colour)
    return shape.scaled(float(way[..., 2].max() + 0.05))


def _scattered(
    random: np.random.Generator, n: int, spread: float, high: float, rise: float, length: float
) -> tuple[Array, Array]:
    """Scatter pieces of wood on the floor: their middles (n, 3), and half of each (n, 3) along it.

    Parameters
    ----------
    spread, high
        Standard deviation of their places, and the greatest height of a middle.
    rise, length
        Greatest slope, and mean logarithm of half the length.
    """
    angle = random.uniform(0.0, 2.0 * np.pi, n)
    middle = np.column_stack([random.normal(0.0, spread, (n, 2)), random.uniform(0.02, high, n)])
    half = np.stack([np.cos(angle), np.sin(angle), random.uniform(0.0, rise, n)], axis=-1)
    return middle, half * random.lognormal(length, 0.5, (n, 1))


def burned_brush(habit: Habit, seed: int, level: int) -> Shape:
    """Burned remains of a bush: thin black stems, as twigs and leaves are gone."""
    limbs, leaves = grown(habit, seed)
    shape, height = Shape(), float(leaves.corners()[..., 2].max())
    kept = np.arange(0, len(limbs.root), (1, 1, 2, 4)[level])
    steps = np.broadcast_to([0.0, 0.45, 0.85], (len(limbs.root), 3))
    thick = (0.007 + 0.006 * limbs.length[:, None]) * (1.1 - steps) * (1.0, 1.0, 1.5, 2.5)[level]
    shape.limbs(limbs.at(steps)[kept], thick[kept], 3 if level < 2 else 2, habit.wood)
    return shape.scaled(height)


def _ball(turns: int) -> tuple[Array, NDArray[np.int64]]:
    """Points (n, 3) and triangles (m, 3) of a sphere: an octahedron subdivided `turns` times."""
    points = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)], float)
    a, b, c, d, e, f = range(6)
    faces = np.array([(a, b, c), (b, d, c), (d, e, c), (e, a, c), (b, a, f), (d, b, f), (e, d, f), (a, e, f)])
    for _ in range(turns):
        edges = np.sort(faces[:, [(0, 1), (1, 2), (2, 0)]].reshape(-1, 2), axis=1)
        known, number = np.unique(edges, axis=0, return_inverse=True)
        middle = points[known].sum(axis=1)
        x, y, z = (number.reshape(-1, 3) + len(points)).T
        points = np.concatenate([points, middle / np.linalg.norm(middle, axis=1, keepdims=True)])
        i, j, k = faces.T
        parts = ((i, x, z), (x, j, y), (z, y, k), (x, y, z))
        faces = np.concatenate([np.stack(part, axis=-1) for part in parts])
    return points, faces
