"""Light in a flow's smoke, solved, against many bounces of forward scattering."""

import bpy
import numpy as np
import pytest
import traced_smoke
from firetwin.blender import compat, nodes
from firetwin.scene.smoke import flow_material
from firetwin.smoke import flow_frames
from firetwin_core import sensor, volume

RADIUS, EXTINCTION, VOXEL = 400.0, 0.02, 50.0  # m, 1/m, m


@pytest.fixture
def ball(shot, stage, scene, tmp_path):
    """A ball of old smoke, 16 deep, under sun and sky; returns what renders it."""
    at = np.arange(-9, 10) * VOXEL
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    density = np.where(x**2 + y**2 + z**2 < RADIUS**2, EXTINCTION, 0.0).astype(np.float32)
    data = bpy.data.volumes.new("ball")
    data.render.space, data.render.step_size = "WORLD", 25.0
    looks = {}
    for lighting, look in (("solved", flow_material), ("traced", traced_smoke)):
        looks[lighting] = look.build(shot, stage)
    data.materials.append(looks["traced"])
    thing = bpy.data.objects.new("ball", data)
    scene.world = bpy.data.worlds.new("sky")
    sky = nodes.Tree(compat.node_tree(scene.world))
    sky.surface(sky.output("ShaderNodeBackground", {"Color": (0.27, 0.27, 0.27), "Strength": 1.0}))
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy = 9.0
    sun = bpy.data.objects.new("sun", lamp)
    eye = bpy.data.cameras.new("eye")
    eye.type, eye.ortho_scale, eye.clip_end = "ORTHO", 900.0, 1e5
    camera = bpy.data.objects.new("eye", eye)
    camera.location, camera.rotation_euler = (0.0, -5000.0, 0.0), (np.radians(90.0), 0.0, 0.0)
    for each in (thing, sun, camera):
        scene.collection.objects.link(each)
    scene.camera = camera

    def fill(lighting, bearing, hide):
        towards = (-np.sin(np.radians(bearing)), -np.cos(np.radians(bearing)), 0.0)
        sunlight, skylight, _ = volume.smoke_light(density, VOXEL, towards, *flow_frames.LIGHT)
        path = tmp_path / f"ball{bearing:.0f}{hide}.vdb"
        grids = {"density": density, "fresh": np.zeros_like(density), "sun": sunlight, "sky": skylight}
        if hide == "behind":
            front = [(0.0, -1.0, 0.0)]
            grids["hidden"], _ = volume.occluded_smoke(
                density, VOXEL, np.empty((0, 3)), front, flow_frames.DEEP
            )
            assert 0.1 < grids["hidden"].sum() / (density > 0.0).sum() < 0.5
        elif hide == "all":
            grids["hidden"] = (density > 0.0).astype(np.float32)
        volume.write(path, grids, VOXEL, (float(at[0]),) * 3, tolerance=1e-6)
        data.filepath, data.materials[0] = str(path), looks[lighting]
        tree = next(node for node in looks["solved"].node_tree.nodes if node.type == "GROUP").node_tree
        tree.animation_data_clear()
        tree.nodes["Sunlight"].outputs[0].default_value = (9.0, 9.0, 9.0, 1.0)
        tree.nodes["Skylight"].outputs[0].default_value = (0.27, 0.27, 0.27, 1.0)
        for socket, part in zip(tree.nodes["Towards the Sun"].inputs, towards, strict=True):
            socket.default_value = part

    def render(bearing, bounces, lighting="solved", hide=""):
        sun.rotation_euler = (np.radians(90.0), 0.0, -np.radians(bearing))
        fill(lighting, bearing, hide)
        scene.render.engine = "CYCLES"
        compat.march_through_volumes(scene.cycles)
        scene.cycles.samples, scene.cycles.use_adaptive_sampling = 64, False
        scene.cycles.use_denoising = False
        scene.cycles.max_bounces = scene.cycles.volume_bounces = bounces
        scene.render.resolution_x = scene.render.resolution_y = 16
        scene.render.resolution_percentage = 100
        compat.still_settings(scene.render)
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = str(tmp_path / "ball.exr")
        bpy.ops.render.render(write_still=True)
        return np.asarray(sensor.read_image(tmp_path / "ball.exr"))[..., 1][4:12, 4:12]  # nothing but smoke

    return render


@pytest.mark.parametrize("bearing", [95.0, 140.0])
def test_solved_light_is_near_many_bounces(ball, bearing):
    ours = ball(bearing, 0)
    truth = ball(bearing, 24, lighting="traced")
    assert np.abs(ours - truth).mean() < 0.3 * truth.mean()


def test_the_side_away_from_the_sun_is_dark(ball):
    lit, shaded = (ball(bearing, 0) for bearing in (0.0, 180.0))
    assert lit.mean() > 2.5 * shaded.mean() > 0.0


def test_smoke_that_is_hidden_shows_no_less(ball):
    whole = ball(95.0, 1)
    assert np.abs(ball(95.0, 1, hide="behind") - whole).mean() < 0.01 * whole.mean()


def test_hidden_smoke_throws_the_same_shadow(ball, scene):
    scene.camera.location = 0.0, 500.0, 0.0  # between the smoke and what its shadow falls on
    bpy.ops.mesh.primitive_plane_add(
        size=4000.0, location=(0.0, 900.0, 0.0), rotation=(0.5 * np.pi, 0.0, 0.0)
    )
    shaded = ball(0.0, 1)
    assert shaded.max() < 0.3 * 9.0 / np.pi
    assert ball(0.0, 1, hide="all") == pytest.approx(shaded, rel=1e-4)
