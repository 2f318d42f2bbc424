"""Lamps in place of flames: few, steady, for ground and trees alone, at night alone."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin import auto_framing
from firetwin.blender import compat, owned
from firetwin.render import layers
from firetwin.scene import build
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import flame_light, lamp_objects, lamps
from firetwin.scene.smoke import build as smoke
from firetwin.shot.fire.fire import Fire
from firetwin.shot.sections import Light, SmokeSettings
from firetwin.shot.shot import Shot
from near_fire import from_height


def built(settings, run, stage, parts=("fire", "light", "cameras")):
    """Build what lights a scene, with its view layers."""
    shot = Shot(settings, run)
    build.build(shot, stage.scene, parts)
    layers.build(settings, stage)
    return shot


def lit():
    return [thing for thing in bpy.data.objects if thing.name.startswith("Firetwin Lamp")]


def test_lamps_stand_for_all_heat_near_the_cameras(near, run):
    shot = Shot(near, run)
    ground, placed = shot.ground, lamps.place_lamps(shot)
    model = Fire(run, -np.inf, np.inf)
    luminous = [model.sources(float(time)).luminous().power.sum() for time in placed.time]
    assert 2 < len(placed.radius) <= 48
    assert placed.heat.sum(axis=1) == pytest.approx(luminous, rel=1e-9)
    assert placed.heat.min() >= 0.0
    above = placed.position[:, 2] - ground.up(*placed.position[:, :2].T)
    assert np.all((above > 10.0) & (above < 400.0))


def test_no_more_lamps_than_allowed_and_the_same_again(near, run):
    few = replace(near, light=Light(lamps=5))
    first, again = (lamps.place_lamps(Shot(few, run)) for _ in range(2))
    assert len(first.radius) == 5
    assert np.array_equal(first.position, again.position)
    assert np.array_equal(first.heat, again.heat)


def test_energies_are_straight_lines_between_moments_in_every_build(near, run, stage, sun_at):
    sun_at(-20.0)
    shot = built(near, run, stage)
    things = lit()
    assert 0 < len(things) <= 48
    assert {thing.users_collection[0].name for thing in things} == {"Firetwin Lamps"}
    moving = 0
    for thing in things:
        assert not thing.visible_volume_scatter
        assert not thing.visible_camera
        for curve in compat.fcurves(thing.data):
            moving += 1
            assert {point.interpolation for point in curve.keyframe_points} == {"LINEAR"}
            assert curve.keyframe_points[0].co.x == 1.0
            assert curve.keyframe_points[-1].co.x == near.time.frames
    assert moving > 0
    total = []
    for frame in (1, 2, 3):
        curves = [(thing.data, compat.fcurves(thing.data)) for thing in things]
        total.append(sum(found[0].evaluate(frame) if found else data.energy for data, found in curves))
    far = lamps.place_lamps(shot, flame_light.FAR_LAMPS, lamps.glow_share(shot))
    wanted = np.interp(shot.frames.times, far.time, far.heat.sum(axis=1)) * lamps.LIGHT
    assert total == pytest.approx(wanted, rel=1e-3)
    count = len(things), len(bpy.data.lights), len(bpy.data.actions)
    built(near, run, stage)
    assert (len(lit()), len(bpy.data.lights), len(bpy.data.actions)) == count


@pytest.mark.parametrize(("engine", "shadows"), [("cycles", True), ("eevee", False)])
def test_only_cycles_draws_their_shadows(near, run, scene, sun_at, engine, shadows):
    sun_at(-20.0)
    settings = replace(near, render=replace(near.render, engine=engine))
    made = lamp_objects.build(Shot(settings, run), scene.collection)
    assert made
    assert {thing.data.use_shadow for thing in made} == {shadows}


@pytest.mark.parametrize("height", [6.1, 40.0])
def test_no_lamps_by_day(near, run, stage, sun_at, height):
    sun_at(height)
    built(near, run, stage)
    assert not lit()


def test_smoke_lights_the_ground_near_a_camera_at_night_alone(near, run, sun_at):
    shot, shares, heats = Shot(near, run), [], []
    for height in (10.0, -20.0):
        sun_at(height)
        shares.append(lamps.glow_share(shot))
        heats.append(lamps.place_lamps(shot, flame_light.FAR_LAMPS, shares[-1]).heat.sum())
    assert shares[0] == 0.0 < shares[1]
    assert heats[1] > heats[0]


def test_lamps_where_smoke_shuts_out_the_sun(near, run, stage, sun_at):
    sun_at(10.0)
    built(replace(near, smoke=replace(near.smoke, enabled=True)), run, stage)
    assert lit()


def test_none_are_made_without_a_camera_or_when_off(near, run, stage, sun_at):
    sun_at(-20.0)
    built(replace(near, light=replace(near.light, lamps=0)), run, stage)
    assert not lit()
    built(replace(near, cameras=()), run, stage)
    assert not lit()


def test_none_are_made_where_no_camera_is_near_the_fire(settings, run, stage, sun_at):
    """From 10 km up their light does not show."""
    sun_at(-20.0)
    shot = built(from_height(settings, 10_000.0), run, stage)
    assert not lit()
    found = lamps.place_lamps(shot)
    assert found.position.shape == (0, 3)
    assert found.heat.shape == (len(found.time), 0)


def test_a_run_without_a_scene_file_is_built_by_night(settings, run, stage, sun_at, plain_looks):
    sun_at(-20.0)
    cameras = auto_framing.fit(run, settings).settings.cameras
    built(replace(settings, cameras=cameras), run, stage, tuple(build.PARTS))
    assert bpy.data.objects["Firetwin Flames"].users_scene == (stage.scene,)


def test_all_that_fire_and_smoke_make_is_ours_and_goes_again(near, run, scene, sun_at):
    sun_at(-20.0)
    shot = Shot(replace(near, smoke=SmokeSettings(method="preview", voxel_size=120.0)), run)
    kinds = ("objects", "meshes", "lights", "volumes", "materials", "node_groups", "collections", "actions")
    before = {block for kind in kinds for block in getattr(bpy.data, kind)}
    stage = owned.stage(scene)
    fire.build(shot, stage)
    smoke.build(shot, stage)
    made = {block for kind in kinds for block in getattr(bpy.data, kind)} - before
    assert len(made) > 50
    assert [block.name for block in made if not owned.is_ours(block)] == []
    owned.remove(scene)
    assert {block for kind in kinds for block in getattr(bpy.data, kind)} == before
