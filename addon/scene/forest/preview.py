"""Viewport preview of the forest: fewer and wider trees, so that a frame change is fast.

Blender evaluates all instances of an object again when its nodes depend on time or camera: 0.6 us of CPU time
per tree. So the viewport hides a forest of more than `MOST` trees and shows proxies: one object for trees
that burn during the shot and turn into snags, and one for the rest, whose nodes depend on nothing. Renders
draw the full forest and no proxies.
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

MOST = 8000  # trees; a redraw takes a few ms
_WIDEST = 2.5  # width factor of a crown that stands for several
LEVEL = 2  # level of detail: cheap enough for thousands, still a tree

Points = dict[str, NDArray]


def parts(shot: Shot, points: Points, levelled: bool) -> Iterator[tuple[str, Points, bool]]:
    """Proxies of plants with these attributes: a name, attributes, and whether they depend on time.

    Empty for `MOST` plants or fewer. Models of `levelled` plants have levels of detail.
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
    """Collect the models of a library that these points use, and renumber the points' indices to them.

    Every model of a library costs 20 us of CPU time per frame, whether or not it is instanced.
    """
    both = ("model", "snag_model")
    kept, number = np.unique(np.concatenate([points[key] for key in both]), return_inverse=True)
    for key, values in zip(both, np.split(number, 2), strict=True):
        points[key] = values
    few = owned.library(f"Models of {title}")
    known = sorted(library.objects, key=lambda obj: obj.name)  # indices as the geometry nodes count them
    for k in kept:
        few.objects.link(known[int(k)])
    return few


def show_proxies(full: bpy.types.Object, shown: list[bpy.types.Object]) -> None:
    """Show these objects in the viewport in place of an object that renders draw."""
    full.hide_viewport = bool(shown)
    for obj in shown:
        obj.hide_render = True
