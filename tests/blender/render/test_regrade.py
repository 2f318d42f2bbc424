"""Nodes of Regrade in a compositor: one set, linked by name, for a film with its frame numbers."""

import bpy
import comp_film
import numpy as np
import pytest
from firetwin.blender import compat, owned
from firetwin.errors import InputError
from firetwin.render import regrade, regrade_nodes
from firetwin_core import sensor


def ours(scene):
    return [node for node in compat.compositor(scene).nodes if owned.is_ours(node)]


def test_layers_are_linked_by_name_and_the_output_is_connected(scene, tmp_path):
    path, _ = comp_film.write(tmp_path)
    node = regrade_nodes.add(scene, path)
    tree = compat.compositor(scene)
    linked = {link.to_socket.name: link.from_socket.name for link in tree.links if link.to_node == node}
    assert linked == {name: name for name in regrade.LAYERS}
    (end,) = (link.to_node for link in tree.links if link.from_node == node)
    assert end.bl_idname == compat.END
    assert (scene.render.resolution_x, scene.render.resolution_y) == (comp_film.WIDTH, comp_film.HEIGHT)


def test_a_second_film_replaces_the_first_and_keeps_the_grade(scene, tmp_path):
    path, _ = comp_film.write(tmp_path)
    node = regrade_nodes.add(scene, path)
    node.inputs["Smoke Density"].default_value = 0.5
    other = path.rename(tmp_path / "other.0101.exr")
    assert regrade_nodes.add(scene, other) == node
    assert node.inputs["Smoke Density"].default_value == 0.5
    assert len(ours(scene)) == 2
    (image,) = (each for each in bpy.data.images if owned.is_ours(each))
    assert image.filepath == str(other)
    assert len([each for each in bpy.data.node_groups if owned.is_ours(each, regrade.MARK)]) == 1


def test_a_frame_of_a_film_shows_the_film(scene, tmp_path):
    comp_film.write(tmp_path)
    for number in (1, 2):
        (tmp_path / f"drone_comp_{number:06d}.exr").rename(tmp_path / f"shot.{number + 1000}.exr")
    (tmp_path / "shot.1009.png").touch()
    regrade_nodes.add(scene, tmp_path / "shot.1002.exr")
    node = next(node for node in ours(scene) if node.bl_idname == "CompositorNodeImage")
    assert node.image.source == "SEQUENCE"
    assert (node.frame_start, node.frame_offset, node.frame_duration) == (1001, 1000, 2)


def test_a_compositor_with_an_output_gets_a_viewer(scene, tmp_path):
    tree = compat.new_compositor(scene)
    shown = tree.nodes.new("CompositorNodeRLayers")
    end = compat.composite(tree, shown.outputs["Image"])
    node = regrade_nodes.add(scene, comp_film.write(tmp_path)[0])
    assert end.inputs[0].links[0].from_node == shown
    (viewer,) = (link.to_node for link in tree.links if link.from_node == node)
    assert viewer.bl_idname == "CompositorNodeViewer"


def test_a_picture_without_layers_is_refused_and_changes_nothing(scene, tmp_path):
    path = tmp_path / "drone_rgb_000001.exr"
    sensor.write_image(path, np.ones((4, 4, 3), np.float32))
    with pytest.raises(InputError, match=r"has no channel smoke\.A; choose an EXR of the pass comp"):
        regrade_nodes.add(scene, path)
    assert compat.compositor(scene) is None
