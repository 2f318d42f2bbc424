"""A saved scene shows the same where Blender runs no scripts that come with files, as on farms."""

import bpy
import numpy as np
from firetwin.render import engine
from firetwin.scene import build

KINDS = [name for name, kind in bpy.types.BlendData.bl_rna.properties.items() if kind.type == "COLLECTION"]


def _animated():
    """Every datablock, and every node tree inside one, that is animated."""
    blocks = [block for kind in KINDS for block in getattr(bpy.data, kind)]
    blocks += [tree for block in blocks if (tree := getattr(block, "node_tree", None))]
    return [block for block in blocks if getattr(block, "animation_data", None)]


def test_a_saved_scene_needs_no_scripts(near_shot, near_settings, stage, scene, shoot, tmp_path):
    build.build(near_shot, scene)
    engine.apply(near_settings, scene)
    scene.frame_set(2)
    assert _animated()
    assert not [block for block in _animated() if block.animation_data.drivers]
    assert not bpy.data.texts
    before = [shoot(scene, layer) for layer in ("rgb", "thermal")]
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path, use_scripts=False)
    assert not bpy.app.autoexec_fail
    scene = bpy.context.scene
    for layer, picture in zip(("rgb", "thermal"), before, strict=True):
        np.testing.assert_array_equal(shoot(scene, layer), picture)
    assert np.ptp(before[0]) > 0.0
