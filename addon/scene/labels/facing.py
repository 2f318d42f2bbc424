"""Geometry nodes of objects that face the camera at a constant size in the picture, and their rows."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import create_mesh
from ...blender.nodes import Tree, Value
from ...shot.shot import Shot
from . import lettering, material

TIERS = 3
"""Number of rows: neighbouring labels have different heights."""

_FULL = 0.5  # labels are opaque up to this fraction of the distance at which they vanish


class CameraView(NamedTuple):
    """View of the active camera: its rotation, and at each point its distance and the picture's width, m.

    `flat` is 1 for an orthographic camera.
    """

    rotation: Value
    distance: Value
    wide: Value
    flat: Value


def read_camera(tree: Tree) -> CameraView:
    """Add nodes that read the active camera, for the points of the geometry."""
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.node("GeometryNodeObjectInfo", {"Object": camera}, transform_space="ORIGINAL")
    lens = tree.node("GeometryNodeCameraInfo", {"Camera": camera})
    distance = tree.vector(
        "DISTANCE", tree.pick(eye, "Location"), tree.output("GeometryNodeInputPosition"), name="Value"
    )
    chip = tree.separate(tree.pick(lens, "Sensor"))[0]
    flat = tree.pick(lens, "Is Orthographic")
    wide = tree.mix(
        flat, distance * chip / tree.pick(lens, "Focal Length"), tree.pick(lens, "Orthographic Scale")
    )
    return CameraView(tree.pick(eye, "Rotation"), distance, wide, flat)


def node_group(
    shot: Shot,
    title: str,
    library: bpy.types.Collection,
    size: float,
    distance: float,
    short: tuple[float, int] | None = None,
) -> bpy.types.NodeTree:
    """Make nodes that put an object of `library` on each point, facing the camera at a constant size.

    Parameters
    ----------
    title
        Name of the panel of the inputs, such as "Labels".
    size
        Height of letters as a fraction of the height of the picture.
    distance
        Distance at which they vanish, m.
    short
        Distance (m) beyond which another object is used: its index is larger by the given number.
    """
    width, height = shot.settings.render.resolution
    tree, entry = nodes.geometry(f"Firetwin {title}")
    letters = tree.input(
        "Size", size, "Height of the letters as a fraction of the height of the picture", title
    )
    gone = tree.input("Distance", distance, f"Distance at which {title.lower()} vanish (m)", title)
    view = read_camera(tree)
    fade = tree.mix(view.flat, view.distance.ramp(gone * _FULL, gone, 1.0, 0.0), 1.0)
    inputs = {"Geometry": entry, "Name": material.FADE, "Value": fade}
    points = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type="FLOAT", domain="POINT")
    names = tree.output(
        "GeometryNodeCollectionInfo",
        {"Collection": library, "Separate Children": True, "Reset Children": True},
    )
    index = tree.output("GeometryNodeInputIndex")
    if short is not None:
        detail = tree.input("Detail", short[0], "Distance beyond which only names are shown (m)", title)
        index = index + (view.distance > detail) * float(short[1])
    scale = view.wide * letters * (height / width)
    tree.geometry(
        tree.output(
            "GeometryNodeInstanceOnPoints",
            {
                "Points": points,
                "Selection": fade > 0.0,
                "Instance": names,
                "Pick Instance": True,
                "Instance Index": index,
                "Rotation": view.rotation,
                "Scale": tree.combine(scale, scale, scale),
            },
        )
    )
    return tree.node_tree


def tiers(shot: Shot, position: NDArray[np.float64]) -> NDArray[np.int64]:
    """Assign rows (n,) so that neighbours in the view of the first camera have different heights."""
    eye = shot.paths[0].position.mean(axis=0) if shot.paths else np.zeros(3)
    off = position - eye
    order = np.argsort(np.arctan2(off[:, 0], off[:, 1]))
    found = np.empty(len(order), np.int64)
    found[order] = np.arange(len(order)) % TIERS
    return found


def points(
    collection: bpy.types.Collection, name: str, position: NDArray[np.float64], group: bpy.types.NodeTree
) -> bpy.types.Object:
    """Add an object with points (n, 3), on which the node group places the objects that face the camera."""
    data = create_mesh(f"Firetwin {name}", position)
    obj = owned.add(collection, name, data, name)
    lettering.camera_rays_only(obj)
    modifier = obj.modifiers.new(group.name, "NODES")
    modifier.node_group = group
    return obj
