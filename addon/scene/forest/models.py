"""Plant models, a metre tall: ten conifers of Algorithm 2, oaks, snags, brush, forest floor and grass.

Trees and bushes of biomes other than the Sierra's come last. Each model has its own seed, so a scene's trees
are always the same. The levels of detail of a model are the same tree with fewer triangles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from . import forest_floor, leaf_season, levels, species
from . import habit as habits
from .branching import dead, grown, wood
from .habit import Habit
from .phenology import LeafState
from .shape import FOLIAGE, Shape

FIRST_MODEL = {2: 0, 1: 2, 0: 6}  # size class of Algorithm 2 (LARGE 2, MEDIUM 1, SMALL 0) -> its first model
OAKS = (10, 11)
SNAGS = (12, 13, 14)
BRUSH = (15, 16)
BURNED_BRUSH, LOGS, ROCKS, TUFTS, STUBBLE, TWIGS = (
    (17, 18),
    (19, 20),
    (21, 22, 23),
    (24, 25),
    (26, 27),
    (28, 29),
)
HOLM_OAKS, LIVE_OAKS, STONE_PINES, SPRUCES, PINES, BIRCHES, MAQUIS, BURNED_MAQUIS, ACACIAS = (
    (30, 31),
    (32, 33),
    (34, 35),
    (36, 37),
    (38, 39),
    (40, 41),
    (42, 43, 44),
    (45, 46, 47),
    (48, 49),
)
EUCALYPTS, LARCHES, BEECHES, MAPLES, CROP_PINES, RAINFOREST_TREES, BARK_STRIPS = (
    (50, 51, 52),
    (53, 54),
    (55, 56),
    (57, 58),
    (59, 60),
    (61, 62, 63),
    (64, 65),
)
KINDS = (
    "large",
    "medium",
    "small",
    "oak",
    "brush",
    "log",
    "rock",
    "tuft",
    "twigs",
    "pine",
    "spruce",
    "birch",
)
GRASS = (0, 1)
REACH = 0.68  # in tree heights: radius of a model's bounding sphere
_LEAVES = 1500  # of level 1
_LATE = 0.5  # fraction of the season by which every second model of a species turns later (by eye)


@dataclass(frozen=True)
class TreeModel:
    """A model: its class, one of `KINDS`, its state ("living" or "snag"), and its generator of levels.

    `habit` is the habit of a deciduous tree; None for other models. Its leaves turn `late`, by a fraction
    0..1 of the season.
    """

    kind: str
    state: str
    make: Callable[[int], Shape]
    habit: Habit | None = None
    late: float = 0.0

    def in_season(self, level: int, state: LeafState) -> Shape:
        """Model a level of detail with the leaves of the season."""
        shape = self.make(level)
        if self.habit is None or self.habit.autumn is None:
            return shape
        turned, fallen = (max((part - self.late) / (1.0 - self.late), 0.0) for part in state)
        return leaf_season.dressed(shape, self.habit.colour, self.habit.autumn, LeafState(turned, fallen))


def tree(habit: Habit, seed: int, level: int) -> Shape:
    """Model a living tree in a level of detail."""
    limbs, leaves = grown(habit, seed)
    corners, parts = leaves.corners(), 1
    if level == 0 and habit.needles > 1:
        corners, parts = leaves.needles(habit.needles).reshape(-1, 3, 3), habit.needles
    height = float(corners[..., 2].max())
    shape, random = Shape(), np.random.default_rng(seed + 1)
    wood(shape, habit, limbs, level, random)
    if level == 0:
        shape.leaves(corners, np.repeat(leaves.colour, parts, axis=0))
    elif level == 1:
        levels.some(shape, leaves, _LEAVES, habit.fit[0])
    else:
        groups = leaves.limb if level == 2 else levels.slabs(leaves)
        levels.fans(shape, leaves, groups, habit.fit[level - 1])
    return shape.scaled(height)


def snag(habit: Habit, seed: int, stubs: int, top: float, level: int) -> Shape:
    """Model a burned tree (snag): a bare trunk, often broken, with stubs of branches."""
    random, shape = np.random.default_rng(seed), Shape()
    heights = np.array([-0.03, 0.02, 0.30 * top, 0.65 * top, top])[:: (1, 1, 2, 4)[level]]
    lean = random.normal(0.0, 0.02, 2)
    way = np.column_stack([lean[0] * heights**2, lean[1] * heights**2, heights])
    width = habit.stem * np.clip(1.25 - 1.05 * np.maximum(heights, 0.0), 0.18, None)
    shape.limbs(way[None], width[None], (7, 4, 3, 2)[level], habit.wood)
    if level < 3:
        many = (stubs, stubs, stubs // 2)[level]
        ways, thick = dead(replace(habit, dead=many, bare=0.9 * top), random)
        step = 1 if level == 0 else 2
        shape.limbs(ways[:, ::step], thick[:, ::step] * (1.6, 1.8, 2.4)[level], (3, 2, 2)[level], habit.wood)
    return shape


def grass(seed: int) -> Shape:
    """Model a clump of grass and low shrubs, 1.6 m tall: 0.7 m below and 0.9 m above ground."""
    random, shape, n = np.random.default_rng(seed), Shape(), 70
    foot = np.concatenate([random.normal(0.0, 0.8, (n, 2)), np.zeros((n, 1))], axis=1)
    tall, angle = random.uniform(0.9, 1.6, n), random.uniform(0.0, np.pi, n)
    bend = np.column_stack([random.normal(0.0, 0.25, (n, 2)), tall])
    side = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1) * random.uniform(0.03, 0.09, (n, 1))
    middle = foot + bend * [0.4, 0.4, 0.6]
    points = np.stack(
        [foot - side, foot + side, middle + 0.6 * side, middle - 0.6 * side, foot + bend], axis=1
    )
    faces = (np.arange(n)[:, None, None] * 5 + np.array([(0, 1, 2), (0, 2, 3), (3, 2, 4)])).reshape(-1, 3)
    shape.add(points.reshape(-1, 3), faces, FOLIAGE, (0.11, 0.09, 0.04))
    return shape


def _conifers() -> list[tuple[str, Habit]]:
    """Conifers in the order of Algorithm 2: two LARGE, four MEDIUM, four SMALL."""
    return [
        ("large", habits.SUGAR_PINE),
        ("large", habits.PONDEROSA),
        ("medium", habits.PONDEROSA),
        ("medium", habits.WHITE_FIR),
        ("medium", habits.INCENSE_CEDAR),
        ("medium", habits.RED_FIR),
        ("small", habits.YOUNG_FIR),
        ("small", habits.YOUNG_PINE),
        ("small", habits.INCENSE_CEDAR),
        ("small", habits.WHITE_FIR),
    ]


def trees() -> list[TreeModel]:
    """All models of trees, in the order of their indices."""
    living = [*_conifers(), ("oak", habits.BLACK_OAK), ("oak", habits.BLACK_OAK)]
    snags = [(habits.SUGAR_PINE, 34, 1.0), (habits.WHITE_FIR, 26, 0.85), (habits.INCENSE_CEDAR, 20, 0.95)]
    brush = [habits.MANZANITA, habits.CEANOTHUS]
    return [
        *(_living(kind, habit, 100 + k) for k, (kind, habit) in enumerate(living)),
        *(
            TreeModel(kind, "snag", partial(snag, habit, 130 + k, stubs, top))
            for k, (kind, (habit, stubs, top)) in enumerate(zip(KINDS, snags, strict=False))
        ),
        *(TreeModel("brush", "living", partial(tree, habit, 150 + k)) for k, habit in enumerate(brush)),
    ]


def undergrowth() -> list[TreeModel]:
    """Models of the understorey and forest floor, in the order of their indices, which follow the trees'."""
    brush = [(habits.MANZANITA, 150), (habits.CEANOTHUS, 151)]  # the seeds of the living ones
    return [
        *(
            TreeModel("brush", "snag", partial(forest_floor.burned_brush, habit, seed))
            for habit, seed in brush
        ),
        *(TreeModel("log", "living", partial(forest_floor.log, 160 + k)) for k in range(len(LOGS))),
        *(TreeModel("rock", "living", partial(forest_floor.rock, 170 + k)) for k in range(len(ROCKS))),
        *(TreeModel("tuft", "living", partial(forest_floor.tuft, 180 + k)) for k in range(len(TUFTS))),
        *(TreeModel("tuft", "snag", partial(forest_floor.stubble, 180 + k)) for k in range(len(STUBBLE))),
        *(TreeModel("twigs", "living", partial(forest_floor.twigs, 190 + k)) for k in range(len(TWIGS))),
    ]


