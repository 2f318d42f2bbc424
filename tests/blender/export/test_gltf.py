"""A glTF scene of an export, read by Blender's importer."""

from __future__ import annotations

import bpy
import numpy as np
import small_gltf


def test_blenders_importer_puts_trees_and_the_camera_where_they_are(factory, tmp_path):
    shot, content, _, scene, _ = small_gltf.write(tmp_path)
    bpy.ops.import_scene.gltf(filepath=str(scene), loglevel=50)
    bpy.context.view_layer.update()
    trees = [
        obj for obj in bpy.data.objects if obj.data and obj.data.name.startswith("large_00_living_level")
    ]
    place = np.array([obj.matrix_world.translation for obj in trees])
    (plants,) = content.plants
    apart = np.linalg.norm(place[:, None] - plants.position[None], axis=2)
    assert len(trees) == len(plants.position)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 0.01
    tree = trees[0]
    height = tree.matrix_world.to_scale()[2]
    np.testing.assert_allclose(height, plants.height[apart[0].argmin()], rtol=1e-4)
    (camera,) = [obj for obj in bpy.data.objects if obj.type == "CAMERA"]
    path = shot.paths[0]
    for frame in (0, 3):
        bpy.context.scene.frame_set(frame)
        moved = np.array(camera.matrix_world)
        assert np.abs(moved[:3, 3] - path.position[frame]).max() < 0.01
        np.testing.assert_allclose(moved[:3, :3], path.rotation[frame], atol=1e-5)
    assert bpy.data.images["ground"].size[0] > 0
