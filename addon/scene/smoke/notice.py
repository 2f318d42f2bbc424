"""Notice of missing smoke: letters in the picture if a frame of a .blend file has no smoke volume.

Blender renders a volume object without a file as empty air. Geometry nodes therefore test for the marker of a
frame's volumes (`bake.marker`) at every frame, in the viewport and in renders, also without the add-on.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from ...blender import nodes, owned
from ...blender.mesh import create_mesh
from ...blender.nodes import Tree, Value
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...smoke import bake
from ..labels import facing, lettering, material

NAME = "Smoke Notice"
_LINES = ("No smoke: its volume is missing", "Firetwin > Smoke of frames, or: firetwin bake --volumes")
_SIZES = 0.05, 0.03  # letter heights, heights of the picture
_COLOURS = {"Letters": (1.0, 0.55, 0.05), material.RIM: material.COLOURS[material.RIM]}
_AWAY = 10.0  # distance from the camera, clip starts
_DIGITS = "######"


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Smoke Notice" next to the volumes; None without smoke."""
    collection = next((child for child in stage.root.children if owned.is_ours(child, "Smoke")), None)
    volumes = [obj for obj in stage.objects_of("Smoke") if obj.type == "VOLUME"]
    if collection is None or not volumes:
        return None
    looks = [material.build(shot, name, colour, NAME) for name, colour in _COLOURS.items()]
    letters = owned.library(NAME)
    with lettering.typeface() as font:
        parts = [
            lettering.letters(line, y, rim, front, font, look, size / _SIZES[0])
            for line, size, y in zip(_LINES, _SIZES, (0.2, -1.0), strict=True)
            for rim, front, look in ((0.0, 0.02, 0), (lettering.rim(shot, size), 0.0, 1))
        ]
    lettering.camera_rays_only(owned.add(letters, NAME, lettering.mesh(f"Firetwin {NAME}", parts, looks)))
    obj = owned.add(collection, NAME, create_mesh(f"Firetwin {NAME}", np.zeros((1, 3))), NAME)
    obj.hide_select = True
    lettering.camera_rays_only(obj)
    modifier = obj.modifiers.new(NAME, "NODES")
    modifier.node_group = _node_group(shot, letters, volumes[-1].data)
    return obj


def _node_group(shot: Shot, letters: bpy.types.Collection, volume: bpy.types.Volume) -> bpy.types.NodeTree:
    """Make nodes that put the letters in front of the active camera if the frame's marker is missing."""
    tree, entry = nodes.geometry(f"Firetwin {NAME}")
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.node("GeometryNodeObjectInfo", {"Object": camera}, transform_space="ORIGINAL")
    lens = tree.node("GeometryNodeCameraInfo", {"Camera": camera})
    ahead = tree.combine(0.0, 0.0, tree.pick(lens, "Clip Start") * -_AWAY)
    turned = tree.output(
        "FunctionNodeRotateVector", {"Vector": ahead, "Rotation": tree.pick(eye, "Rotation")}
    )
    place = tree.vector("ADD", tree.pick(eye, "Location"), turned)
    points = tree.output("GeometryNodeSetPosition", {"Geometry": entry, "Position": place})
    inputs = {"Geometry": points, "Name": material.FADE, "Value": 1.0}
    points = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type="FLOAT", domain="POINT")
    view = facing.read_camera(tree)
    width, height = shot.settings.render.resolution
    scale = view.wide * (_SIZES[0] * height / width)
    notice = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": points,
            "Selection": _is_missing(tree, volume),
            "Instance": tree.output("GeometryNodeCollectionInfo", {"Collection": letters}),
            "Rotation": view.rotation,
            "Scale": tree.combine(scale, scale, scale),
        },
    )
    tree.geometry(notice)
    return tree.node_tree


def _is_missing(tree: Tree, volume: bpy.types.Volume) -> Value:
    """Return 1 in frames of the smoke whose marker does not exist."""
    frame = tree.output("GeometryNodeInputSceneTime", name="Frame")
    number = tree.output("FunctionNodeValueToString", {"Value": frame + 10.0 ** len(_DIGITS), "Decimals": 0})
    digits = tree.output("FunctionNodeSliceString", {"String": number, "Position": 1, "Length": len(_DIGITS)})
    path = tree.node("FunctionNodeReplaceString", {"Find": _DIGITS, "Replace": digits})
    path.label = NAME
    owned.mark(path, NAME)
    _set_path(path, volume.filepath)
    text = tree.output("GeometryNodeImportText", {"Path": tree.pick(path)})
    length = tree.output("FunctionNodeStringLength", {"String": text})
    within = (frame > 0.5) * (frame < volume.frame_duration + 0.5)
    return within * (length < 0.5)


def set_folder(stage: Stage, volume_file: str) -> None:
    """Let the notice test for the markers next to this volume file."""
    groups = [modifier.node_group for obj in _notices(stage) for modifier in obj.modifiers]
    for node in (node for group in groups if group for node in group.nodes):
        if owned.is_ours(node, NAME):
            _set_path(node, volume_file)


def update(stage: Stage) -> None:
    """Let Blender evaluate the notice again."""
    for obj in _notices(stage):
        obj.update_tag()


def _notices(stage: Stage) -> list[bpy.types.Object]:
    return [obj for obj in stage.objects_of("Smoke") if owned.is_ours(obj, NAME)]


def _set_path(node: bpy.types.Node, volume_file: str) -> None:
    name = bake.marker(bake.volume_path(Path("."), 0)).name.replace("0" * len(_DIGITS), _DIGITS)
    folder = volume_file.replace("\\", "/").rpartition("/")[0]
    node.inputs["String"].default_value = f"{folder}/{name}"
