"""Nodes that grade a film of the pass `comp` in a scene's compositor: an Image node, Regrade and an output.

The output is a Viewer if the compositor has an output already. Other nodes of the user are unchanged.
"""

from __future__ import annotations

import re
from pathlib import Path

import bpy
from firetwin_core import sensor

from ..blender import compat, owned
from ..errors import input_error
from . import regrade

_NUMBERED = re.compile(r"(.*?)(\d+)(\.exr)", re.IGNORECASE)
_WIDTH, _GAP = 240.0, 60.0  # units of the node editor


def add(scene: bpy.types.Scene, path: Path) -> bpy.types.Node:
    """Add the nodes for a file and the other frames of its film, and return the node of the group.

    The nodes of an earlier call show this film, and keep their settings.

    Raises
    ------
    InputError
        The file is not an image, or has no layers of `comp`.
    """
    channels = sensor.read_channels(path)
    needed = ["smoke.A", *(f"{layer}.R" for layer in regrade.LAYERS[:-1])]
    if missing := [name for name in needed if name not in channels]:
        raise input_error(path, f"has no channel {missing[0]}; choose an EXR of the pass comp")
    tree = compat.compositor(scene)
    if tree is None:
        tree = compat.new_compositor(scene)
        owned.unmark(tree)
        height, width = channels[needed[0]].shape
        scene.render.resolution_x, scene.render.resolution_y = width, height
        scene.render.resolution_percentage = 100
    source = _find(tree, "CompositorNodeImage", "film")
    _show_film(source, path)
    grade = _find(tree, "CompositorNodeGroup", "group")
    grade.node_tree = regrade.group()
    grade.label = regrade.NAME
    for name in regrade.LAYERS:
        tree.links.new(compat.find_socket(source.outputs, name), compat.find_socket(grade.inputs, name))
    _connect(tree, compat.find_socket(grade.outputs, "Image"))
    return grade


def _find(tree: bpy.types.NodeTree, kind: str, what: str) -> bpy.types.Node:
    """Return our node of this purpose, created on first use to the right of all other nodes."""
    mark = f"{regrade.MARK} {what}"
    found = next((node for node in tree.nodes if owned.is_ours(node, mark)), None)
    if found is not None:
        return found
    right = max((node.location.x + node.width for node in tree.nodes), default=-_GAP)
    made = owned.mark(tree.nodes.new(kind), mark)
    made.name = f"{regrade.NAME} {what.capitalize()}"
    made.location, made.width = (right + _GAP, 0.0), _WIDTH
    return made


def _show_film(node: bpy.types.Node, path: Path) -> None:
    """Show a file in an Image node, or the film of its frames, at the scene's frame of equal number."""
    before = node.image
    image = owned.mark(bpy.data.images.load(str(path)))
    node.image = image
    numbers = frame_numbers(path)
    if len(numbers) > 1:
        image.source = "SEQUENCE"
        node.frame_start, node.frame_offset = numbers[0], numbers[0] - 1
        node.frame_duration = numbers[-1] - numbers[0] + 1
    if before is not None and owned.is_ours(before) and not before.users:
        bpy.data.images.remove(before)


def frame_numbers(path: Path) -> list[int]:
    """List the frames of the film to which a file belongs, in order; empty if its name has no number."""
    own = _NUMBERED.fullmatch(path.name)
    if own is None:
        return []
    found = (_NUMBERED.fullmatch(each.name) for each in path.parent.iterdir())
    return sorted(int(each[2]) for each in found if each and (each[1], each[3]) == (own[1], own[3]))


def _connect(tree: bpy.types.NodeTree, image: bpy.types.NodeSocket) -> None:
    """Connect the picture to the compositor's output if it is free, else to a Viewer."""
    if image.is_linked:
        return
    ends = [node for node in tree.nodes if node.bl_idname == compat.END]
    if not ends:
        end = compat.composite(tree, image)
        end.location = image.node.location.x + _WIDTH + _GAP, 0.0
    elif (free := next((node for node in ends if not node.inputs[0].is_linked), None)) is not None:
        tree.links.new(image, free.inputs[0])
    else:
        viewer = _find(tree, "CompositorNodeViewer", "viewer")
        tree.links.new(image, viewer.inputs[0])
