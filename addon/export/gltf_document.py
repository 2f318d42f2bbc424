"""glTF document: nodes, meshes, materials and other parts in lists, over one buffer.

glTF's y axis is up: x, y, z are the scene's east, up and south. Specification: Khronos glTF 2.0.
"""

from __future__ import annotations

from typing import Any

import firetwin_core
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..tiles.make import glb

TO_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Rotation (3, 3) from the scene's axes to glTF's."""


class Document:
    """A glTF file with one scene, whose root node is number 0.

    Parameters
    ----------
    name
        Name of the root node.
    credit
        asset.copyright; empty: none.
    """

    def __init__(self, name: str, credit: str = "") -> None:
        self.buffer = glb.Buffer()
        self._parts: dict[str, list[dict[str, Any]]] = {}
        self._extensions: set[str] = set()
        self._asset = {"version": "2.0", "generator": f"Firetwin {firetwin_core.__version__}"} | (
            {"copyright": credit} if credit else {}
        )
        self.add("nodes", {"name": name})

    def add(self, kind: str, part: dict[str, Any]) -> int:
        """Append a part to a list such as "materials"; return its number."""
        parts = self._parts.setdefault(kind, [])
        parts.append(part)
        return len(parts) - 1

    def node(self, name: str, parent: int = 0, **properties: Any) -> int:
        """Append a node below another; return its number. `properties` are named as in the format."""
        number = self.add("nodes", {"name": name} | properties)
        self._parts["nodes"][parent].setdefault("children", []).append(number)
        return number

    def use(self, extension: str) -> None:
        """Note an extension that the file uses."""
        self._extensions.add(extension)

    def material(
        self, name: str, colour: ArrayLike = (1.0, 1.0, 1.0), texture: int | None = None, **properties: Any
    ) -> int:
        """Append a matt material with a linear colour and a texture; return its number."""
        surface: dict[str, Any] = {
            "baseColorFactor": [*np.asarray(colour, float).tolist(), 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        }
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture}
        return self.add("materials", {"name": name, "pbrMetallicRoughness": surface} | properties)

    def texture(self, name: str, picture: bytes) -> int:
        """Append a texture of a JPEG or PNG, which is clamped at its border; return its number."""
        if "samplers" not in self._parts:
            self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071})
        image = {
            "name": name,
            "bufferView": self.buffer.view(picture),
            "mimeType": glb.pictures.kind(picture),
        }
        return self.add("textures", {"name": name, "source": self.add("images", image), "sampler": 0})

    def vectors(self, values: NDArray, target: int = glb.VERTICES, bounds: bool = False) -> int:
        """Append vectors (n, 3) in the scene's axes as an accessor in glTF's; return its number."""
        return self.buffer.accessor(glb.y_up(values), glb.FLOAT, "VEC3", target, bounds)

    def indices(self, values: NDArray, vertices: int) -> int:
        """Append vertex numbers (n,), or more dimensions, as small as their range allows."""
        kind = glb.SHORT if vertices < 65536 else glb.INT
        return self.buffer.accessor(values.reshape(-1, 1), kind, "SCALAR", glb.INDICES)

    def scalars(self, values: NDArray, bounds: bool = False) -> int:
        """Append numbers (n,) as floats; return the number of their accessor."""
        return self.buffer.accessor(values.reshape(-1, 1), glb.FLOAT, "SCALAR", bounds=bounds)

    def encode(self, extras: dict[str, Any]) -> bytes:
        """Encode the document as .glb, with these extras of its scene."""
        about = {
            "asset": self._asset,
            "scene": 0,
            "scenes": [{"nodes": [0], "extras": extras}],
            **({"extensionsUsed": sorted(self._extensions)} if self._extensions else {}),
        }
        return glb.container(about | self._parts | self.buffer.about(), bytes(self.buffer.data))
