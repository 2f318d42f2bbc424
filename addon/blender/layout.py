"""Node layout: each frame is a box of columns, inputs left of the nodes that use them, boxes side by side."""

from __future__ import annotations

import bpy

WIDE, GAP = 200.0, 40.0  # spacing of columns, and between boxes and nodes


def arrange(tree: bpy.types.NodeTree) -> None:
    """Arrange the nodes of a tree in which each node was added after its inputs."""
    boxes: dict[str, list[bpy.types.Node]] = {}
    for node in tree.nodes:
        if node.bl_idname != "NodeFrame":
            boxes.setdefault(node.parent.name if node.parent else "", []).append(node)
    if "" in boxes:  # nodes after all frames
        boxes[""] = boxes.pop("")
    feeds: dict[str, list[bpy.types.Node]] = {}
    for link in tree.links:
        feeds.setdefault(link.from_node.name, []).append(link.to_node)
    left, place = 0.0, {}
    for box in boxes.values():
        columns = _columns(box, feeds)
        deepest = max(columns.values())
        below = dict.fromkeys(range(deepest + 1), 0.0)
        for node in box:
            column = columns[node.name]
            place[node.name] = left + WIDE * (deepest - column), below[column]
            below[column] -= height(node) + GAP
        left += WIDE * (deepest + 1) + 2.0 * GAP
    # In bulk: Blender updates the complete tree after each assignment.
    flat = [at for node in tree.nodes for at in place.get(node.name, (0.0, 0.0))]
    tree.nodes.foreach_set("location", flat)


def height(node: bpy.types.Node) -> float:
    """Estimate the height of a node: Blender computes it only when it draws the node."""
    outputs = [socket for socket in node.outputs if socket.enabled and not socket.hide]
    inputs = [socket for socket in node.inputs if socket.enabled and not socket.hide]
    vectors = [s for s in inputs if s.type in ("VECTOR", "ROTATION") and not s.is_linked and not s.hide_value]
    own = 300.0 if node.bl_idname == "ShaderNodeTexImage" else 60.0
    return 30.0 + own + 22.0 * (len(outputs) + len(inputs)) + 66.0 * len(vectors)


def _columns(box: list[bpy.types.Node], feeds: dict[str, list[bpy.types.Node]]) -> dict[str, int]:
    """Return the column of each node, counted from the right: one beyond its users in the same box."""
    columns: dict[str, int] = {}
    for node in reversed(box):
        after = [columns[to.name] + 1 for to in feeds.get(node.name, ()) if to.name in columns]
        columns[node.name] = max(after, default=0)
    return columns
