"""The forest does not end where the run does."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.scene.forest import stand
from firetwin.scene.terrain import build as ground_build
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from mathutils.bvhtree import BVHTree

EDGE = -120.60  # degrees east, of the run's western cells


def looking(longitude, target):
    keys = (CameraKey(0.0, 38.84, longitude, 300.0, "point", 38.84, target, 0.0),)
    return (Camera("drone", Drone(focal_length=18.0, keys=keys)),)


@pytest.fixture
def outward(near_settings, run):
    """A shot of a drone 400 m within the edge that looks over it."""
    own = replace(
        near_settings,
        cameras=looking(EDGE + 0.005, EDGE - 0.01),
        forest=replace(near_settings.forest, budget=20_000),
        render=replace(near_settings.render, resolution=(640, 360)),
    )
    return Shot(own, run)


def half_width(shot):
    """Half of the narrower side of a run, m."""
    fields, cell = shot.ground.fields, shot.ground.cell
    return 0.5 * min(
        (side - 2 * fields.margin) * size for side, size in zip(fields.elevation.shape, cell, strict=True)
    )


def beyond(shot, grown):
    """Find trees outside of the run's grid."""
    return shot.local_frame.reverse(grown.position)[1] < EDGE


def test_trees_stand_beyond_the_edge_as_densely_as_within(outward):
    grown = stand.grow(outward)
    out = beyond(outward, grown)
    assert out.sum() > 200
    ground = outward.ground
    _row, column = ground.indices(*ground.geodetic(grown.position[:, 0], grown.position[:, 1]))
    metres = (column - ground.fields.margin) * ground.cell[1]
    steps = np.histogram(metres, bins=[-300.0, -150.0, 0.0, 150.0])[0]
    assert steps.min() > 0.3 * steps.max()


def test_none_stands_beyond_the_edge_of_a_narrow_apron(outward, run):
    narrow = replace(outward.settings.terrain, apron=half_width(outward) + 300.0)
    shot = Shot(replace(outward.settings, terrain=narrow), run)
    grown = stand.grow(shot)
    assert beyond(shot, grown).sum() > 20
    latitude, longitude = shot.local_frame.reverse(grown.position)[:2]
    edge = shot.ground.fields
    assert edge.longitude[0] < longitude.min()
    assert latitude.max() < edge.latitude[-1]


def test_they_are_the_same_for_another_camera(outward, run):
    other = replace(outward.settings, cameras=looking(EDGE + 0.007, EDGE - 0.012))
    shots = outward, Shot(replace(other, forest=replace(other.forest, budget=10**7)), run)
    found = [stand.grow(shot) for shot in shots]
    keys = [
        {tuple(key) for key in grown.key[beyond(shot, grown)]}
        for shot, grown in zip(shots, found, strict=True)
    ]
    assert len(keys[0] & keys[1]) > 0.6 * len(keys[0])


def test_they_stand_on_the_drawn_ground(outward, stage, plain_looks):
    grown = stand.grow(outward)
    mesh = ground_build.build(outward, stage, grown).data
    tree = BVHTree.FromPolygons(
        [vertex.co for vertex in mesh.vertices], [list(each.vertices) for each in mesh.polygons]
    )
    feet = grown.position[beyond(outward, grown)][::7]
    drawn = np.array([tree.ray_cast((x, y, 9000.0), (0.0, 0.0, -1.0))[0][2] for x, y, _ in feet])
    assert np.percentile(np.abs(drawn - feet[:, 2]), 95) < 1.5


def test_the_papers_forest_is_the_runs_alone(outward, run):
    plain = replace(outward.settings, forest=replace(outward.settings.forest, density="paper"))
    assert len(stand.grow(Shot(plain, run)).height) == 0


def test_nothing_is_grown_beyond_where_no_camera_comes_near(near_settings, run):
    far = replace(near_settings, cameras=looking(-120.55, -120.58))
    shot = Shot(replace(far, forest=replace(far.forest, draw_distance=1200.0)), run)
    grown = stand.grow(shot)
    assert len(grown.height) > 100
    assert not beyond(shot, grown).any()


@pytest.mark.parametrize(("width", "drawn"), [(640, True), (160, False)])
def test_a_satellite_over_the_edge_sees_trees_on_both_sides_or_on_none(outward, run, width, drawn):
    above = Camera("above", Satellite(swath=1200.0, keys=(CameraKey(0.0, 38.84, EDGE),)))
    small = replace(outward.settings.render, resolution=(width, width))
    shot = Shot(replace(outward.settings, cameras=(above,), render=small), run)
    out = beyond(shot, stand.grow(shot))
    assert (0.3 * len(out) < out.sum() < 0.7 * len(out)) if drawn else len(out) == 0
