"""Labels of place names: text that faces the camera, of equal size in every picture, faded with distance.

A label is a mesh one unit high, of letters, an outline for contrast, and a stem down to the place. It is an
instance on a point there: objects in front of the place occlude it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import compat, nodes, owned
from ...blender.owned import Stage
from ...shot import labels
from ...shot.shot import Shot
from . import material

# height of the letters over the ground, in letter heights; from row to row; rows
_STEM, _TIER, _TIERS = 2.2, 1.3, 3
_RIM = 0.035  # in letter heights
_THIN = 0.045  # half-width of the stem
_FULL = 0.5  # fraction of the distance at which labels vanish, up to which they are opaque


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Labels"; nothing where labels are off or no place is known."""
    collection = stage.part("Labels")
    places = labels.find(shot)
    if not places.names:
        return None
    looks = [material.build(shot, name, colour) for name, colour in material.COLOURS.items()]
    library = owned.library("Place Names")
    with _typeface() as font:
        for k, (name, tier) in enumerate(zip(places.names, _tiers(shot, places.position), strict=True)):
            mesh = _label(f"Firetwin Place {k:03d}", name, _STEM + _TIER * int(tier), font)
            for look in looks:
                mesh.materials.append(look)
            _camera_rays_only(owned.add(library, f"Place {k:03d}", mesh))
    data = bpy.data.meshes.new("Firetwin Labels")
    data.from_pydata(places.position.tolist(), [], [])
    obj = owned.add(collection, "Places", data)
    _camera_rays_only(obj)
    modifier = obj.modifiers.new("Firetwin Labels", "NODES")
    modifier.node_group = _node_group(shot, library)
    return obj


def _tiers(shot: Shot, position: NDArray[np.float64]) -> NDArray[np.int64]:
    """Row (n,) of each label: neighbours from the first camera's view are put at different heights."""
    eye = shot.paths[0].position.mean(axis=0) if shot.paths else np.zeros(3)
    off = position - eye
    order = np.argsort(np.arctan2(off[:, 0], off[:, 1]))
    tiers = np.empty(len(order), np.int64)
    tiers[order] = np.arange(len(order)) % _TIERS
    return tiers


def _camera_rays_only(obj: bpy.types.Object) -> None:
    """Make labels visible to camera rays only."""
    obj.visible_shadow = obj.visible_diffuse = obj.visible_glossy = False
    obj.visible_volume_scatter = obj.visible_transmission = False


@contextmanager
def _typeface() -> Iterator[bpy.types.VectorFont | None]:
    """Blender's typeface; it stays in the file no longer than before."""
    before, font = set(bpy.data.fonts), compat.typeface()
    try:
        yield font
    finally:
        if font is not None and font not in before:
            bpy.data.fonts.remove(font)


def _label(name: str, text: str, stem: float, font: bpy.types.VectorFont | None) -> bpy.types.Mesh:
    """Letters (material 0) over their outline and the stem (1), one unit high, in the plane of x and y."""
    letters = (_letters(text, stem, *way, font) for way in ((0.0, 0.02), (_RIM, 0.0)))
    parts = [*letters, _stem(stem - 0.3)]
    mesh = owned.mark(bpy.data.meshes.new(name))
    start, vertices, faces, looks = 0, [], [], []
    for (points, polygons), look in zip(parts, (0, 1, 0), strict=True):
        vertices += points
        faces += [[start + k for k in polygon] for polygon in polygons]
        looks += [look] * len(polygons)
        start += len(points)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("material_index", looks)
    return mesh


def _letters(
    text: str, stem: float, offset: float, front: float, font: bpy.types.VectorFont | None
) -> tuple[list, list]:
    """Points and faces of a line of text over the stem, its outline expanded by `offset`."""
    curve = bpy.data.curves.new("Firetwin Letters", "FONT")
    curve.body, curve.align_x, curve.offset, curve.resolution_u = text, "CENTER", offset, 3
    if font is not None:
        curve.font = font
    obj = bpy.data.objects.new("Firetwin Letters", curve)
    mesh = obj.to_mesh()
    points = [(v.co.x, v.co.y + stem, front) for v in mesh.vertices]
    faces = [list(polygon.vertices) for polygon in mesh.polygons]
    bpy.data.objects.remove(obj)
    bpy.data.curves.remove(curve)
    return points, faces


def _stem(top: float) -> tuple[list, list]:
    return [(-_THIN, 0.0, 0.01), (_THIN, 0.0, 0.01), (_THIN, top, 0.01), (-_THIN, top, 0.01)], [[0, 1, 2, 3]]


def _node_group(shot: Shot, library: bpy.types.Collection) -> bpy.types.NodeTree:
    """Geometry nodes: a label on each point, facing the camera, its size a fraction of the picture's."""
    settings = shot.settings.labels
    width, height = shot.settings.render.resolution
    tree, entry = nodes.geometry("Firetwin Labels")
    size = tree.input("Size", settings.size, "Height of the letters, in heights of the picture", "Labels")
    gone = tree.input("Distance", settings.distance, "Where labels are gone (m)", "Labels")
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.node("GeometryNodeObjectInfo", {"Object": camera}, transform_space="ORIGINAL")
    lens = tree.node("GeometryNodeCameraInfo", {"Camera": camera})
    distance = tree.vector(
        "DISTANCE", tree.pick(eye, "Location"), tree.output("GeometryNodeInputPosition"), name="Value"
    )
    chip = tree.separate(tree.pick(lens, "Sensor"))[0]
    wide = tree.mix(
        tree.pick(lens, "Is Orthographic"),
        distance * chip / tree.pick(lens, "Focal Length"),
        tree.pick(lens, "Orthographic Scale"),
    )
    fade = tree.mix(tree.pick(lens, "Is Orthographic"), distance.ramp(gone * _FULL, gone, 1.0, 0.0), 1.0)
    inputs = {"Geometry": entry, "Name": material.FADE, "Value": fade}
    points = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type="FLOAT", domain="POINT")
    names = tree.output(
        "GeometryNodeCollectionInfo",
        {"Collection": library, "Separate Children": True, "Reset Children": True},
    )
    scale = wide * size * (height / width)
    tree.geometry(
        tree.output(
            "GeometryNodeInstanceOnPoints",
            {
                "Points": points,
                "Selection": fade > 0.0,
                "Instance": names,
                "Pick Instance": True,
                "Rotation": tree.pick(eye, "Rotation"),
                "Scale": tree.combine(scale, scale, scale),
            },
        )
    )
    return tree.node_tree
