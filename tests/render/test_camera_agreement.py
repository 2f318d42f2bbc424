"""Depth, pose and terrain of every kind of camera agree: what two of them see of one place is that place."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from firetwin.render import engine, layers
from firetwin.render.picture import Picture
from firetwin.scene import curved_air
from firetwin.scene.camera import build as cameras
from firetwin.scene.terrain import build as ground
from firetwin.shot.cameras import rigs
from firetwin.shot.cameras.rigs.chase import Chase
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.globe import Globe
from firetwin.shot.cameras.rigs.lookout import Lookout, LookoutKey
from firetwin.shot.cameras.rigs.minimap import Minimap
from firetwin.shot.cameras.rigs.mounted import Mounted
from firetwin.shot.cameras.rigs.orbit import Orbit
from firetwin.shot.cameras.rigs.poses import PoseKey, Poses
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.cameras.rigs.tour import Stop, Tour
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor
from mathutils import Vector

WIDTH, HEIGHT, FRAME = 160, 90, 2
RIGS = {
    "drone": Drone(8.8, 13.2, bank=1.0, vibration=1.0, keys=(
        CameraKey(0.0, 38.810, -120.58, 900.0, "fire"),
        CameraKey(0.6, 38.815, -120.57, 900.0, "fire"),
        CameraKey(1.0, 38.830, -120.58, 900.0, "fire"))),
    "orbit": Orbit(radius=3000.0, height=1500.0),
    "lookout": Lookout(latitude=38.815, longitude=-120.59, height=400.0,
                       keys=(LookoutKey(0.0, 20.0, 15.0), LookoutKey(1.0, 70.0, 15.0, 3.0))),
    "chase": Chase(distance=2500.0, height=1200.0),
    "mounted": Mounted(follows="drone", focal_length=20.0),
    "poses": Poses(keys=(PoseKey(0.0, 38.810, -120.57, 2600.0, 30.0, 25.0, 5.0),
                         PoseKey(1.0, 38.815, -120.57, 2500.0, 40.0, 25.0, lens=40.0))),
    "tour": Tour(stops=(Stop("ignition", distance=2500.0, height=1200.0),
                        Stop("head", distance=2500.0, height=1200.0))),
    "globe": Globe(begin_latitude=38.82, begin_longitude=-120.57, begin_height=8000.0, latitude=38.84,
                   longitude=-120.55, distance=2500.0, height=1500.0, hold=0.0, stay=0.0),
    "minimap": Minimap(follows="drone", swath=3000.0),
    "satellite": Satellite(swath=6000.0),
    "geostationary": Satellite(swath=6000.0, geostationary=-137.0),
}  # fmt: skip


def slopes(view):
    """Return the distances (2,) of the picture's edges from its centre, m per m of depth, or m."""
    return view.halves[FRAME - 1] / (view.meet or 1.0)


def placed(view, share, depth):
    """Places (n, 3) at shares (n, 2) of the picture (-1..1 to the right and up) and depths (n,)."""
    turn = view.rotation[FRAME - 1]
    plane = share * slopes(view) * (depth[:, None] if view.perspective or view.meet else 1.0)
    return view.position[FRAME - 1] + plane @ turn[:, :2].T - depth[:, None] * turn[:, 2]


def pixels(view, place):
    """Return the positions (n, 2) of points in the picture, pixels from its centre."""
    local = (place - view.position[FRAME - 1]) @ view.rotation[FRAME - 1]
    near = -local[:, 2:] if view.perspective or view.meet else 1.0
    return local[:, :2] / near / slopes(view) * [WIDTH / 2, HEIGHT / 2]


@pytest.fixture
def seen(settings, run, stage, scene, tmp_path):
    """The shot, and of each camera its object and the places (n, 3) that its depth and its pose give."""
    settings = replace(
        settings,
        cameras=tuple(Camera(name, rig) for name, rig in RIGS.items()),
        render=replace(settings.render, resolution=(WIDTH, HEIGHT), passes=("depth",)),
    )
    shot = Shot(settings, run)
    curved_air.set_frame(stage, shot.local_frame)
    ground.build(shot, stage, None)
    built = cameras.build(shot, stage)
    layers.build(settings, stage)
    engine.apply(settings, scene)
    layers.select(scene, ["depth"])
    row, column = (v.ravel() for v in np.indices((HEIGHT, WIDTH)))
    share = np.stack([(column + 0.5) / WIDTH * 2 - 1, 1 - (row + 0.5) / HEIGHT * 2], axis=-1)
    views = {}
    for view, camera in zip(shot.paths, built, strict=True):
        scene.camera = camera
        scene.frame_set(FRAME)
        picture = Picture(view.camera.name, FRAME, "depth")
        layers.write_exr(scene, str(tmp_path), [picture])
        with engine.pixel_centres(scene):
            bpy.ops.render.render(scene=scene.name)
        depth = np.asarray(sensor.read_image(tmp_path / f"{picture.stem()}{FRAME:06d}.exr"))[..., 0].ravel()
        place = placed(view, share, depth.astype(np.float64))
        views[view.camera.name] = camera, view, place[(depth < 1e9)]
    return shot, views


def test_depth_pose_and_terrain_agree_in_every_kind_of_camera(seen, scene):
    shot, views = seen
    assert {view.camera.kind for _, view, _ in views.values()} >= set(rigs.kinds()) - {"vr"}
    for name, (_, view, place) in views.items():
        inside = np.abs(place[:, :2]).max(axis=1) < 4000.0
        assert inside.sum() > 1000, name
        earth = np.copy(place[inside])
        earth[:, 2] = shot.ground.up(earth[:, 0], earth[:, 1])
        off = np.linalg.norm(pixels(view, earth) - pixels(view, place[inside]), axis=1)
        print(f"{name}: 99 of 100 within {np.percentile(off, 99):.3f} pixels, all within {off.max():.3f}")
        assert np.percentile(off, 99) < 1.0, name
        place = earth[:: max(len(earth) // 40, 1)]
        for other, (camera, there, _) in views.items():  # where Blender itself projects the place
            scene.frame_set(FRAME)
            theirs = [world_to_camera_view(scene, camera, Vector(each))[:2] for each in place]
            ours = pixels(there, place) / [WIDTH, HEIGHT] + 0.5
            shown = np.all(np.abs(ours - 0.5) < 0.5, axis=1)
            local = (place - there.position[FRAME - 1]) @ there.rotation[FRAME - 1]
            shown &= local[:, 2] < 0.0
            error = np.abs((np.array(theirs) - ours) * [WIDTH, HEIGHT])[shown]
            angle = there.pixel / (there.meet or 1.0) if there.perspective or there.meet else np.inf
            limit = 0.1 + 2.0**-23 / angle  # Blender's rotations are of 32 bits
            assert np.max(error, initial=0.0) < limit, (name, other, error.max(), limit)
            print(f"  {other}: {shown.sum()} of {len(shown)}, {np.max(error, initial=0.0):.4f} pixels")
