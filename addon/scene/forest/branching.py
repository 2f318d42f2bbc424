"""Procedural trees: branches on a trunk, sprays on branches, leaves (or clumps of needles) on sprays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .habit import Habit
from .shape import Array, Shape

_DARK, _FRESH = 0.55, 1.25  # colour of leaves near the trunk and at the tips, against the habit's
_FAN = 0.55  # rad between the outermost needles of a tuft and its middle
_FULL = 1.22  # area of a tuft's needles / its leaf, which gives the crown the same cover (measured)


@dataclass(frozen=True)
class Limbs:
    """Limbs of a tree, b of them: base (b, 3), length (b,), direction at the base (b, 3), bend up (b,)."""

    root: Array
    length: Array
    ahead: Array
    lift: Array

    def at(self, s: Array) -> Array:
        """Points (b, k, 3) at fractions s (b, k) of the limbs' lengths."""
        place = self.root[:, None] + self.ahead[:, None] * (s * self.length[:, None])[..., None]
        place[..., 2] += self.lift[:, None] * self.length[:, None] * s**2
        return place


@dataclass(frozen=True)
class Leaves:
    """Leaves, n of them, ordered by limb: centre, half length, half width (n, 3) m; colour (n, 3)."""

    middle: Array
    along: Array
    across: Array
    colour: Array
    limb: NDArray[np.int64]

    def corners(self) -> Array:
        """Corners (n, 3, 3) of one triangle per leaf, with its tip at the base."""
        tip = self.middle + self.along
        return np.stack([self.middle - self.along, tip + self.across, tip - self.across], axis=1)

    def needles(self, count: int) -> Array:
        """Corners (n, count, 3, 3) of pointed triangles in a tuft per leaf, with the leaf's cover."""
        long = np.linalg.norm(self.along, axis=-1, keepdims=True)
        flat = _unit(self.across)
        normal = _unit(np.cross(self.along, flat))
        foot = (self.middle - self.along)[:, None]
        turn = 2.399963 * (np.arange(count) + np.arange(len(long))[:, None])
        ring = np.cos(turn)[..., None] * flat[:, None] + np.sin(turn)[..., None] * normal[:, None]
        tilt = _FAN * np.sqrt((np.arange(count) + 0.5) / count)[:, None]
        tip = foot + 2.0 * np.cos(tilt) * self.along[:, None] + 2.0 * np.sin(tilt) * long[:, None] * ring
        side = _unit(np.cross(tip - foot, ring + 0.3 * normal[:, None])) * (
            np.linalg.norm(self.across, axis=-1)[:, None, None] * _FULL / count
        )
        return np.stack([foot - side, foot + side, tip], axis=2)


@lru_cache(maxsize=1)  # the levels of detail of a tree are generated one after the other
def grown(habit: Habit, seed: int) -> tuple[Limbs, Leaves]:
    """Branches of a tree about a metre tall, and its leaves."""
    random = np.random.default_rng(seed)
    limbs = _branches(habit, random)
    return limbs, _leaves(habit, limbs, random)


def _branches(habit: Habit, random: np.random.Generator) -> Limbs:
    """Living branches from the crown's base to its leader, which is the last."""
    n = habit.branches
    even = (np.arange(n) + random.uniform(0.0, 1.0, n)) / n
    rings = np.floor(even * n / 5.0) * 5.0 / n
    up = np.clip(even + habit.whorled * 0.8 * (rings - even), 0.0, 0.985)
    profile = (up + 0.02) ** habit.low * (1.0 - up) ** habit.high
    grid = np.linspace(0.0, 1.0, 101)
    profile /= ((grid + 0.02) ** habit.low * (1.0 - grid) ** habit.high).max()
    side = 1.0 + 0.12 * np.sin(2.399963 * np.arange(n) + random.uniform(0.0, 6.0))
    length = habit.radius * profile * side * np.exp(random.normal(0.0, habit.irregular, n))
    length = np.clip(length, 0.12 * habit.radius, 1.35 * habit.radius)
    angle = 2.399963 * np.arange(n) + random.normal(0.0, 0.35, n)
    rise = np.radians(habit.rise[0] + (habit.rise[1] - habit.rise[0]) * up**1.2 + random.normal(0.0, 7.0, n))
    ahead = np.stack([np.cos(rise) * np.cos(angle), np.cos(rise) * np.sin(angle), np.sin(rise)], axis=-1)
    root = np.zeros((n, 3))
    root[:, 2] = habit.bare + (habit.top - habit.bare) * up
    lift = habit.lift + random.normal(0.0, 0.05, n)
    if habit.top > 0.9:  # the leader
        ahead[-1], root[-1], length[-1], lift[-1] = (0.0, 0.0, 1.0), (0.0, 0.0, 0.90), 0.10, 0.0
    return Limbs(root, length, ahead, lift)


