"""Subdivision scheme of an implicit tiling."""

from __future__ import annotations

from dataclasses import dataclass

from . import volumes
from .json_text import Node

_BRANCHES = {"QUADTREE": 4, "OCTREE": 8}
_MOST_LEVELS = {4: 30, 8: 21}  # Morton indices of 63 bits
MOST_SUBTREE_LEVELS = 12


@dataclass(frozen=True)
class Scheme:
    """An implicit tiling.

    Attributes
    ----------
    branches
        Children of a tile: 4 or 8.
    levels
        Levels of one subtree.
    available
        Levels of the tiling.
    subtrees
        Template of the subtrees' URIs.
    """

    branches: int
    levels: int
    available: int
    subtrees: str
    node: Node


def read(tile: Node) -> Scheme | None:
    """Read the implicit tiling of a tile; None without one.

    Raises
    ------
    InputError
        It is invalid or too large.
    """
    node = tile.get("implicitTiling")
    if node is None and (extensions := tile.get("extensions")) is not None:
        node = extensions.get("3DTILES_implicit_tiling")
    if node is None:
        return None
    word = node.need("subdivisionScheme").text().upper()
    if word not in _BRANCHES:
        raise node.error(f"subdivisionScheme must be QUADTREE or OCTREE, not {word[:40]!r}")
    branches = _BRANCHES[word]
    levels = node.need("subtreeLevels").index(MOST_SUBTREE_LEVELS, 1)
    most = _MOST_LEVELS[branches]
    if "availableLevels" in node:
        available = node.need("availableLevels").index(most, 1)
    else:
        available = 1 + node.need("maximumLevel").index(most - 1)
    bounds = tile.need("boundingVolume")
    if volumes.read(bounds)[0] == "sphere":
        raise bounds.error("a sphere cannot be divided; an implicit tiling needs a box or a region")
    if (children := tile.get("children")) is not None and children.value:
        raise children.error("a tile with an implicit tiling must not have explicit children")
    return Scheme(branches, levels, available, node.need("subtrees").need("uri").text(), node)
