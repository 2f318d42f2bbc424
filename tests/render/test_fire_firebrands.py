"""Firebrands: launched by the flames, flown by the core, drawn by geometry nodes at any time."""

import bpy
import numpy as np
from firetwin.render import layers
from firetwin.scene import build
from firetwin.shot.shot import Shot


def test_they_glow_and_are_warm(close, run, stage, scene, shoot):
    build.build(Shot(close, run), scene)
    layers.build(close, stage)
    scene.frame_set(12)
    for thing in bpy.data.objects:
        thing.hide_render = thing.type in ("MESH", "LIGHT") and thing.name != "Firetwin Firebrands"
    for node in scene.world.node_tree.nodes:
        if node.type == "BACKGROUND":
            node.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
            for link in node.inputs["Color"].links:
                scene.world.node_tree.links.remove(link)
    rgb, kelvin = shoot(scene, "rgb"), shoot(scene, "thermal")
    assert np.all(rgb[..., 0] >= rgb[..., 2])
    assert 1.0e-4 < np.max(rgb) < 100.0  # in pixels of 6 m
    assert 0.005 < kelvin.max() <= 1300.0  # times their share of such pixels
