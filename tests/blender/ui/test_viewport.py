"""Proxies of the viewport, and that no render shows them."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import viewport
from firetwin.run import opening as runs
from firetwin.scene import build
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import fire_effects, preview
from firetwin.scene.forest.levels import LEVELS
from firetwin.scene.terrain import solid_view
from firetwin.shot.shot import Shot


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(preview, "MOST", 300)


def trees():
    return [thing for thing in bpy.data.objects if "Trees" in thing.name and thing.modifiers]


def drawn(names):
    """Count the instances of these objects in the viewport."""
    graph = bpy.context.evaluated_depsgraph_get()
    return sum(item.is_instance and item.parent.original.name in names for item in graph.object_instances)


def test_others_stand_in_for_a_large_forest(near_shot, scene, few, plain_looks):
    build.build(near_shot, scene)
    full = bpy.data.objects["Firetwin Trees"]
    shown = [thing for thing in trees() if thing != full]
    count, some = len(full.data.vertices), sum(len(thing.data.vertices) for thing in shown)
    assert count > 1000
    assert some == pytest.approx(300, abs=5 * np.sqrt(300))
    assert full.hide_viewport
    assert not full.hide_render
    assert shown
    assert all(thing.hide_render and not thing.hide_viewport for thing in shown)
    assert drawn(["Firetwin Trees"]) == 0
    assert drawn([thing.name for thing in shown]) == some
    place, living, burned = (array(full, name) for name in ("position", "model", "snag_model"))
    for model, at in standing(shown):  # the same models as those they stand for
        nearest = np.argmin(np.linalg.norm(place - at, axis=1))
        assert model in {living[nearest] // LEVELS, burned[nearest] // LEVELS}
    models = shown[0].modifiers[0].node_group.nodes["Collection Info"].inputs["Collection"].default_value
    assert len(models.objects) < 60  # of more than a hundred


def test_burned_grass_stands_for_itself_too(near_shot, monkeypatch):
    monkeypatch.setattr(fire_effects, "torching_intensity", lambda height: np.full(len(height), -1.0))
    render = replace(near_shot.settings.render, cull=False)
    grass = forest._grass(Shot(replace(near_shot.settings, render=render), near_shot.run))
    assert set(grass["snag_model"]) == set(grass["model"]) == {0, 1}


def standing(things):
    """Numbers of models and places of 20 of the instances of these objects."""
    return [
        (int(item.object.original.name.split()[2]), np.array(item.matrix_world.translation))
        for item in bpy.context.evaluated_depsgraph_get().object_instances
        if item.is_instance and item.parent.original in things
    ][:20]


def array(thing, name):
    """An attribute of an object's points."""
    data = thing.data.attributes[name].data
    if name == "position":
        found = np.empty((len(data), 3), np.float32)
        data.foreach_get("vector", found.ravel())
    else:
        found = np.empty(len(data), np.int32)
        data.foreach_get("value", found)
    return found


def test_only_trees_that_burn_follow_time(near_shot, scene, few, plain_looks):
    """A frame change evaluates no other nodes: none of them depends on the time or the camera."""
    build.build(near_shot, scene)
    asking = {"GeometryNodeInputSceneTime", "GeometryNodeInputActiveCamera"}
    for thing in trees():
        kinds = {node.bl_idname for node in thing.modifiers[0].node_group.nodes}
        assert bool(kinds & asking) is (thing.name != "Firetwin Trees in Viewport"), thing.name
    arrival = np.empty(len(bpy.data.objects["Firetwin Burning Trees in Viewport"].data.vertices), np.float32)
    data = bpy.data.objects["Firetwin Burning Trees in Viewport"].data
    data.attributes["arrival_time"].data.foreach_get("value", arrival)
    assert np.all((arrival + 900.0 > near_shot.frames.first) & (arrival + 900.0 <= near_shot.frames.last))


def test_a_small_forest_stays_as_it_is(near_shot, scene, plain_looks):
    build.build(near_shot, scene)
    assert [thing.name for thing in trees()] == ["Firetwin Trees"]
    assert not trees()[0].hide_viewport


def test_the_solid_view_shows_fuel_scar_and_water(settings, run_folder, scene, plain_looks):
    shot = Shot(settings, runs.open(run_folder))
    build.build(shot, scene, ("terrain",))
    data = bpy.data.objects["Firetwin Ground"].data
    assert data.color_attributes.active_color.name == solid_view.NAME
    row, column = (axis.ravel() for axis in np.indices(shot.ground.shape).astype(float))
    colours = solid_view.vertex_colours(shot, row, column).reshape(*shot.ground.shape, 3)
    ground = shot.ground
    inside = ground.burned > 0.5
    before = inside & (ground.burn_time <= shot.frames.first)
    during = inside & (ground.burn_time > shot.frames.first) & (ground.burn_time <= shot.frames.last)
    assert before.sum() > 10
    assert during.sum() > 10
    assert colours[before] == pytest.approx(np.broadcast_to(solid_view.BURNED, colours[before].shape))
    assert colours[during] == pytest.approx(np.broadcast_to(solid_view.BURNS, colours[during].shape))
    dense = (ground.fields.canopy_fuel > 2.0) & ~inside & (ground.bare < 0.001) & (ground.water < 0.5)
    assert colours[dense] == pytest.approx(np.broadcast_to(solid_view.FOREST, colours[dense].shape), rel=0.05)
    ground.__dict__["water"] = np.ones(ground.shape)
    assert np.all(solid_view.vertex_colours(shot, row, column) == np.float32(solid_view.WATER))


def test_a_file_opens_with_views_that_show_the_scene():
    viewport.prepare_file()
    spaces = [
        space
        for screen in bpy.data.screens
        for area in screen.areas
        for space in area.spaces
        if space.type == "VIEW_3D"
    ]
    assert spaces
    for space in spaces:
        assert space.clip_end == viewport.FAR
        assert space.shading.color_type != "MATERIAL"
