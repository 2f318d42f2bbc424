"""Lamps in place of flames: few, steady, for ground and trees alone, at night alone."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin import compat, nodes
from firetwin import project as projects
from firetwin.scene import build, clock, heat, lamps
from firetwin.scene.ground import Ground
from firetwin.scene.paths import paths


@pytest.fixture
def sun_at(monkeypatch):
    """Put the sun at a height (degrees) for lamps and light alike."""

    def place(height):
        from firetwin.scene import sun

        monkeypatch.setattr(sun, "at", lambda run, time: (200.0, height))

    return place


@pytest.fixture
def near(project):
    """A camera near the front of the second frame."""
    key = replace(project.cameras[0].keys[0], latitude=38.8395, height=150.0)
    return replace(project, cameras=(replace(project.cameras[0], keys=(key,)),))


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
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type == "EMISSION":
                strength = node.inputs["Strength"]
                for link in strength.links:
                    material.node_tree.links.remove(link)
                strength.default_value = 0.0
    assert lamps


def test_lamps_stand_for_all_heat_near_the_cameras(near, run):
    ground = Ground(near, run)
    found = lamps.place(near, run, ground, paths(near, run, ground))
    model = heat.Heat(run)
    luminous = [model.sources(float(time)).luminous().power.sum() for time in found.time]
    assert 2 < len(found.radius) <= 48
    assert found.heat.sum(axis=1) == pytest.approx(luminous, rel=1e-9)
    assert found.heat.min() >= 0.0
    above = found.position[:, 2] - ground.up(*found.position[:, :2].T)
    assert np.all((above > 10.0) & (above < 400.0))


def test_no_more_lamps_than_allowed_and_the_same_again(near, run):
    few = replace(near, light=projects.Light(lamps=5))
    ground = Ground(few, run)
    first, again = (lamps.place(few, run, ground, paths(few, run, ground)) for _ in range(2))
    assert len(first.radius) == 5
    assert np.array_equal(first.position, again.position)
    assert np.array_equal(first.heat, again.heat)


def test_energies_are_straight_lines_between_moments(near, run, scene, sun_at):
    sun_at(-20.0)
    build.build(near, run, scene)
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
    times = clock.frame_times(near, run)
    model, total = heat.Heat(run), []
    for frame in (1, 2, 3):
        curves = [(thing.data, compat.fcurves(thing.data)) for thing in things]
        total.append(sum(found[0].evaluate(frame) if found else data.energy for data, found in curves))
    wanted = [model.sources(float(time)).luminous().power.sum() * lamps.LIGHT for time in times]
    assert total == pytest.approx(wanted, rel=1e-3)


def test_building_twice_leaves_one_set(near, run, scene, sun_at):
    sun_at(-20.0)
    build.build(near, run, scene)
    count = len(lit()), len(bpy.data.lights), len(bpy.data.actions)
    build.build(near, run, scene)
    assert (len(lit()), len(bpy.data.lights), len(bpy.data.actions)) == count


@pytest.mark.parametrize(("engine", "shadows"), [("cycles", True), ("eevee", False)])
def test_only_cycles_draws_their_shadows(near, run, scene, sun_at, engine, shadows):
    sun_at(-20.0)
    ground = Ground(near, run)
    project = replace(near, render=replace(near.render, engine=engine))
    made = lamps.build(project, run, ground, paths(near, run, ground), scene.collection)
    assert made
    assert {thing.data.use_shadow for thing in made} == {shadows}


@pytest.mark.parametrize("height", [6.1, 40.0])
def test_no_lamps_by_day(near, run, scene, sun_at, height):
    sun_at(height)
    build.build(near, run, scene)
    assert not lit()


def test_they_come_so_gradually_that_the_first_light_cannot_be_seen(near, run, scene, sun_at, shoot):
    """A degree under the sun that ends them, no pixel gets a 255th of white from lamps; by night many do."""
    brightest = []
    for height in (5.0, -20.0):
        sun_at(height)
        build.build(near, run, scene)
        alone(scene, lit())
        brightest.append(np.max(shoot(scene, "rgb")))
    assert lit()
    assert brightest[0] < 1.0 / 255.0 < brightest[1]


def test_lamps_light_the_ground_and_leave_temperatures_alone(near, run, scene, sun_at, shoot):
    sun_at(-20.0)
    build.build(near, run, scene)
    scene.frame_set(2)
    kelvin, light = shoot(scene, "thermal"), shoot(scene, "rgb")
    for thing in lit():
        thing.hide_render = True
    assert np.array_equal(kelvin, shoot(scene, "thermal"))
    assert np.mean(light - shoot(scene, "rgb")) > 1.0e-3
    assert scene.view_layers["thermal"][nodes.THERMAL] == 1.0


def test_none_are_made_without_a_camera_or_when_off(near, run, scene, sun_at):
    sun_at(-20.0)
    build.build(replace(near, light=replace(near.light, lamps=0)), run, scene)
    assert not lit()
    build.build(replace(near, cameras=()), run, scene)
    assert not lit()
