"""The world's night sky: stars, moon and twilight, by night only."""

from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
from firetwin.run import sun, times
from firetwin.scene.light import build as light
from firetwin.shot.shot import Shot


@pytest.fixture
def sky(settings, run, stage, scene):
    """Build the world at a moment; return its nodes, by name."""

    def make(moment, frames=1, end=None):
        film = replace(settings, time=replace(settings.time, start=moment, end=end, frames=frames))
        light.build(Shot(film, run), stage)
        scene.frame_set(1)
        return scene.world.node_tree.nodes

    return make


def moment(day, hour):
    return datetime(2014, 9, day, hour, tzinfo=UTC)


def test_by_day_there_are_no_stars(sky):
    nodes = sky(moment(17, 21))
    assert "Stars" not in nodes
    assert "Firetwin Stars" not in bpy.data.images


def test_by_night_stars_shine_and_the_moon_is_where_it_is(sky, run):
    nodes = sky(moment(9, 8))  # full moon
    assert nodes["Stars"].outputs[0].default_value == 1.0
    toward = [socket.default_value for socket in nodes["Toward Moon"].inputs]
    assert np.allclose(toward, sun.toward_moon(run, times.seconds(run, moment(9, 8))), atol=1e-6)
    assert "Twilight" not in nodes
    assert bpy.data.images["Firetwin Stars"].packed_file is not None


def test_a_moonless_night_has_no_disc_and_soft_light(sky):
    assert "Toward Moon" not in sky(moment(24, 8))
    assert bpy.data.lights["Firetwin Sun"].angle > 0.5


def test_stars_fade_in_twilight_which_has_an_arch_over_the_sun(sky):
    nodes = sky(moment(18, 3))  # 8 p.m., sun 12 degrees down in the west
    assert 0.0 < nodes["Stars"].outputs[0].default_value < 1.0
    east, north, up = (socket.default_value for socket in nodes["Twilight"].inputs)
    assert east < 0.0 < abs(north) < abs(east)
    assert up == 0.0


def test_the_sky_turns_with_sidereal_time(sky, scene):
    nodes = sky(moment(18, 5), frames=3, end=moment(18, 6))
    before = nodes["Sidereal Angle"].outputs[0].default_value
    scene.frame_set(3)
    turned = np.degrees(nodes["Sidereal Angle"].outputs[0].default_value - before)
    assert turned == pytest.approx(15.041, abs=0.01)


def test_building_again_leaves_one_chart(sky):
    for _ in range(2):
        sky(moment(18, 8))
    assert len([image for image in bpy.data.images if image.name.startswith("Firetwin Stars")]) == 1
