import bpy
import numpy as np
import pytest
from firetwin.blender import compat, nodes
from firetwin_core import volume


def test_volumes_are_drawn_where_their_grids_are(scene, shoot, tmp_path):
    voxel, count = 10.0, 40
    place = (np.arange(count) - 0.5 * (count - 1)) * voxel
    x, y, z = np.meshgrid(place, place, place, indexing="ij", sparse=True)
    ball = np.clip((100.0 - np.sqrt(x * x + y * y + z * z)) / 60.0 + 0.5, 0.0, 1.0).astype(np.float32)
    volume.write(tmp_path / "ball.vdb", {"density": ball}, voxel, origin=(place[0],) * 3)
    data = bpy.data.volumes.new("ball")
    data.filepath, data.render.space, data.render.step_size = str(tmp_path / "ball.vdb"), "WORLD", 5.0
    material, tree = nodes.material("ball")
    tree.volume(tree.emission((0.01, 0.01, 0.01), tree.attribute("density") > 0.5))
    data.materials.append(material)
    thing = bpy.data.objects.new("ball", data)
    scene.collection.objects.link(thing)
    thing.location = (compat.volume_shift(scene.cycles, voxel),) * 3
    lens = bpy.data.cameras.new("front")
    lens.type, lens.ortho_scale, lens.clip_end = "ORTHO", 400.0, 5000.0
    scene.camera = bpy.data.objects.new("front", lens)
    scene.camera.location, scene.camera.rotation_euler = (0.0, -1000.0, 0.0), (0.5 * np.pi, 0.0, 0.0)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = scene.render.resolution_y = 64
    glow = shoot(scene)[..., 0]
    assert glow[31:33, 31:33].mean() == pytest.approx(2.0, rel=0.05)  # 0.01 W/m3 along 200 m
    row, column = np.indices(glow.shape)
    east, up = (((axis * glow).sum() / glow.sum() - 31.5) * 400.0 / 64.0 for axis in (column, -row + 63))
    assert abs(east) < 0.1 * voxel
    assert abs(up) < 0.1 * voxel
