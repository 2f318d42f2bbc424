import bpy
import numpy as np
from firetwin.scene import build

KINDS = ("objects", "meshes", "materials", "node_groups", "lights", "cameras", "worlds", "collections")
KINDS += ("actions", "volumes")


def _names():
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in KINDS}


def test_building_twice_makes_the_same_scene_once(near_shot, stage, scene):
    build.build(near_shot, scene)
    first = _names()
    build.build(near_shot, scene)
    assert _names() == first
    ours = [name for kind in KINDS for name in first[kind]]
    assert all(name.startswith("Firetwin") for name in ours)


def test_the_scene_is_grouped(shot, stage, scene):
    build.build(shot, scene)
    parts = {child.name for child in bpy.data.collections["Firetwin"].children}
    assert {f"Firetwin {part}" for part in ("Ground", "Forest", "Cameras", "Light")} <= parts
    assert scene.camera.name == "Firetwin Camera drone"
    assert (scene.frame_start, scene.frame_end) == (1, 3)


def test_the_ground_is_warm_the_edge_hot_and_the_sky_cold_in_the_thermal_layer(shot, stage, scene, shoot):
    build.build(shot, scene)
    scene.frame_set(2)
    kelvin = shoot(scene, "thermal")[..., 0]
    assert np.isclose(kelvin, 250.0, atol=0.1).any()
    ground = kelvin[kelvin > 280.0]  # below: pixels that the horizon crosses
    assert 285.0 < np.quantile(ground, 0.02) < 310.0
    assert ground.max() < 1600.0
    assert (ground > 500.0).any()
