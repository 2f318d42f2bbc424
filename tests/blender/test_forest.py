from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.scene import build
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import models, stand
from firetwin.shot.ground import NEVER
from firetwin.shot.rigs.satellite import Satellite
from firetwin.shot.shot import Shot
from firetwin_core import forest as core


def _instances(name):
    """Translation (n, 3), scale (n,) and name of the model of every instance of an object."""
    graph = bpy.context.evaluated_depsgraph_get()
    place, scale, model = [], [], []
    for item in graph.object_instances:
        if item.is_instance and item.parent.original.name == name:
            place.append(item.matrix_world.translation[:])
            scale.append(item.matrix_world.median_scale)
            model.append(item.object.original.name)
    return np.array(place), np.array(scale), model


def _number(name):
    """Number of the model that "Firetwin Tree 03 1" is: its number, and its level."""
    return int(name.split()[2])


def _all_trees(shot):
    run = shot.run
    axes = run.fuel_latitude, run.fuel_longitude
    return core.trees(run.canopy_fuel, *axes, run.fuel_elevation, shot.local_frame, seed=shot.settings.seed)


def _planted(shot, stage):
    return forest.build(shot, stage, stand.grow(shot))


def test_instances_are_the_cores_trees_that_the_cameras_see(shot, stage):
    _planted(shot, stage)
    place, scale, _model = _instances("Firetwin Trees")
    wanted = _all_trees(shot)
    seen = forest.visible(shot, wanted.position, wanted.scale, shot.settings.forest.draw_distance)
    assert 0 < seen.sum() < len(wanted.cell)
    assert place == pytest.approx(wanted.position[seen], abs=2e-3)
    assert scale == pytest.approx(wanted.scale[seen], rel=1e-5)


def test_without_a_limit_of_view_every_tree_is_there(settings, run, stage):
    keys = settings.cameras[0].rig.keys
    camera = replace(settings.cameras[0], name="above", rig=Satellite(swath=14_000.0, keys=keys))
    render = replace(settings.render, resolution=(1000, 1000))
    shot = Shot(replace(settings, cameras=(camera,), render=render), run)
    _planted(shot, stage)
    place, _scale, model = _instances("Firetwin Trees")
    wanted = _all_trees(shot)
    assert len(place) == len(wanted.cell) == np.sum(run.canopy_fuel > 0.01)
    first = np.array([models.FIRST_MODEL[k] for k in range(3)])[wanted.size_class]
    living = [name for name in model if _number(name) not in models.SNAGS]
    assert len(living) > 0.5 * len(model)
    expected = first + wanted.model
    for name, number in zip(model, expected, strict=True):
        assert _number(name) in (number, *models.SNAGS)


def test_trees_are_four_to_thirty_metres_tall(near_shot, stage):
    _planted(near_shot, stage)
    # Algorithm 2's bounds are 6 m x 0.7 x 0.8 and 18 m x 1.4 x 1.2.
    for name, low, high in (("Firetwin Trees", 3.36, 30.24), ("Firetwin Stand", 4.0, 30.0)):
        scale = _instances(name)[1]
        assert len(scale) > 50
        assert low - 1e-3 <= scale.min() <= scale.max() <= high + 1e-3


def test_burned_trees_become_snags_a_quarter_of_an_hour_later(shot, stage, scene):
    made = _planted(shot, stage)[0]
    arrival = np.empty(len(made.data.vertices), np.float32)
    made.data.attributes["arrival_time"].data.foreach_get("value", arrival)
    for frame, time in ((1, 0.0), (3, 3600.0)):
        scene.frame_set(frame)
        model = np.array([_number(name) for name in _instances("Firetwin Trees")[2]])
        snag = np.isin(model, models.SNAGS)
        old = time - arrival > forest.BARE_AFTER
        assert not snag[~old].any()
        assert old.sum() == 0 or snag[old].mean() == pytest.approx(0.85, abs=0.08)
    assert old.sum() > 30
    assert np.any(arrival == NEVER)


def test_near_trees_stand_on_the_drawn_ground(near_shot, stage):
    ground = near_shot.ground
    _planted(near_shot, stage)
    for name in ("Firetwin Trees", "Firetwin Stand"):
        place = _instances(name)[0].astype(np.float64)
        place = place[ground.detail(*place.T) > 0.01]
        assert len(place) > 20
        assert place[:, 2] == pytest.approx(ground.up(place[:, 0], place[:, 1]), abs=0.15)


def test_the_stand_grows_where_there_is_canopy_and_leaves_cameras_free(near_shot):
    ground, grown = near_shot.ground, stand.grow(near_shot)
    canopy = ground.sample(ground.fields.canopy_fuel, *grown.position[:, :2].T)
    assert np.mean(canopy > 0.0) > 0.99
    assert near_shot.sights.distance(grown.position).min() >= stand.CLEARING - 8.0
    again = stand.grow(near_shot)
    assert np.array_equal(grown.position, again.position)


def test_skipping_what_no_camera_sees_does_not_change_the_picture(shot, stage, scene, shoot, monkeypatch):
    build.build(shot, scene)
    skipped = shoot(scene, "rgb")
    count = len(bpy.data.objects["Firetwin Trees"].data.vertices)
    monkeypatch.setattr(forest, "visible", lambda _shot, places, *_: np.ones(len(places), bool))
    build.build(shot, scene)
    full = shoot(scene, "rgb")
    assert len(bpy.data.objects["Firetwin Trees"].data.vertices) > 1.5 * count
    assert np.abs(full - skipped).mean() < 0.01 * full.mean()
    assert np.quantile(np.abs(full - skipped), 0.98) < 0.05 * full.mean()
