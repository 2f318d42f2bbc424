from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.scene import build, flame_field
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import library, models, plot, stand, visibility
from firetwin.scene.forest.material import BARE_AFTER, LOW_BARE_AFTER, TORCHING, burning_share
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin.shot.terrain.terrain import NEVER
from firetwin_core import forest as core

pytestmark = pytest.mark.usefixtures("whole_forest")


def _instances(name):
    """Translation (n, 3), scale (n, 3) and name of the model of every instance of an object."""
    graph = bpy.context.evaluated_depsgraph_get()
    place, scale, model = [], [], []
    for item in graph.object_instances:
        if item.is_instance and item.parent.original.name == name:
            place.append(item.matrix_world.translation[:])
            scale.append(item.matrix_world.to_scale()[:])
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
    visible = visibility.visible(shot, wanted.position, wanted.scale, shot.settings.forest.draw_distance)
    assert 0 < visible.sum() < len(wanted.cell)
    assert place == pytest.approx(wanted.position[visible], abs=2e-3)
    assert scale == pytest.approx(np.repeat(wanted.scale[visible, None], 3, axis=1), rel=1e-5)


def test_without_a_limit_of_view_every_tree_is_there(settings, run, stage):
    keys = settings.cameras[0].rig.keys
    camera = replace(settings.cameras[0], name="above", rig=Satellite(swath=14_000.0, keys=keys))
    render = replace(settings.render, resolution=(4000, 4000))
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


def test_instances_are_the_stands_trees_as_tall_and_wide_as_they_are(near_shot, stage):
    grown = stand.grow(near_shot)
    forest.build(near_shot, stage, grown)
    place, scale, _model = _instances("Firetwin Trees")
    assert place == pytest.approx(grown.position, abs=2e-3)
    assert scale[:, 2] == pytest.approx(grown.height, rel=1e-5)
    assert scale[:, :2] == pytest.approx(np.repeat((grown.height * grown.width)[:, None], 2, 1), rel=1e-5)
    assert grown.height.min() > 1.5  # oaks are half as tall as the conifers of their size
    assert 20.0 < grown.height.max() <= stand.TALLEST
    assert grown.width.min() >= 1.0


def test_far_trees_are_fewer_and_wider_and_about_the_budget(near_settings, run):
    many, few = (
        stand.grow(Shot(replace(near_settings, forest=replace(near_settings.forest, budget=n)), run))
        for n in (4000, 1000)
    )
    for grown, budget in ((many, 4000), (few, 1000)):
        assert 0.2 * budget < len(grown.height) < 1.1 * budget
        far = grown.distance > np.median(grown.distance)
        assert grown.width[far].mean() > grown.width[~far].mean()
    assert few.width.mean() > 1.2 * many.width.mean()


@pytest.mark.parametrize(
    ("widening", "in_film", "outside"), [("film", 1, 0), ("always", 1, 1), ("never", 0, 0)]
)
def test_crowns_are_widened_where_the_setting_says(near_settings, run, widening, in_film, outside):
    chosen = replace(near_settings.forest, budget=1000, widening=widening)
    shot = Shot(replace(near_settings, forest=chosen), run)
    for grown, wide in ((stand.grow(shot), in_film), (stand.grow(shot, in_film=False), outside)):
        assert (grown.width.max() > 1.5) == wide
        assert wide or (grown.width == 1.0).all()
        far, near = np.array([0.7 * grown.radius]), np.array([20.0])
        assert grown.coverage(near) == 1.0
        assert (grown.coverage(far) == 1.0) == wide  # else the ground's colour shows the omitted trees


def test_what_is_kept_goes_on_beside_what_is_seen(near_settings, run):
    shot = Shot(replace(near_settings, forest=replace(near_settings.forest, budget=200)), run)
    (own,) = plot.plots(shot, stand.TALLEST, shot.settings.forest.draw_distance)
    mask, ((kept,), _) = own.mask, stand._retained(shot, [own])
    beside = np.lib.stride_tricks.sliding_window_view(np.pad(mask, 1), (3, 3)).any((2, 3)) & ~mask
    assert 0 < mask.sum() < mask.size
    assert kept[mask].max() < 1.0
    assert kept[beside].max() < 1.0  # else the last trees in sight would crowd


def test_the_paper_mode_has_no_stand(settings, run, stage):
    shot = Shot(settings, run)
    grown = stand.grow(shot)
    assert len(grown.height) == 0
    assert grown.coverage(np.array([0.0, 100.0])).tolist() == [0.0, 0.0]


