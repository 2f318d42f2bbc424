"""Proxies of the viewport, and that no render shows them."""

import bpy
import numpy as np
from firetwin.render import layers
from firetwin.scene import build
from firetwin.scene.forest import preview
from firetwin.scene.terrain import solid_view
from firetwin.shot.shot import Shot


def test_renders_do_not_know_of_the_viewport(near_settings, run, stage, scene, shoot, monkeypatch):
    """Equal pixels with and without objects of the viewport, in the picture and in the thermal view."""
    pictures = []
    for most in (200, 10**9):
        monkeypatch.setattr(preview, "MOST", most)
        shot = Shot(near_settings, run)
        build.build(shot, scene)
        layers.build(near_settings, stage)
        scene.frame_set(2)
        if most > 200:
            data = bpy.data.objects["Firetwin Ground"].data
            data.attributes.remove(data.attributes[solid_view.NAME])
        pictures.append((shoot(scene, "rgb"), shoot(scene, "thermal")))
    assert pictures[0][0].std() > 0.01
    for one, other in zip(*pictures, strict=True):
        assert np.array_equal(one, other)
