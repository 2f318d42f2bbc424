"""The forest as the viewport shows it: some of its trees, made wider, so that a frame change costs little.

Blender makes all instances of an object again whenever its nodes depend on time or camera: 0.6 us of the
processor for each tree. So a forest of more than `MOST` trees is hidden in the viewport, where others stand
in: those that burn during the shot, which become snags, and the rest, whose nodes depend on nothing.
Renders draw the forest and none of these.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import owned
from ...shot.shot import Shot
from ...shot.terrain import noise
from . import models
from .levels import LEVELS
from .material import TORCHING

MOST = 8000  # trees; what redraws in a few ms
_WIDEST = 2.5  # times its width, that a crown stands for others
LEVEL = 2  # coarse enough for thousands, still a tree

Points = dict[str, NDArray]


def parts(shot: Shot, points: Points, levelled: bool) -> Iterator[tuple[str, Points, bool]]:
    """What stands in for plants with these attributes: a name, attributes, and whether it follows time.

    Nothing where there are no more than `MOST`. Of plants that are `levelled`, models have levels.
    """
    count = len(points["position"])
    if count <= MOST:
        return
    chance = noise.uniform(np.arange(count), 0, shot.settings.seed + 900)
    kept = np.flatnonzero(chance < MOST / count)
    some = {key: values[kept] for key, values in points.items()}
    some["width"] = some["width"] * min(np.sqrt(count / MOST), _WIDEST)
    for key in ("model", "snag_model") if levelled else ():
        model, level = np.divmod(some[key], LEVELS)
        some[key] = models.instance(model, np.maximum(level, LEVEL))
    bare = some["arrival_time"] + TORCHING
    turns = (bare > shot.frames.first) & (bare <= shot.frames.last)
    some["model"] = np.where(bare <= shot.frames.first, some["snag_model"], some["model"])
    for name, chosen in (("Burning", turns), ("", ~turns)):
        if chosen.any():
            yield name, {key: values[chosen] for key, values in some.items()}, bool(name)


def used(title: str, library: bpy.types.Collection, points: Points) -> bpy.types.Collection:
    """Those models of a library that these points have, by which their numbers are changed to count.

    Every model of a library costs 20 us of the processor in each frame, whether it stands anywhere or not.
    """
    both = ("model", "snag_model")
    kept, number = np.unique(np.concatenate([points[key] for key in both]), return_inverse=True)
    for key, values in zip(both, np.split(number, 2), strict=True):
        points[key] = values
    few = owned.library(f"Models of {title}")
    known = sorted(library.objects, key=lambda thing: thing.name)  # as the nodes number them
    for k in kept:
        few.objects.link(known[int(k)])
    return few


def stand_in(full: bpy.types.Object, shown: list[bpy.types.Object]) -> None:
    """Have the viewport show these in place of an object that renders draw."""
    full.hide_viewport = bool(shown)
    for thing in shown:
        thing.hide_render = True
