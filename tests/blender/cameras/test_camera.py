from dataclasses import replace

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from firetwin.blender import compat, owned
from firetwin.scene.camera import build as cameras
from firetwin.shot.cameras import targets
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.cameras.rigs.lookout import Lookout, LookoutKey
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import lod
from mathutils import Vector


def _built(shot, stage):
    render = stage.scene.render
    render.resolution_x, render.resolution_y = shot.settings.render.resolution
    return cameras.build(shot, stage)


def _with_keys(settings, run, frames, **changes):
    """A shot of many frames whose drone has these keys and other settings."""
    (camera,) = settings.cameras
    camera = replace(camera, rig=replace(camera.rig, **changes))
    return Shot(replace(settings, cameras=(camera,), time=replace(settings.time, frames=frames)), run)


def test_a_camera_looks_at_its_target_in_every_frame(shot, stage, scene):
    (camera,) = _built(shot, stage)
    target = Vector(shot.ground.point(38.845, -120.55)[0])
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        assert world_to_camera_view(scene, camera, target)[:2] == pytest.approx((0.5, 0.5), abs=1e-3)
        assert camera.matrix_world.col[0].z == pytest.approx(0.0, abs=1e-5)  # a level horizon
        assert camera.location[:] == pytest.approx(shot.paths[0].position[frame - 1], abs=0.01)
    assert camera.data.clip_end >= 20_000.0 * 2.0**0.5  # the apron's corners


def test_keys_are_met_at_their_height_over_the_ground(shot):
    keys = shot.camera("drone").rig.keys
    for frame, key in ((0, keys[0]), (-1, keys[1])):
        below = shot.ground.point(key.latitude, key.longitude)[0]
        assert shot.paths[0].position[frame] - below == pytest.approx([0.0, 0.0, key.height], abs=1.0)


def test_few_keys_with_handles_go_where_the_path_goes(settings, run, stage, scene):
    """All of 240 frames are within 5 mm and a twentieth of a pixel of the path."""
    shot = _with_keys(settings, run, 240, bank=1.0)
    (camera,), (view,) = _built(shot, stage), shot.paths
    curves = compat.fcurves(camera)
    assert {curve.data_path for curve in curves} == {"location", "rotation_quaternion"}
    for curve in curves:
        assert 2 <= len(curve.keyframe_points) < 80
        assert {point.handle_left_type for point in curve.keyframe_points} == {"ALIGNED"}
    moved, turned = [], []
    for frame in range(1, 241, 7):
        scene.frame_set(frame)
        matrix = np.array(camera.matrix_world)
        moved.append(np.linalg.norm(matrix[:3, 3] - view.position[frame - 1]))
        turned.append(np.linalg.norm(matrix[:3, 2] - view.rotation[frame - 1, :, 2]))
    pixel = 2.0 * view.half[0] / shot.settings.render.resolution[0]
    print(f"{len(curves[0].keyframe_points)} and {len(curves[3].keyframe_points)} keys, {max(moved):.4f} m")
    assert max(moved) < 0.005 + 0.001  # and the error of a float32
    assert max(turned) < 0.05 * pixel + 1e-6


def test_a_lookout_zooms_and_a_far_satellite_has_a_long_lens(settings, run, stage, scene):
    keys = (LookoutKey(0.0, 40.0), LookoutKey(1.0, 40.0, zoom=4.0))
    rigs = {
        "tower": Lookout(50.0, 25.0, latitude=38.83, longitude=-120.57, keys=keys),
        "goes": Satellite(swath=8000.0, geostationary=-137.0),
    }
    cameras_of_both = tuple(Camera(name, rig) for name, rig in rigs.items())
    shot = Shot(replace(settings, cameras=cameras_of_both), run)
    tower, goes = _built(shot, stage)
    for frame, lens in ((1, 50.0), (2, 100.0), (3, 200.0)):
        scene.frame_set(frame)
        assert tower.data.lens == pytest.approx(lens, rel=1e-4)
    assert tower.data.sensor_width == 25.0
    assert goes.data.type == "PERSP"
    assert goes.data.lens / 18.0 * 4000.0 == pytest.approx(shot.paths[1].meet, rel=1e-6)
    assert goes.animation_data is None


def test_a_hill_between_keys_lifts_the_camera(settings, run):
    keys = tuple(replace(key, height=20.0) for key in settings.cameras[0].rig.keys)
    keys = (keys[0], replace(keys[1], latitude=38.87, longitude=-120.51))
    shot = _with_keys(settings, run, 60, keys=keys)
    (view,) = shot.paths
    clear = view.position[:, 2] - shot.ground.up(view.position[:, 0], view.position[:, 1])
    assert clear.min() > 5.0


