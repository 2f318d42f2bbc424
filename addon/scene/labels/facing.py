"""Geometry nodes of what faces the camera and has the same size in every picture, and rows of neighbours."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.nodes import Tree, Value
from ...shot.shot import Shot
from . import lettering, material

TIERS = 3
"""Rows of labels: neighbours stand at different heights."""

_FULL = 0.5  # fraction of the distance at which labels vanish, up to which they are opaque


class Seen(NamedTuple):
    """What the active camera sees of points: its rotation, their distance, and the picture's width there, m.

    `flat` is 1 for an orthographic camera.
    """

    rotation: Value
    distance: Value
    wide: Value
    flat: Value


def seen(tree: Tree) -> Seen:
    """Nodes that ask the active camera, for the points of the tree's geometry."""
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
    return Seen(tree.pick(eye, "Rotation"), distance, wide, flat)


def node_group(
    shot: Shot,
    title: str,
    library: bpy.types.Collection,
    size: float,
    distance: float,
    short: tuple[float, int] | None = None,
) -> bpy.types.NodeTree:
    """An object of `library` on each point, facing the camera, its size a fraction of the picture's.

    Parameters
    ----------
    title
        Name of the panel of its inputs, such as "Labels".
    size
        Height of letters, in heights of the picture.
    distance
        Where they are gone, m.
    short
        Distance (m) beyond which the object of a point's index plus that number takes its place.
    """
    width, height = shot.settings.render.resolution
    tree, entry = nodes.geometry(f"Firetwin {title}")
    letters = tree.input("Size", size, "Height of the letters, in heights of the picture", title)
    gone = tree.input("Distance", distance, f"Where {title.lower()} are gone (m)", title)
    view = seen(tree)
    fade = tree.mix(view.flat, view.distance.ramp(gone * _FULL, gone, 1.0, 0.0), 1.0)
    inputs = {"Geometry": entry, "Name": material.FADE, "Value": fade}
    points = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type="FLOAT", domain="POINT")
    names = tree.output(
        "GeometryNodeCollectionInfo",
        {"Collection": library, "Separate Children": True, "Reset Children": True},
    )
    index = tree.output("GeometryNodeInputIndex")
    if short is not None:
        detail = tree.input("Detail", short[0], "Beyond which only names are shown (m)", title)
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
    """Row (n,) of each point: neighbours from the first camera's view are put at different heights."""
    eye = shot.paths[0].position.mean(axis=0) if shot.paths else np.zeros(3)
    off = position - eye
    order = np.argsort(np.arctan2(off[:, 0], off[:, 1]))
    found = np.empty(len(order), np.int64)
    found[order] = np.arange(len(order)) % TIERS
    return found


def points(
    collection: bpy.types.Collection, name: str, position: NDArray[np.float64], group: bpy.types.NodeTree
) -> bpy.types.Object:
    """Object of ours with points (n, 3), on which the node group puts what faces the camera."""
    data = bpy.data.meshes.new(f"Firetwin {name}")
    data.from_pydata(position.tolist(), [], [])
    obj = owned.add(collection, name, data)
    lettering.camera_rays_only(obj)
    modifier = obj.modifiers.new(group.name, "NODES")
    modifier.node_group = group
    return obj
