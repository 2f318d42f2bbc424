"""Flames in the scene: on the front, within the budget, moving with the time."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.render import layers
from firetwin.scene import build
from firetwin.shot.shot import Shot


@pytest.fixture
def close(settings, run, stage, scene):
    """The scene at a moment when its camera is close to flames."""
    camera = settings.cameras[0]
    near = replace(camera.rig.keys[0], latitude=38.8395, height=150.0)
    settings = replace(settings, cameras=(replace(camera, rig=replace(camera.rig, keys=(near,))),))
    build.build(Shot(settings, run), scene)
    layers.build(settings, stage)
    scene.frame_set(2)
    return scene


def test_flames_light_the_picture_and_burn_in_the_thermal_layer(close, shoot):
    rgb, kelvin = shoot(close, "rgb"), shoot(close, "thermal")
    thing = bpy.data.objects["Firetwin Flames"]
    thing.hide_render = True
    assert np.max(rgb - shoot(close, "rgb")) > 0.5
    assert np.max(kelvin - shoot(close, "thermal")) > 100.0  # flames fill only a part of a pixel
    assert kelvin.max() <= 1501.0


def test_nothing_of_a_flame_is_colder_than_what_is_behind_it(close, shoot):
    """Neither its rims nor the gaps between its tongues dim the heat that comes through them."""
    bpy.data.objects["Firetwin Firebrands"].hide_render = True
    kelvin = shoot(close, "thermal")
    bpy.data.objects["Firetwin Flames"].hide_render = True
    assert np.min(kelvin - shoot(close, "thermal")) > -0.01
