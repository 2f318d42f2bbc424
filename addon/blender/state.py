"""Digests of data-blocks, to detect edits of meshes and materials after a build.

An artist may edit owned data, and undo or redo edits. A rebuild reuses data whose digest is unchanged since
the build, and builds other data again.
"""

from __future__ import annotations

import functools
import hashlib
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

_VALUES: dict[str, tuple[str, int, type]] = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "INT8": ("value", 1, np.int8),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "INT16_2D": ("value", 2, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "QUATERNION": ("value", 4, np.float32),
}
"""Name, width and kind of an attribute's values by its data type."""
_LEFT_OUT = (".select", ".vs.", ".es.", ".pn.", ".edge_verts", ".corner_edge")
"""Beginnings of attributes of the editor, and of those that follow from the others."""
_UNSEEN = (
    "location",
    "width",
    "height",
    "select",
    "show_",
    "dimensions",
    "is_",
    "debug_",
    "bl_",
    "use_nodes",
)
"""Beginnings of properties that do not show in a picture."""


def digest_mesh(data: bpy.types.Mesh) -> str:
    """Return a digest of a mesh: attributes and faces; empty if it has shape keys or animation."""
    digest = hashlib.blake2b(digest_size=16)
    if data.shape_keys or data.animation_data:
        return ""
    digest.update(repr((len(data.vertices), len(data.edges), len(data.polygons))).encode())
    starts = np.empty(len(data.polygons), np.int32)
    data.polygons.foreach_get("loop_start", starts)
    digest.update(starts.tobytes())
    for attribute in sorted(data.attributes, key=lambda each: each.name):
        if attribute.name.startswith(_LEFT_OUT):
            continue
        if attribute.data_type not in _VALUES:
            return ""
        name, width, kind = _VALUES[attribute.data_type]
        values: NDArray = np.empty(width * len(attribute.data), kind)
        attribute.data.foreach_get(name, values)
        digest.update(repr((attribute.name, attribute.domain, attribute.data_type)).encode())
        digest.update(values.tobytes())
    return digest.hexdigest()


def digest_material(material: bpy.types.Material) -> str:
    """Return a digest of a material: its settings, and nodes and links of its tree and of its group.

    Nested groups count by name, as all materials share them. The digest is empty if anything is animated.
    """
    trees = [material.node_tree]
    trees += [node.node_tree for node in trees[0].nodes if node.type == "GROUP" and node.node_tree]
    if any(each.animation_data for each in (material, *trees)):
        return ""
    shown = [_plain(material), *map(_tree, trees)]
    return hashlib.blake2b(repr(shown).encode(), digest_size=16).hexdigest()


def _tree(tree: bpy.types.NodeTree) -> list[Any]:
    nodes = [
        (node.bl_idname, _plain(node), [_plain(each) for each in (*node.inputs, *node.outputs)])
        for node in tree.nodes
    ]
    links = [
        (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
        for link in tree.links
    ]
    return [*nodes, sorted(links)]


def _plain(thing: bpy.types.bpy_struct) -> list[Any]:
    """Return the properties that a picture may depend on: numbers, texts, ramps, and names of data-blocks."""
    values: list[Any] = []
    kind: Any = type(thing)
    for name in _names(kind):
        value = getattr(thing, name)
        if isinstance(value, bpy.types.ID):
            values.append(value.name)
        elif isinstance(value, bpy.types.ColorRamp):
            values.append([(each.position, *each.color) for each in value.elements])
        elif isinstance(value, str | bool | int | float | None):
            values.append(value)
        elif isinstance(value, set):
            values.append(sorted(value))
        elif not isinstance(value, bpy.types.bpy_struct):
            values.append(tuple(value))
    return values


@functools.cache
def _names(kind: Any) -> tuple[str, ...]:
    """List the names of the compared properties of a type."""
    common = set(bpy.types.ID.bl_rna.properties.keys()) if issubclass(kind, bpy.types.ID) else set()
    return tuple(
        prop.identifier
        for prop in kind.bl_rna.properties
        if prop.type != "COLLECTION"
        and prop.identifier not in common
        and not prop.identifier.startswith(_UNSEEN)
    )
