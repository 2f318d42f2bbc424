"""Meshes from arrays.

Arrays are written as attributes, which Blender copies in bulk; through `vertices` and `loops` it copies them
element by element.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import ArrayLike

_KEYS = {
    "FLOAT": "value",
    "INT": "value",
    "BOOLEAN": "value",
    "FLOAT_VECTOR": "vector",
    "FLOAT_COLOR": "color",
    "BYTE_COLOR": "color",
}


def create_mesh(
    name: str,
    positions: ArrayLike,
    faces: ArrayLike = (),
    *,
    edges: ArrayLike = (),
    flat: bool = False,
    material_index: ArrayLike | None = None,
) -> bpy.types.Mesh:
    """Create a mesh from arrays; see `fill_mesh`."""
    data = bpy.data.meshes.new(name)
    fill_mesh(data, positions, faces, edges=edges, flat=flat, material_index=material_index)
    return data


def fill_mesh(
    data: bpy.types.Mesh,
    positions: ArrayLike,
    faces: ArrayLike = (),
    *,
    edges: ArrayLike = (),
    flat: bool = False,
    material_index: ArrayLike | None = None,
) -> None:
    """Write vertices, faces and edges into an empty mesh.

    Parameters
    ----------
    positions
        Coordinates of the vertices (n, 3), stored as float32.
    faces
        Vertices of each face (m, k), anticlockwise seen from outside. All faces have k corners.
    edges
        Vertices of each edge (e, 2), for meshes without faces. Blender adds the edges of faces itself.
    flat
        Shade the faces flat instead of smooth.
    material_index
        Material slot of each face (m,).
    """
    position = np.asarray(positions, np.float32)
    corners, ends = np.asarray(faces, np.int32), np.asarray(edges, np.int32)
    data.vertices.add(len(position))
    if len(position):
        data.attributes["position"].data.foreach_set("vector", position.ravel())
    if len(ends):
        data.edges.add(len(ends))
        data.edges.foreach_set("vertices", ends.ravel())
    if len(corners):
        data.loops.add(corners.size)
        data.attributes[".corner_vert"].data.foreach_set("value", corners.ravel())
        data.polygons.add(len(corners))
        starts = np.arange(0, corners.size, corners.shape[1], dtype=np.int32)
        data.polygons.foreach_set("loop_start", starts)
        if material_index is not None:
            data.polygons.foreach_set("material_index", np.asarray(material_index, np.int32))
        if flat:
            data.shade_flat()
    data.update(calc_edges=bool(len(corners)))


def add_attribute(
    data: bpy.types.Mesh, name: str, kind: str, values: ArrayLike, domain: str = "POINT"
) -> None:
    """Add an attribute of a kind such as "FLOAT_VECTOR": one value or row per element of its domain."""
    flat = np.asarray(values, {"INT": np.int32, "BOOLEAN": np.bool_}.get(kind, np.float32)).ravel()
    data.attributes.new(name, kind, domain).data.foreach_set(_KEYS[kind], flat)
