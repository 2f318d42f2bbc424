"""Rays of built cameras, of every kind, against depth."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.render import engine, rays
from firetwin.scene import build
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.minimap import Minimap
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.cameras.rigs.vr import Vr
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot

KEYS = (CameraKey(0.0, 38.825, -120.56, 400.0, "point", 38.845, -120.55, 0.0),)
RIGS = {
    "drone": Drone(keys=KEYS, bank=1.0),
    "map": Minimap(),
    "satellite": Satellite(swath=9000.0),
    "geostationary": Satellite(swath=9000.0, geostationary=-137.0),
    "vr": Vr(keys=KEYS, interocular=6.5),
}


def rays_of(scene, size, two):
    """Rays of the scene's camera, of both eyes one above the other in stereo."""
    width, height = size
    if not two:
        found = [rays.pixel_rays(scene.camera, scene, height, width, 0)]
    else:
        found = [rays.pixel_rays(scene.camera, scene, height // 2, width, eye) for eye in (-1, 1)]
    origins = [np.broadcast_to(each.origins, each.directions.shape) for each in found]
    return found, np.concatenate(origins), np.concatenate([each.directions for each in found])


@pytest.mark.parametrize("name", RIGS)
def test_a_ray_leads_to_the_point_that_its_depth_tells_of(settings, run, name):
    size = (48, 48) if name == "vr" else (48, 26)
    settings = replace(
        settings,
        cameras=(Camera("one", RIGS[name]),),
        render=replace(settings.render, resolution=size),
    )
    shot = Shot(settings, run)
    stage = owned.adopt(bpy.context.scene)
    build.build(shot, stage.scene, parts=("cameras",))
    engine.apply(settings, stage.scene)
    stage.scene.camera = stage.camera("one")
    stage.scene.frame_set(2)
    bpy.context.view_layer.update()
    random = np.random.default_rng(4)
    away = pixel_rays.path_of(
        shot.paths, "one"
    ).meet  # lines of sight from so far count as parallel near their target
    depth = (away + random.uniform(-2000.0, 2000.0, size[::-1]) + 5000.0 * (away == 0.0)).astype(np.float32)
    eyes, origins, directions = rays_of(stage.scene, size, name == "vr")
    halves = np.split(depth, len(eyes))
    distance = np.concatenate([each.from_depth(half) for each, half in zip(eyes, halves, strict=True)])
    found = origins + directions * distance[..., None]
    expected = pixel_rays.points(pixel_rays.path_of(shot.paths, "one"), 2, depth)
    off = np.linalg.norm(found - expected, axis=-1)
    assert off.max() < (15.0 if away else 0.05), "m; steps of 32 bits are 4 m at 36,000 km"
    assert np.linalg.norm(directions, axis=-1) == pytest.approx(1.0)


def test_the_sky_is_behind_all_smoke(settings, run):
    shot = Shot(settings, run)
    stage = owned.adopt(bpy.context.scene)
    build.build(shot, stage.scene, parts=("cameras",))
    stage.scene.camera = stage.camera("drone")
    found = rays.pixel_rays(stage.scene.camera, stage.scene, 9, 16, 0)
    assert found.from_depth(np.full((9, 16), 1.0e10, np.float32)).min() > 1.0e9


def test_a_camera_is_where_its_own_scene_has_it(settings, run):
    """A file may show another scene than the one that is rendered."""
    shot = Shot(settings, run)
    stage = owned.stage(owned.new_scene())
    build.build(shot, stage.scene, parts=("cameras",))
    assert bpy.context.scene != stage.scene
    stage.scene.camera = stage.camera("drone")
    stage.scene.frame_set(2)
    found = rays.pixel_rays(stage.evaluated(stage.scene.camera), stage.scene, 9, 16, 0)
    assert found.origins == pytest.approx(shot.paths[0].position[1], abs=0.01)