def elsewhere() -> list[TreeModel]:
    """Trees and bushes of biomes other than the Sierra's, in the order of their indices, which come last."""
    kinds = (
        *(("oak", species.HOLM_OAK), ("oak", species.LIVE_OAK), ("pine", species.STONE_PINE)),
        *(("spruce", species.SPRUCE), ("pine", species.SCOTS_PINE), ("birch", species.BIRCH)),
    )
    brush = (species.LENTISK, species.CISTUS, species.TREE_HEATH)
    high = [each for each in kinds for _ in range(2)]
    more = [
        *(("oak", species.EUCALYPT), ("oak", species.EUCALYPT), ("oak", species.STRINGYBARK)),
        *[("spruce", species.LARCH)] * 2,
        *[("oak", species.BEECH)] * 2,
        *[("oak", species.MAPLE)] * 2,
        *[("pine", species.CROP_PINE)] * 2,
        *(("oak", species.LAUREL), ("oak", species.LAUREL), ("oak", species.KAPOK)),
    ]
    return [
        *(_living(kind, habit, 200 + k) for k, (kind, habit) in enumerate(high)),
        *(TreeModel("brush", "living", partial(tree, habit, 220 + k)) for k, habit in enumerate(brush)),
        *(
            TreeModel("brush", "snag", partial(forest_floor.burned_brush, habit, 220 + k))
            for k, habit in enumerate(brush)
        ),
        *(_living("oak", species.ACACIA, 230 + k) for k in range(len(ACACIAS))),
        *(_living(kind, habit, 240 + k) for k, (kind, habit) in enumerate(more)),
        *(TreeModel("twigs", "living", partial(forest_floor.bark_strips, 260 + k)) for k in range(2)),
    ]


def _living(kind: str, habit: Habit, seed: int) -> TreeModel:
    if habit.autumn is None:
        return TreeModel(kind, "living", partial(tree, habit, seed))
    return TreeModel(kind, "living", partial(tree, habit, seed), habit, _LATE * (seed % 2))


def every() -> list[TreeModel]:
    """All models of the forest except Algorithm 2's grass, in the order of their indices."""
    return [*trees(), *undergrowth(), *elsewhere()]


def instance(model: NDArray[np.int64], level: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index in the collection of instances of models (n,) in levels (n,)."""
    return model * levels.LEVELS + level


def clumps() -> list[Shape]:
    """All models of grass, in the order of their indices."""
    return [grass(140 + k) for k in GRASS]
