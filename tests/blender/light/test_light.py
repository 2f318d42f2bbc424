import colorsys
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import bpy
import numpy as np
import pytest
from astral import Observer
from astral.sun import azimuth, elevation
from firetwin.blender import compat, owned
from firetwin.render import engine
from firetwin.run import frame, sun
from firetwin.scene.light import build as light
from firetwin.shot.light import exposure, exposure_meter, sky
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


def test_day_is_brighter_than_night_and_evening_redder_than_noon():
    noon, evening, night = (sky.State(200.0, height) for height in (50.0, 5.0, -30.0))
    assert noon.power > 2.0 * evening.power > 20.0 * night.power
    assert evening.colour[2] / evening.colour[0] < 0.5 * noon.colour[2] / noon.colour[0]
    assert noon.sky_mean > evening.sky_mean > 10.0 * night.sky_mean


def test_exposure_can_be_set(settings, run, stage, scene):
    light.build(Shot(replace(settings, light=replace(settings.light, exposure=1.25)), run), stage)
    scene.frame_set(2)
    assert scene.view_settings.exposure == 1.25
    assert scene.view_settings.look == "AgX - Medium High Contrast"


@pytest.mark.parametrize("luminance", [0.04, 0.12, exposure._WHITE])
def test_smoke_over_flames_is_orange_in_the_picture_of_a_moonlit_night(
    shot, stage, scene, tmp_path, luminance
):
    light.build(shot, stage)
    scene.view_settings.exposure, scene.render.image_settings.file_format = 0.0, "PNG"
    moonlit = sky.State(200.0, -30.0, sun.Moon(150.0, 40.0, 0.5)).around * 0.5 * 2.0**3.0
    pixel = bpy.data.images.new("pixel", 1, 1, float_buffer=True)
    glow = np.array(sky.GLOW) * luminance / exposure_meter.luminance(sky.GLOW)
    pixel.pixels.foreach_set(np.append(glow + moonlit, 1.0).astype(np.float32))
    pixel.save_render(str(tmp_path / "pixel.png"), scene=scene)
    shown = bpy.data.images.load(str(tmp_path / "pixel.png"))
    hue, saturation, _ = colorsys.rgb_to_hsv(*shown.pixels[:3])
    assert 15.0 < 360.0 * hue < 28.0
    assert saturation > 0.7


def test_a_scene_that_is_not_ours_keeps_its_world_and_its_colours(shot, scene):
    scene.world = bpy.data.worlds.new("mine")
    view = scene.view_settings
    view.view_transform, view.look, view.exposure = "Standard", "None", 0.25
    assert light.build(shot, owned.stage(scene)) == []
    assert [world.name for world in bpy.data.worlds] == ["mine"]
    assert (view.view_transform, view.look, view.exposure) == ("Standard", "None", 0.25)
    assert not compat.fcurves(scene)
    assert bpy.data.objects["Firetwin Sun"].data.energy > 1.0


def test_the_shade_between_trees_is_filled_most_by_day_and_by_no_world_but_ours(settings, run, stage, scene):
    day, night = (datetime(2014, 9, 17, hour, tzinfo=UTC) for hour in (21, 8))
    factors = []
    for moment in (day, night):
        film = replace(settings, time=replace(settings.time, start=moment, end=None, frames=1))
        light.build(Shot(film, run), stage)
        engine.apply(film, scene)
        assert scene.cycles.use_fast_gi
        factors.append(scene.world.light_settings.ao_factor)
    assert 0.3 < factors[0] < 0.6
    assert 0.03 * factors[0] < factors[1] < 0.4 * factors[0]
    assert scene.world.cycles.sampling_method == "NONE"
    scene.world = bpy.data.worlds.new("mine")
    engine.apply(settings, scene)
    assert not scene.cycles.use_fast_gi
    assert scene.world.cycles.sampling_method == "MANUAL"  # it may have a sun


def test_a_world_of_the_artist_stays_in_a_scene_of_ours(shot, stage, scene):
    light.build(shot, stage)
    scene.world = mine = bpy.data.worlds.new("mine")
    assert light.build(shot, stage) == []
    assert scene.world == mine
    assert [world.name for world in bpy.data.worlds] == ["mine"]
    assert scene.view_settings.view_transform == "AgX"


def test_an_animation_of_the_artist_stays_as_it_is(shot, stage, scene):
    compat.new_fcurve(scene, "render.resolution_x").keyframe_points.insert(1.0, 64.0)
    del scene.animation_data.action[owned.MARK]
    light.build(shot, stage)
    assert [curve.data_path for curve in compat.fcurves(scene)] == ["render.resolution_x"]
    assert scene.view_settings.exposure == pytest.approx(exposure.at(shot, np.array([2]))[0])


def test_a_still_after_a_film_has_its_own_exposure(settings, run, stage, scene):
    settings = replace(settings, time=replace(settings.time, start=None, end=None))
    for frames in (3, 1):
        dark = replace(settings.light, exposure=None if frames > 1 else 1.25)
        light.build(
            Shot(replace(settings, light=dark, time=replace(settings.time, frames=frames)), run), stage
        )
    scene.frame_set(1)
    assert scene.view_settings.exposure == 1.25
