"""Shadow of the live smoke on the ground, from a picture."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...blender import nodes


@dataclass(frozen=True)
class Shade:
    """Shadow of smoke: a shader group from a position to the part of the light that is left, 0..1."""

    group: bpy.types.NodeTree

    def apply(self, tree: nodes.Tree, colour: nodes.Value, position: nodes.Value) -> nodes.Value:
        """Return a colour that is darker in the shadow."""
        left = tree.output("ShaderNodeGroup", {"Position": position}, "Light", node_tree=self.group)
        return tree.vector("SCALE", colour, left)
