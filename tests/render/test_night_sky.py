"""The night sky in a picture: stars and moon where an ephemeris has them, and the moon lit from the sun."""

from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
from firetwin.run import sun, times
from firetwin.scene.light import build as light
from firetwin.shot.shot import Shot
from mathutils import Vector


@pytest.fixture
def look(settings, run, stage, scene, shoot):
    """look(moment, direction, degrees): the sky around a direction, 32 x 32 pixels."""

    def make(moment, toward, wide):
        film = replace(settings, time=replace(settings.time, start=moment, end=None, frames=1))
        light.build(Shot(film, run), stage)
        camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
        scene.collection.objects.link(camera)
        camera.rotation_mode = "QUATERNION"
        camera.rotation_quaternion = Vector((-np.asarray(toward)).tolist()).to_track_quat("Z", "Y")
        camera.data.angle = np.radians(wide)
        scene.camera = camera
        scene.render.resolution_x = scene.render.resolution_y = 32
        scene.world.cycles.sampling_method, scene.world.cycles.sample_map_resolution = "MANUAL", 64
        scene.frame_set(1)
        return shoot(scene).mean(axis=-1)

    return make


def test_vega_shines_where_an_ephemeris_has_it(look):
    toward = sun.direction(275.386, 76.740)  # PyEphem 4.2.1, at 38.8 N, 120.6 W
    picture = look(datetime(2014, 9, 18, 4, tzinfo=UTC), toward, 4.0)
    row, column = np.unravel_index(np.argmax(picture), picture.shape)
    assert np.hypot(row - 15.5, column - 15.5) < 5.0  # half a degree
    assert picture.max() > 30.0 * np.median(picture)


def test_the_moon_is_lit_from_where_the_sun_is(look, run):
    moment = datetime(2014, 9, 17, 10, 30, tzinfo=UTC)  # four days after the last quarter
    time = times.seconds(run, moment)
    toward = sun.toward_moon(run, time)
    picture = look(moment, toward, 1.0)
    disc = picture > 0.5
    share = disc.sum() / (np.pi * (0.259 * 32.0) ** 2)
    phase = np.radians(180.0 - sun.elongation(*sun.middle(run), moment))
    assert share == pytest.approx(0.5 + 0.5 * np.cos(phase), abs=0.12)
    row, column = np.argwhere(disc).mean(axis=0) - 15.5
    lit = sun.direction(*sun.position(run, time)) - toward
    right = np.cross(toward, (0.0, 0.0, 1.0))
    up = np.cross(right, toward)
    assert np.degrees(np.arctan2(-row, column) - np.arctan2(lit @ up, lit @ right)) == pytest.approx(
        0.0, abs=20.0
    )
