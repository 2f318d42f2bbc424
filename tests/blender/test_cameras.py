from dataclasses import replace

import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from firetwin import project as projects
from firetwin.errors import InputError
from firetwin.scene import build, cameras, paths, targets
from mathutils import Vector


def _built(project, run, scene):
    ground, views = build.survey(project, run)
    scene.render.resolution_x, scene.render.resolution_y = project.render.resolution
    return ground, views, cameras.build(project, run, views, scene)


def test_a_camera_looks_at_its_target_in_every_frame(project, run, scene):
    ground, views, (camera,) = _built(project, run, scene)
    target = Vector(ground.point(38.845, -120.55)[0])
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        assert world_to_camera_view(scene, camera, target)[:2] == pytest.approx((0.5, 0.5), abs=1e-3)
        assert camera.matrix_world.col[0].z == pytest.approx(0.0, abs=1e-5)  # a level horizon
        assert camera.location[:] == pytest.approx(views[0].position[frame - 1], abs=0.01)
    assert camera.data.clip_end >= 200_000.0


def test_keys_are_met_at_their_height_over_the_ground(project, run, scene):
    ground, views, _built_cameras = _built(project, run, scene)
    for frame, key in ((0, project.cameras[0].keys[0]), (-1, project.cameras[0].keys[1])):
        below = ground.point(key.latitude, key.longitude)[0]
        assert views[0].position[frame] - below == pytest.approx([0.0, 0.0, key.height], abs=1.0)


def test_a_hill_between_keys_lifts_the_camera(project, run):
    keys = tuple(replace(key, height=20.0) for key in project.cameras[0].keys)
    keys = (keys[0], replace(keys[1], latitude=38.87, longitude=-120.51))
    many = replace(project, cameras=(replace(project.cameras[0], keys=keys),))
    many = replace(many, time=replace(many.time, frames=60))
    ground, (view,) = build.survey(many, run)
    clear = view.position[:, 2] - ground.up(view.position[:, 0], view.position[:, 1])
    assert clear.min() > 5.0


def test_a_camera_that_follows_the_fire_sees_it_over_ridges(project, run):
    keys = tuple(replace(key, height=15.0, target="head") for key in project.cameras[0].keys)
    many = replace(project, cameras=(replace(project.cameras[0], keys=keys),))
    many = replace(many, time=replace(many.time, frames=20))
    ground, (view,) = build.survey(many, run)
    for part in (0.2, 0.4, 0.6, 0.8):
        way = view.position + part * (view.target - view.position)
        assert np.all(way[:, 2] > ground.up(way[:, 0], way[:, 1]))
    hidden = replace(
        many, cameras=(replace(many.cameras[0], keys=tuple(replace(k, target="point") for k in keys)),)
    )
    low = paths.paths(hidden, run, ground)[0]
    assert np.max(view.position[:, 2] - low.position[:, 2]) > 20.0


def test_what_is_in_the_picture_is_seen_and_what_is_far_beside_it_is_not(project, run, scene):
    ground, (view,), (camera,) = _built(project, run, scene)
    places = ground.point(
        *(axis.ravel() for axis in np.meshgrid(run.fuel_latitude[::9], run.fuel_longitude[::9]))
    )
    seen = view.sees(places, margin=0.0)
    for place, verdict in zip(places, seen, strict=True):
        inside = False
        for frame in (1, 2, 3):
            scene.frame_set(frame)
            x, y, depth = world_to_camera_view(scene, camera, Vector(place))
            inside |= 0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 and depth > 0.0
        assert verdict == inside
    assert 0 < seen.sum() < len(seen)


def test_a_satellite_looks_straight_down_on_its_swath(project, run, scene):
    satellite = projects.Camera("goes", "satellite", swath=8000.0)
    _ground, (view,), (camera,) = _built(replace(project, cameras=(satellite,)), run, scene)
    assert camera.data.type == "ORTHO"
    assert camera.data.ortho_scale == 8000.0
    assert camera.matrix_world.col[2][:3] == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert view.sees([[3900.0, 0.0, 1000.0], [4100.0, 0.0, 1000.0]], margin=0.0).tolist() == [True, False]


def test_the_head_is_on_the_front_and_moves_smoothly(project, run):
    ground, _views = build.survey(project, run)
    times = np.linspace(600.0, 3000.0, 40)
    east, north = targets.head(ground, times)
    arrival = ground.sample(np.minimum(ground.arrival, 1e5), east, north)
    assert np.abs(arrival - times)[10:-10].max() < 3000.0
    step = np.hypot(np.diff(east), np.diff(north))
    assert step.max() < 250.0


def test_a_camera_without_keys_is_an_error_that_says_so(project, run):
    lost = replace(project, cameras=(projects.Camera("lost"),))
    with pytest.raises(InputError, match='camera "lost" has no keys'):
        paths.paths(lost, run)
