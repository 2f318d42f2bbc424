"""Culling and level of detail leave the picture as it is without them."""

from dataclasses import replace

import bpy
import numpy as np
from firetwin.blender import owned
from firetwin.scene import build
from firetwin.shot.shot import Shot


def test_the_picture_is_that_of_all_there_is(settings, run, shoot):
    """With the same grain the difference is less than half of what another grain makes."""

    def picture(cull: bool, seed: int) -> np.ndarray:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        changed = replace(settings, render=replace(settings.render, cull=cull, seed=seed))
        build.build(Shot(changed, run), scene)
        owned.adopt(scene)
        scene.frame_set(2)
        scene.cycles.seed = seed
        return shoot(scene)

    whole, grain, some = picture(False, 0), picture(False, 1), picture(True, 0)
    off = [np.abs(each - whole) / (whole.mean() + whole) for each in (grain, some)]
    assert off[1].mean() < 0.5 * off[0].mean()