def _leaves(habit: Habit, limbs: Limbs, random: np.random.Generator) -> Leaves:
    b, k, m = len(limbs.root), habit.sprays, habit.leaves
    s = habit.inner + (1.0 - habit.inner) * (np.arange(k) + random.uniform(0.0, 1.0, (b, k))) / k
    foot = limbs.at(s)
    ahead = limbs.at(s + 0.01) - limbs.at(s - 0.01)
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    side = _unit(np.cross(ahead, [0.0, 0.02, 1.0]))
    over = np.cross(side, ahead)
    hand = np.where(np.arange(k) % 2 == 0, 1.0, -1.0)
    turn = hand * np.radians(random.uniform(30.0, 70.0, (b, k))) * (1.0 - 0.7 * s**4)
    spray = np.cos(turn)[..., None] * ahead + np.sin(turn)[..., None] * side
    spray = _unit(spray + random.normal(0.0, 0.30 * habit.spread[1], (b, k, 1)) * over)
    reach = limbs.length[:, None] * 0.42 * (1.15 - s) * random.uniform(0.7, 1.3, (b, k)) + 0.4 * habit.size[0]
    t = random.uniform(0.10, 1.0, (b, k, m))
    aside = random.normal(0.0, habit.spread[0], (b, k, m, 1))
    upward = random.normal(0.0, habit.spread[1], (b, k, m, 1))
    lie = np.cross(spray, over)
    along = _unit(
        spray[:, :, None] + aside * lie[:, :, None] + upward * over[:, :, None] - [0.0, 0.0, habit.hang]
    )
    size = habit.size[0] * random.uniform(0.7, 1.3, (b, k, m, 1))
    middle = foot[:, :, None] + spray[:, :, None] * (reach[..., None] * t)[..., None] + 0.5 * size * along
    flat = np.cross(along, over[:, :, None] + random.normal(0.0, habit.spread[1], (b, k, m, 3)))
    across = _unit(flat) * (0.5 * habit.size[1])
    outer = np.clip(0.55 * s[..., None] + 0.45 * t, 0.0, 1.0)
    bright = _DARK + (_FRESH - _DARK) * outer + random.normal(0.0, 0.10, outer.shape)
    colour = np.array(habit.colour) * np.maximum(bright, 0.2)[..., None]
    limb = np.broadcast_to(np.arange(b)[:, None, None], (b, k, m))
    return Leaves(
        middle.reshape(-1, 3),
        (0.5 * size * along).reshape(-1, 3),
        across.reshape(-1, 3),
        colour.reshape(-1, 3),
        limb.ravel(),
    )


def _unit(vector: Array) -> Array:
    return vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1.0e-12)


def wood(shape: Shape, habit: Habit, limbs: Limbs, level: int, random: np.random.Generator) -> None:
    """Trunk, branches (levels of detail 0 and 1) and dead branches (level 0)."""
    chosen = [0, 1, 2, 3, 4, 5] if level < 2 else [0, 3, 5]
    heights = np.array([-0.03, 0.02, 0.25, 0.55, 0.80, 1.0])[chosen] * habit.top
    width = habit.stem * np.array([1.7, 1.05, 0.85, 0.60, 0.30, 0.08])[chosen]
    way = np.column_stack([np.zeros((len(heights), 2)), heights])
    shape.limbs(way[None], width[None], (7, 4, 3, 2)[level], habit.wood)
    if level > 1:
        return
    steps = np.broadcast_to([0.0, 0.4, 0.95] if level == 0 else [0.0, 0.9], (len(limbs.root), 3 - level))
    thick = (0.09 * habit.stem + 0.009 * limbs.length[:, None]) * (1.08 - steps)
    shape.limbs(limbs.at(steps), thick, 3 - level, habit.wood)
    if habit.dead and level == 0:
        red, green, blue = habit.wood
        shape.limbs(*dead(habit, random), 3, (0.9 * red, 0.9 * green, 0.9 * blue))


def dead(habit: Habit, random: np.random.Generator) -> tuple[Array, Array]:
    """Polylines (n, 3, 3) and radii (n, 3) of dead branches below the crown, which hang and break."""
    n = habit.dead
    angle = 2.399963 * np.arange(n) + random.normal(0.0, 0.5, n)
    rise = np.radians(random.normal(-14.0, 12.0, n))
    ahead = np.stack([np.cos(rise) * np.cos(angle), np.cos(rise) * np.sin(angle), np.sin(rise)], axis=-1)
    root = np.zeros((n, 3))
    root[:, 2] = random.uniform(0.25 * habit.bare, 1.15 * habit.bare, n)
    limbs = Limbs(root, habit.radius * random.uniform(0.15, 0.60, n), ahead, random.normal(-0.15, 0.1, n))
    steps = np.broadcast_to([0.0, 0.5, 1.0], (n, 3))
    return limbs.at(steps), 0.10 * habit.stem * (1.15 - steps)
