"""Lamps in place of flames: few, steady, for ground and trees alone, at night alone."""

import bpy
import numpy as np
from firetwin.blender import nodes
from firetwin.render import layers
from firetwin.scene import build
from firetwin.shot.shot import Shot


def built(settings, run, stage):
    """Build the whole scene with its view layers."""
    shot = Shot(settings, run)
    build.build(shot, stage.scene)
    layers.build(settings, stage)
    return shot


def lit():
    return [thing for thing in bpy.data.objects if thing.name.startswith("Firetwin Lamp")]


def alone(scene, lamps):
    """Leave these lamps the only light, in the second frame."""
    scene.frame_set(2)
    bpy.data.objects["Firetwin Sun"].hide_render = True
    bpy.data.objects["Firetwin Flames"].hide_render = True
    for node in scene.world.node_tree.nodes:
        if node.type == "BACKGROUND":
            node.inputs["Strength"].default_value = 0.0
    for tree in bpy.data.node_groups:
        for node in tree.nodes:
            if node.type == "EMISSION":
                strength = node.inputs["Strength"]
                for link in strength.links:
                    tree.links.remove(link)
                strength.default_value = 0.0
    assert lamps


def test_they_come_so_gradually_that_the_first_light_cannot_be_seen(near, run, stage, scene, sun_at, shoot):
    """A degree under the sun that ends them, no pixel gets a 255th of white from lamps; by night many do."""
    brightest = []
    for height in (5.0, -20.0):
        sun_at(height)
        built(near, run, stage)
        alone(scene, lit())
        brightest.append(np.max(shoot(scene, "rgb")))
    assert lit()
    assert brightest[0] < 1.0 / 255.0 < brightest[1]


def test_lamps_and_near_flames_light_the_ground_and_leave_temperatures_alone(
    near, run, stage, scene, sun_at, shoot
):
    sun_at(-20.0)
    built(near, run, stage)
    scene.frame_set(2)
    kelvin, light = shoot(scene, "thermal"), shoot(scene, "rgb")
    for thing in (*lit(), bpy.data.objects["Firetwin Flame Light"]):
        thing.hide_render = True
    assert np.array_equal(kelvin, shoot(scene, "thermal"))
    assert np.mean(light - shoot(scene, "rgb")) > 3.0e-4
    assert scene.view_layers["thermal"][nodes.THERMAL] == 1.0
