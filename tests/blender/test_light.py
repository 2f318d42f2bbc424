from dataclasses import replace
from datetime import UTC, datetime, timedelta

import bpy
import numpy as np
import pytest
from astral import Observer
from astral.sun import azimuth, elevation
from firetwin.blender import compat
from firetwin.run import frame
from firetwin.scene.light import build as light
from firetwin.scene.light import sky
from firetwin.shot import sun
from firetwin.shot.shot import Shot


def test_the_lamp_shines_from_where_the_sun_is(shot, stage, scene):
    light.build(shot, stage)
    lamp = bpy.data.objects["Firetwin Sun"]
    origin = frame.local_frame(shot.run)
    for number, hours in ((1, 0.0), (3, 1.0)):
        scene.frame_set(number)
        moment = datetime(2014, 9, 17, 21, 0, tzinfo=UTC) + timedelta(hours=hours)
        place = Observer(origin.latitude, origin.longitude, 0.0)
        wanted = sun.direction(azimuth(place, moment), elevation(place, moment))
        found = np.array(lamp.matrix_world.to_3x3().col[2])
        assert np.degrees(np.arccos(np.clip(found @ wanted, -1.0, 1.0))) < 0.1


def test_the_sun_of_the_king_fire_is_where_the_almanac_has_it():
    # Solar noon at 120.6 W on 17 Sep 2014 is 12:57 PDT; the declination is 2.2 degrees.
    bearing, height = sun.angles(38.8, -120.6, datetime(2014, 9, 17, 19, 57, tzinfo=UTC))
    assert bearing == pytest.approx(180.0, abs=0.7)
    assert height == pytest.approx(90.0 - 38.8 + 2.2, abs=0.3)


def test_day_is_brighter_than_night_and_evening_redder_than_noon(settings):
    noon, evening, night = (sky.State(settings.light, 200.0, height) for height in (50.0, 5.0, -30.0))
    assert noon.power > 2.0 * evening.power > 20.0 * night.power
    assert evening.colour[2] / evening.colour[0] < 0.5 * noon.colour[2] / noon.colour[0]
    assert night.exposure == pytest.approx(noon.exposure + 3.0)


def test_exposure_can_be_set(settings, run, stage, scene):
    light.build(Shot(replace(settings, light=replace(settings.light, exposure=1.25)), run), stage)
    scene.frame_set(2)
    assert scene.view_settings.exposure == 1.25
    assert scene.view_settings.look == "AgX - Medium High Contrast"


def test_air_mass_is_kasten_and_youngs():
    assert sky.air_mass(90.0) == pytest.approx(1.0, abs=1e-3)
    assert sky.air_mass(30.0) == pytest.approx(1.994, abs=2e-3)
    assert sky.air_mass(0.0) == pytest.approx(38.0, abs=0.3)


def test_building_twice_leaves_one_sky(shot, stage, scene):
    for _ in range(2):
        light.build(shot, stage)
    assert [world.name for world in bpy.data.worlds] == ["Firetwin Sky"]
    assert len(bpy.data.lights) == 1
    assert len(compat.fcurves(scene)) == 1
