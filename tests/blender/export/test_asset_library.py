"""The library in Blender's preferences: the add-on adds one entry and leaves the user's alone."""

import bpy
import firetwin
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.scene import assets
from firetwin.ui import asset_library


@pytest.fixture
def libraries(factory):
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    yield bpy.context.preferences.filepaths.asset_libraries
    firetwin.unregister()
    bpy.ops.wm.read_factory_settings()


def listed(libraries):
    return [(each.name, each.path.rstrip("/")) for each in libraries]


def test_the_library_is_listed_once_and_removed_with_the_add_on(libraries, tmp_path):
    before = listed(libraries)
    asset_library.add(tmp_path / "first")
    asset_library.add(tmp_path / "second")
    assert listed(libraries) == [*before, ("Firetwin", str(tmp_path / "second"))]
    asset_library.unregister()
    assert listed(libraries) == before


def test_libraries_of_the_user_stay(libraries, tmp_path):
    libraries.new(name="Firetwin", directory=str(tmp_path / "mine"))
    libraries.new(name="Same", directory=str(tmp_path / "out"))
    before = listed(libraries)
    asset_library.add(tmp_path / "out")  # the user lists it already
    assert listed(libraries) == before
    asset_library.unregister()
    assert listed(libraries) == before


def test_node_groups_get_the_preview_of_a_material_that_uses_them(libraries):
    group = owned.mark(bpy.data.node_groups.new("Bark", "ShaderNodeTree"))
    plants = owned.mark(bpy.data.node_groups.new("Firetwin Trees", "GeometryNodeTree"))
    material = bpy.data.materials.new("Bark")
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes.new("ShaderNodeGroup").node_tree = group
    tree = bpy.data.objects.new("Large Conifer 1", None)
    for block, value in ((material, 0.25), (tree, 0.75)):
        assets._set_preview(block, np.full(assets._PICTURE**2 * 4, value, np.float32))
    assets._picture_groups(tree)
    assert group.preview.image_pixels_float[0] == pytest.approx(0.25, abs=0.01)
    assert plants.preview.image_pixels_float[0] == pytest.approx(0.75, abs=0.01)
