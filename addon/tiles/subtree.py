"""Subtrees of implicit tilings: availability of tiles, contents and further subtrees."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .json_text import Node, parse

_HEADER = struct.Struct("<4sIQQ")
_ONES = np.array([bin(byte).count("1") for byte in range(256)], np.int64)


@dataclass(frozen=True)
class Bits:
    """Availability of `length` nodes in level order, each level in Morton order.

    Attributes
    ----------
    data
        Bits, lowest bit of each byte first; None: all equal `constant`.
    """

    length: int
    data: NDArray[np.uint8] | None
    constant: bool = False

    def at(self, index: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return the availability of the nodes at these indices."""
        if self.data is None:
            return np.full(len(index), self.constant)
        return (self.data[index >> 3] >> (index & 7).astype(np.uint8)) & 1 > 0

    def ranks(self, index: NDArray[np.int64]) -> NDArray[np.int64]:
        """Count the available nodes before each index, which is its row of a property table."""
        if self.data is None:
            return index if self.constant else np.zeros_like(index)
        before = np.concatenate([[0], np.cumsum(_ONES[self.data])])
        mask = ((1 << (index & 7)) - 1).astype(np.uint8)
        return before[index >> 3] + _ONES[self.data[index >> 3] & mask]


@dataclass(frozen=True)
class Availability:
    """Availability of a subtree.

    Attributes
    ----------
    contents
        Availability of each content.
    children
        Availability of the child subtrees.
    """

    node: Node
    views: list[memoryview]
    tiles: Bits
    contents: list[Bits]
    children: Bits


def read(
    data: bytes, name: str, branches: int, levels: int, contents: int, load: Callable[[str], bytes]
) -> Availability:
    """Read a subtree, binary or JSON.

    Parameters
    ----------
    branches
        Children of a tile: 4 or 8.
    levels
        Levels of the subtree.
    contents
        Number of contents of a tile.
    load
        Reads another file by a reference in the subtree.

    Raises
    ------
    InputError
        It is not a subtree, or a buffer ends early.
    """
    if data[:4] == b"subt":
        node, inner = _open(data, name)
    else:
        node, inner = parse(data, name), None
    node.object()
    views = _views(node, inner, load)
    nodes = (branches**levels - 1) // (branches - 1)
    tiles = _bits(node.need("tileAvailability"), nodes, views)
    found = [_bits(each, nodes, views) for each in _content_nodes(node)][:contents]
    found += [Bits(nodes, None)] * (contents - len(found))
    children = _bits(node.need("childSubtreeAvailability"), branches**levels, views)
    return Availability(node, views, tiles, found, children)


def _open(data: bytes, name: str) -> tuple[Node, bytes]:
    """Split a binary subtree into JSON and buffer."""
    whole = Node(None, name, "header")
    if len(data) < _HEADER.size:
        raise whole.error("the subtree ends within its header")
    _, version, text, binary = _HEADER.unpack_from(data)
    if version != 1:
        raise whole.error(f"version {version} of subtrees is not known")
    if _HEADER.size + text + binary > len(data):
        raise whole.error(f"says {text + binary + _HEADER.size:,} bytes, the file has {len(data):,}")
    end = _HEADER.size + text
    return parse(data[_HEADER.size : end].rstrip(b" \0"), name), data[end : end + binary]


def _views(node: Node, inner: bytes | None, load: Callable[[str], bytes]) -> list[memoryview]:
    """List the bytes of each buffer view."""
    buffers: list[memoryview] = []
    for number, each in enumerate(items(node, "buffers")):
        length = each.need("byteLength").index(1 << 40)
        uri = each.get("uri")
        if uri is not None:
            data = load(uri.text())
        elif number == 0 and inner is not None:
            data = inner
        else:
            raise each.error("has no uri; only the first buffer of a binary subtree may have none")
        if len(data) < length:
            raise each.error(f"says {length:,} bytes, there are {len(data):,}")
        buffers.append(memoryview(data)[:length])
    views = []
    for each in items(node, "bufferViews"):
        buffer = buffers[each.need("buffer").index(len(buffers) - 1)]
        start = offset.index(1 << 40) if (offset := each.get("byteOffset")) is not None else 0
        length = each.need("byteLength").index(1 << 40)
        if start + length > len(buffer):
            raise each.error(f"ends at byte {start + length:,}, its buffer at {len(buffer):,}")
        views.append(buffer[start : start + length])
    return views


def items(node: Node, name: str) -> list[Node]:
    """List the elements of a member; empty if it is missing."""
    found = node.get(name)
    return list(found.items()) if found is not None else []


def _content_nodes(node: Node) -> list[Node]:
    if (extensions := node.get("extensions")) is not None:
        several = extensions.get("3DTILES_multiple_contents")
        if several is not None:
            return items(several, "contentAvailability")
    found = node.get("contentAvailability")
    if found is None:
        return []
    return list(found.items()) if isinstance(found.value, list) else [found]


def _bits(node: Node, length: int, views: list[memoryview]) -> Bits:
    constant = node.get("constant")
    if constant is not None:
        return Bits(length, None, bool(constant.index(1)))
    view = node.need("bitstream", "bufferView").index(len(views) - 1)
    if len(views[view]) < (length + 7) // 8:
        raise node.error(
            f"needs {(length + 7) // 8:,} bytes for {length:,} bits, there are {len(views[view]):,}"
        )
    return Bits(length, np.frombuffer(views[view], np.uint8))