def test_burned_crowns_are_bare_sooner_where_flames_are_drawn_as_a_field(shot, stage, scene):
    made = _planted(shot, stage)[0]
    arrival, torched = np.empty((2, len(made.data.vertices)), np.float32)
    made.data.attributes["arrival_time"].data.foreach_get("value", arrival)
    made.data.attributes["torched"].data.foreach_get("value", torched)
    late = np.sort(arrival[(torched == 1.0) & (arrival < NEVER)])
    scene.frame_set(1)
    frame = 1.0 + (late[len(late) // 2] + 1.2 * BARE_AFTER[1] - shot.frames.first) / shot.frames.step
    scene.frame_set(int(frame), subframe=frame % 1.0)
    age = shot.frames.time(frame) - arrival
    for reach in (0.0, 1.0e6):
        flame_field.set_reach(stage, reach)
        model = np.array([_number(name) for name in _instances("Firetwin Trees")[2]])
        snag = np.isin(model, models.SNAGS)
        sooner = (age > BARE_AFTER[1]) & (age < TORCHING) & (torched == 1.0)
        assert sooner.any()
        assert np.all(snag[sooner] == (reach > 0.0))
        assert not snag[age < BARE_AFTER[0]].any()


def test_trees_whose_crowns_burn_become_snags_as_their_flames_end(shot, stage, scene):
    made = _planted(shot, stage)[0]
    arrival, torched = np.empty((2, len(made.data.vertices)), np.float32)
    made.data.attributes["arrival_time"].data.foreach_get("value", arrival)
    made.data.attributes["torched"].data.foreach_get("value", torched)
    for frame, time in ((1, 0.0), (3, 3600.0)):
        scene.frame_set(frame)
        model = np.array([_number(name) for name in _instances("Firetwin Trees")[2]])
        snag = np.isin(model, models.SNAGS)
        old = time - arrival > TORCHING
        assert not snag[~old].any()
        assert np.array_equal(snag[old], torched[old] == 1.0)
    assert old.sum() > 30
    assert np.any(arrival == NEVER)


def test_near_trees_stand_on_the_drawn_ground(near_shot, stage):
    ground = near_shot.ground
    _planted(near_shot, stage)
    place = _instances("Firetwin Trees")[0].astype(np.float64)
    place = place[ground.detail(*place.T) > 0.01]
    assert len(place) > 20
    assert place[:, 2] == pytest.approx(ground.up(place[:, 0], place[:, 1]), abs=0.15)


def test_the_stand_grows_where_there_is_canopy_and_leaves_cameras_free(near_shot):
    ground, grown = near_shot.ground, stand.grow(near_shot)
    canopy = ground.sample(ground.fields.canopy_fuel, *grown.position[:, :2].T)
    assert np.mean(canopy > 0.0) > 0.99
    assert near_shot.visibility.distance(grown.position).min() > stand.CLEARING
    again = stand.grow(near_shot)
    assert np.array_equal(grown.position, again.position)


def test_no_crown_is_close_to_a_camera_between_crowns(near_settings, run):
    """A camera 30 m up is more than `stand.CLEARING` from the feet of all trees."""
    drone = near_settings.cameras[0].rig
    raised = replace(drone, keys=tuple(replace(key, height=30.0) for key in drone.keys))
    shot = Shot(replace(near_settings, cameras=(Camera("drone", raised),)), run)
    grown = stand.grow(shot)
    crowns = grown.position + np.stack(np.broadcast_arrays(0.0, 0.0, 0.8 * grown.height), axis=-1)
    assert len(grown.position) > 100
    assert shot.visibility.distance(crowns).min() > 0.9 * stand.CLEARING


def test_a_satellite_that_sees_no_tree_sees_no_patch_of_them(near_settings, run, scene):
    """Trees drawn for another camera of the scene are hidden from it; one that sees trees sees all."""
    for swath, hidden in ((8000.0, True), (200.0, False)):
        above = Camera("above", Satellite(swath=swath))
        shot = Shot(replace(near_settings, cameras=(*near_settings.cameras, above)), run)
        stage = owned.stage(build.build(shot, scene, ("forest", "cameras")))
        counts = []
        for name in ("drone", "above", "drone"):
            scene.camera = stage.camera(name)
            graph = bpy.context.evaluated_depsgraph_get()
            graph.update()
            counts.append(sum(thing.is_instance for thing in graph.object_instances))
        assert counts[0] > 100
        assert counts[2] == counts[0]
        assert (counts[1] == 0) is hidden


def test_tufts_are_bare_soon_after_the_fire(shot, stage, scene):
    scene.frame_set(1)
    age = np.array([-10.0, 0.9 * LOW_BARE_AFTER[0], 1.1 * LOW_BARE_AFTER[1]]) * TORCHING * burning_share(shot)
    zero, tuft = np.zeros(3), models.instance(np.full(3, models.TUFTS[0]), np.full(3, 3))
    points = dict.fromkeys(("rotation", "pitch", "roll", "tint"), zero) | {"position": np.zeros((3, 3))}
    points |= dict.fromkeys(("scale", "width", "torched", "scorch", "hue", "dead"), zero + 1.0)
    points |= {"tint": np.array([0.0, 0.0, 1.0]), "elevation": zero, "canopy_fuel": zero, "model": tuft}
    points |= {"arrival_time": shot.frames.time(1.0) - age}
    points |= {"snag_model": models.instance(np.full(3, models.STUBBLE[0]), np.full(3, 3))}
    made = library.tree_models(shot, stage, library.drawn(points))
    forest._instances(shot, stage, stage.part("Forest"), "Understorey", points, made)
    seen = [_number(name) for name in _instances("Firetwin Understorey")[2]]
    assert seen == [models.TUFTS[0], models.TUFTS[0], models.STUBBLE[0]]


@pytest.mark.parametrize("part", ["Foliage", "Bark", "Grass"])
def test_rays_from_other_surfaces_meet_plain_plants(shot, stage, part):
    _planted(shot, stage)
    tree = bpy.data.node_groups[f"Firetwin {part} Shader"]
    links = {link.to_socket: link.from_socket for link in tree.links}
    (mix,) = (
        node
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeMixShader"
        and links[node.inputs[0]].name == "Is Camera Ray"
        and links[node.inputs[0]].node.bl_idname == "ShaderNodeLightPath"
    )
    plain = links[mix.inputs[1]].node
    assert plain.bl_idname == "ShaderNodeBsdfDiffuse"
    assert not any(socket.is_linked for socket in plain.inputs)