def test_a_camera_that_follows_the_fire_sees_it_over_ridges(settings, run):
    keys = tuple(replace(key, height=15.0, target="head") for key in settings.cameras[0].rig.keys)
    shot = _with_keys(settings, run, 20, keys=keys, over_ridges=True)
    (view,) = shot.paths
    for part in (0.2, 0.4, 0.6, 0.8):
        way = view.position + part * (view.target - view.position)
        assert np.all(way[:, 2] > shot.ground.up(way[:, 0], way[:, 1]))
    low = _with_keys(settings, run, 20, keys=keys).paths[0]
    assert np.max(view.position[:, 2] - low.position[:, 2]) > 20.0


def test_what_is_in_the_picture_is_seen_and_what_is_far_beside_it_is_not(shot, run, stage, scene):
    (camera,), (view,) = _built(shot, stage), shot.paths
    places = shot.ground.point(
        *(axis.ravel() for axis in np.meshgrid(run.fuel_latitude[::9], run.fuel_longitude[::9]))
    )
    seen = lod.visible_mask(places, 0.0, lod.ViewSet(view.position, view.rotation, view.half))
    assert not (shot.visibility.visible_mask(places, 0.0) & ~seen).any()
    for place, verdict in zip(places, seen, strict=True):
        inside = False
        for frame in (1, 2, 3):
            scene.frame_set(frame)
            x, y, depth = world_to_camera_view(scene, camera, Vector(place))
            inside |= 0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 and depth > 0.0
        assert verdict == inside
    assert 0 < seen.sum() < len(seen)


def test_a_satellite_looks_straight_down_on_its_swath(settings, run, stage):
    shot = Shot(replace(settings, cameras=(Camera("goes", Satellite(swath=8000.0)),)), run)
    (camera,) = _built(shot, stage)
    assert camera.data.type == "ORTHO"
    assert camera.data.ortho_scale == 8000.0
    assert camera.matrix_world.col[2][:3] == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    edge = [[3900.0, 0.0, 1000.0], [4100.0, 0.0, 1000.0]]
    assert shot.visibility.visible_mask(edge, 0.0, pixel=np.inf).tolist() == [True, False]
    assert not shot.visibility.visible_mask(edge, 0.0, pixel=100.0).any()  # 8 km / 64 pixels = 125 m


def test_the_head_is_on_the_front_and_moves_smoothly(shot):
    ground = shot.ground
    times = np.linspace(600.0, 3000.0, 40)
    east, north = targets.head(ground, times)
    arrival = ground.sample(np.minimum(ground.arrival, 1e5), east, north)
    assert np.abs(arrival - times)[10:-10].max() < 3000.0
    step = np.hypot(np.diff(east), np.diff(north))
    assert step.max() < 250.0


def test_a_drone_without_keys_is_an_error_that_says_so():
    where, reason = Camera("lost", Drone()).validate()
    assert where == ("keys",)
    assert 'camera "lost" has no [[cameras.keys]]' in reason


def test_cameras_with_long_names_are_found_by_their_marks(settings, run, stage):
    names = ["c" * 100, "d" * 60 + "e" * 40, "d" * 60 + "f" * 40]
    keys = settings.cameras[0].rig.keys
    rigs = [Drone(20.0 + k, keys=keys) for k in range(3)]
    cameras_of_all = tuple(Camera(name, rig) for name, rig in zip(names, rigs, strict=True))
    shot = Shot(replace(settings, cameras=cameras_of_all), run)
    for _ in range(2):
        built = _built(shot, stage)
        assert [stage.camera(name) for name in names] == built
        assert [thing.data.lens for thing in built] == pytest.approx([20.0, 21.0, 22.0])
        assert len(bpy.data.objects) == len(bpy.data.cameras) == 3
    assert stage.camera("d" * 60) is None


def test_our_camera_is_looked_through_unless_the_artist_has_another(shot, scene):
    mine = bpy.data.objects.new("mine", bpy.data.cameras.new("mine"))
    scene.collection.objects.link(mine)
    stage = owned.stage(scene)
    (ours,) = cameras.build(shot, stage)
    assert scene.camera == ours
    scene.camera = mine
    cameras.build(shot, stage)
    assert scene.camera == mine
    cameras.build(shot, owned.adopt(scene))
    assert scene.camera == mine
