"""Node groups that people can read: inputs that are explained, and nodes that lie in order."""

import itertools

import bpy
import pytest
from firetwin.blender import layout


@pytest.fixture
def groups(built):
    """Node groups of materials and shapes of a built scene; from 5.0 on the compositor is a group too."""
    return [group for group in bpy.data.node_groups if group.bl_idname != "CompositorNodeTree"]


def test_a_material_is_one_group_whose_inputs_are_explained(groups):
    for material in bpy.data.materials:
        kinds = sorted(node.type for node in material.node_tree.nodes)
        assert kinds == ["GROUP", "OUTPUT_MATERIAL"], material.name
    sockets = [
        item
        for group in groups
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.parent.name
    ]
    assert len(sockets) > 40
    assert all(item.description and not item.description.endswith(".") for item in sockets)


def test_nodes_do_not_overlap_and_lie_right_of_what_they_are_made_of(groups):
    assert len(groups) > 8
    for group in groups:
        placed = [node for node in group.nodes if node.bl_idname != "NodeFrame"]
        for link in group.links:
            if link.from_node.parent == link.to_node.parent:
                assert link.from_node.location.x < link.to_node.location.x, group.name
        columns = itertools.groupby(
            sorted(placed, key=lambda node: (node.location.x, -node.location.y)), lambda node: node.location.x
        )
        for _, column in columns:
            for upper, lower in itertools.pairwise(column):
                assert upper.location.y - layout.height(upper) >= lower.location.y, (group.name, upper.name)
