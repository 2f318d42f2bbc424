from dataclasses import replace

import numpy as np
from firetwin.scene import build
from firetwin.shot.shot import Shot


def test_embers_glow_only_where_the_scene_file_wants_them(settings, run, stage, scene, shoot):
    no_flames = replace(settings, fire=replace(settings.fire, flames=False))
    pictures = []
    for embers in (True, False):
        built = build.build(Shot(replace(no_flames, fire=replace(no_flames.fire, embers=embers)), run), scene)
        built.frame_set(2)
        built.render.resolution_x, built.render.resolution_y = 320, 180
        pictures.append(shoot(built, "rgb"))
    assert np.all(pictures[0] >= pictures[1] - 1e-4)
    assert np.max(pictures[0] - pictures[1]) > 0.05
