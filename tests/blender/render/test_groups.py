"""Compositor node groups against the core on the same pictures: within 1e-5, one step of 8 bits."""

from dataclasses import replace

import bpy
from firetwin.blender import owned
from firetwin.render import groups


def test_groups_explain_their_inputs_and_are_made_once(stage, settings):
    groups.build(settings, stage)
    trees = [value for name, value in stage.root.items() if name.startswith("group ")]
    assert [tree.name for tree in trees] == [
        "Firetwin Thermal Blend",
        "Firetwin Thermal Camera",
        "Firetwin Eye Dome",
        "Firetwin Overlay",
        "Firetwin Regrade",
    ]
    for tree in trees:
        sockets = [item for item in tree.interface.items_tree if item.item_type == "SOCKET"]
        assert all(item.description for item in sockets if item.in_out == "INPUT")
        assert any(item.item_type == "PANEL" for item in tree.interface.items_tree)
        assert tree.description
    trees[0].nodes[0].label = "an artist's"
    groups.build(replace(settings, thermal=replace(settings.thermal, band="mwir")), stage)
    assert [value for name, value in stage.root.items() if name.startswith("group ")] == trees
    assert trees[0].nodes[0].label == "an artist's"
    owned.remove(stage.scene)
    assert not bpy.data.node_groups
