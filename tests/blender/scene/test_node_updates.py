"""Node trees that Blender updates once, at their end: the same trees, and nothing is left."""

from types import SimpleNamespace

import bpy
import pytest
from firetwin.blender import nodes
from firetwin.blender.node_updates import DeferredUpdates
from firetwin.scene import build


def _draw(tree):
    """Build a part with sockets that depend on properties, inputs of the group, and a nested group."""
    group = bpy.data.node_groups.new("inner", "ShaderNodeTree")
    group.interface.new_socket("Double", in_out="OUTPUT", socket_type="NodeSocketFloat")
    inner = nodes.Tree(group)
    inner.finish({"Double": inner.input("Value", 1.0, "A number") * 2.0})
    power = tree.input("Power", 2.0, "How bright it is", "Light", most=10.0)
    with tree.frame("Colour"):
        grey = tree.math("MULTIPLY_ADD", power, 0.5, 0.25).smoothstep(0.0, 1.0)
        colour = tree.mix_colour(grey, (1.0, 0.5, 0.25), (0.0, 0.0, 1.0))
        length = tree.vector("LENGTH", tree.combine(grey, 1.0, 2.0), name="Value")
    double = tree.output("ShaderNodeGroup", {"Value": length}, node_tree=inner.node_tree)
    tree.surface(tree.emission(colour, double.clamp()))


def _described(tree):
    """Return kinds, values and links of the nodes of a tree."""
    place = {node.as_pointer(): index for index, node in enumerate(tree.nodes)}
    sockets = [
        (
            node.bl_idname,
            socket.name,
            socket.enabled,
            socket.is_linked,
            str(getattr(socket, "default_value", "")),
        )
        for node in tree.nodes
        for socket in node.inputs
    ]
    ends = [
        (
            place[link.from_node.as_pointer()],
            link.from_socket.name,
            place[link.to_node.as_pointer()],
            link.to_socket.name,
        )
        for link in tree.links
    ]
    return sockets, ends, [(item.name, item.item_type) for item in tree.interface.items_tree]


def test_a_material_is_the_same_with_and_without_an_update_after_every_change(scene):
    _, deferred = nodes.material("deferred")
    _, updated = nodes.material("updated")
    updated._deferred.end(updated.node_tree)
    updated._deferred = None
    _draw(updated)
    _draw(deferred)
    found, expected = _described(deferred.node_tree), _described(updated.node_tree)
    assert found == expected
    assert len(expected[1]) == 10
    assert {tree.bl_idname for tree in bpy.data.node_groups} == {"ShaderNodeTree"}
    assert not hasattr(bpy.types, "FiretwinNodeUpdates")


def test_an_error_of_a_change_is_raised(scene):
    tree, changes = bpy.data.node_groups.new("tree", "ShaderNodeTree"), DeferredUpdates()
    with pytest.raises(RuntimeError, match="NoSuchNode"):
        changes.change(tree.nodes.new, "NoSuchNode")
    changes.end(tree)


def test_a_build_that_fails_within_a_material_leaves_nothing(scene, monkeypatch):
    def fail(*_):
        nodes.material("unfinished")[1].math("ADD", 1.0, 2.0)
        raise ValueError("in a material")

    monkeypatch.setattr(build.clock, "build", fail)
    with pytest.raises(ValueError, match="in a material"):
        list(build.steps(SimpleNamespace(paths=(), beyond=False), scene))
    assert {tree.bl_idname for tree in bpy.data.node_groups} <= {"ShaderNodeTree", "GeometryNodeTree"}
    assert not hasattr(bpy.types, "FiretwinNodeUpdates")
