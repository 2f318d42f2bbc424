"""Writer of binary glTF 2.0: its buffer and container, and a file with one mesh and one material.

Source: Khronos glTF 2.0 specification, sections 3.6 and 4.4.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import Any

import firetwin_core
import numpy as np
from numpy.typing import NDArray

from . import pictures

FLOAT, SHORT, INT, SIGNED_SHORT = 5126, 5123, 5125, 5122
"""Component types; integers are unsigned unless named otherwise."""
VERTICES, INDICES = 34962, 34963
"""Targets of buffer views."""
_TYPES = {FLOAT: "<f4", SHORT: "<u2", INT: "<u4", SIGNED_SHORT: "<i2"}


@dataclass(frozen=True)
class Mesh:
    """Triangles with a picture or a colour.

    Attributes
    ----------
    origin
        (3,) Earth-centred origin of the positions, m.
    position, normal
        (n, 3) along Earth-centred axes; m relative to the origin, and unit vectors.
    uv
        (n, 2) of the picture, from its upper left corner; None without.
    triangles
        (t, 3) vertex numbers, counter-clockwise from outside.
    picture
        JPEG or PNG; empty: none.
    colour
        Linear base colour factor, red to alpha.
    """

    origin: NDArray[np.float64]
    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    triangles: NDArray[np.int64]
    uv: NDArray[np.float64] | None = None
    picture: bytes = b""
    colour: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)


def encode(mesh: Mesh, credit: str) -> bytes:
    """Encode a mesh as a .glb, whose y axis is up.

    Parameters
    ----------
    credit
        asset.copyright; empty: none.
    """
    buffer = Buffer()
    attributes = {
        "POSITION": buffer.accessor(y_up(mesh.position), FLOAT, "VEC3", VERTICES, bounds=True),
        "NORMAL": buffer.accessor(y_up(mesh.normal), FLOAT, "VEC3", VERTICES),
    }
    if mesh.uv is not None:
        attributes["TEXCOORD_0"] = buffer.accessor(mesh.uv, FLOAT, "VEC2", VERTICES)
    kind = SHORT if len(mesh.position) < 65536 else INT
    indices = buffer.accessor(mesh.triangles.reshape(-1, 1), kind, "SCALAR", INDICES)
    surface: dict[str, Any] = {
        "baseColorFactor": mesh.colour,
        "metallicFactor": 0.0,
        "roughnessFactor": 1.0,
    }
    about: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"Firetwin {firetwin_core.__version__}"}
        | ({"copyright": credit} if credit else {}),
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": y_up(mesh.origin[None])[0].tolist()}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": surface}],
    }
    if mesh.picture:
        surface["baseColorTexture"] = {"index": 0}
        about["images"] = [{"bufferView": buffer.view(mesh.picture), "mimeType": pictures.kind(mesh.picture)}]
        about["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}]
        about["textures"] = [{"source": 0, "sampler": 0}]
    return container(about | buffer.about(), bytes(buffer.data))


def y_up(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotate vectors (n, 3) with z up to glTF's y up; readers of tiles map (x, y, z) to (x, -z, y)."""
    return vectors[:, [0, 2, 1]] * (1.0, 1.0, -1.0)


class Buffer:
    """Buffer of a .glb with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int = 0) -> int:
        """Append bytes; return the number of their view."""
        self.data += b"\0" * (-len(self.data) % 4)
        found = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self._views.append(found | ({"target": target} if target else {}))
        self.data += data
        return len(self._views) - 1

    def accessor(
        self,
        values: NDArray,
        kind: int,
        shape: str,
        target: int = 0,
        bounds: bool = False,
        normalized: bool = False,
    ) -> int:
        """Append values (n, k); return the number of their accessor.

        Parameters
        ----------
        kind, shape
            Component type, and "SCALAR", "VEC2", "VEC3" or "VEC4".
        bounds
            Write the smallest and largest values, as POSITION and the times of animations need.
        normalized
            Store numbers in -1..1 (unsigned: 0..1) as fractions of the largest integer.
        """
        if normalized:
            values = np.round(values * np.iinfo(_TYPES[kind]).max)
        stored = values.astype(_TYPES[kind])
        accessor = {
            "bufferView": self.view(stored.tobytes(), target),
            "componentType": kind,
            "count": len(stored),
            "type": shape,
        }
        if bounds:
            accessor |= {"min": stored.min(axis=0).tolist(), "max": stored.max(axis=0).tolist()}
        if normalized:
            accessor["normalized"] = True
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def about(self) -> dict[str, Any]:
        """Describe the buffer as JSON."""
        return {
            "buffers": [{"byteLength": len(self.data)}],
            "bufferViews": self._views,
            "accessors": self._accessors,
        }


def container(about: dict[str, Any], data: bytes) -> bytes:
    """Join the JSON and the buffer to a .glb."""
    text = json.dumps(about, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
    return b"".join(
        [head, struct.pack("<I4s", len(text), b"JSON"), text, struct.pack("<I4s", len(data), b"BIN\0"), data]
    )
