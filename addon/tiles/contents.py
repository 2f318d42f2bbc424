"""Type of a tile's content, from its magic bytes, and detection of truncated files."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

MAGIC = {
    b"b3dm": "b3dm",
    b"i3dm": "i3dm",
    b"cmpt": "cmpt",
    b"pnts": "pnts",
    b"glTF": "glb",
    b"subt": "subtree",
    b"vctr": "vctr",
    b"geom": "geom",
}
_LENGTH_AT = 8  # of the file's length, a uint32, after magic and version
_ENDINGS = {"glb": "glb", "gltf": "gltf", "json": "json", "b3dm": "b3dm", "i3dm": "i3dm", "cmpt": "cmpt"}


def kind(data: bytes) -> str:
    """Detect the type of a content: a value of `MAGIC`, ``json`` or ``unknown``."""
    found = MAGIC.get(data[:4])
    if found is not None:
        return found
    return "json" if data[:512].removeprefix(b"\xef\xbb\xbf").lstrip()[:1] == b"{" else "unknown"


def kind_by_name(uri: str) -> str:
    """Guess the type of a content from its name."""
    ending = uri.partition("#")[0].partition("?")[0].rpartition(".")[2].lower()
    return ending if ending in (*MAGIC.values(), *_ENDINGS) else "unknown"


def truncation(data: bytes) -> str | None:
    """Describe a file that is shorter than its header states; None if it is complete."""
    found = MAGIC.get(data[:4])
    if found is None:
        return None
    if found == "subtree":
        if len(data) < 24:
            return f"{len(data)} bytes, less than its header"
        text, binary = struct.unpack_from("<QQ", data, 8)
        length = 24 + text + binary
    else:
        if len(data) < _LENGTH_AT + 4:
            return f"{len(data)} bytes, less than its header"
        (length,) = struct.unpack_from("<I", data, _LENGTH_AT)
    return f"{len(data):,} of {length:,} bytes" if len(data) < length else None


def references(value: Any) -> Iterator[str]:
    """List the URIs of the contents of a tileset's JSON, from its root on."""
    stack = [value.get("root")] if isinstance(value, dict) else []
    while stack:
        tile = stack.pop()
        if not isinstance(tile, dict):
            continue
        several = tile.get("contents")
        for each in [tile.get("content"), *(several if isinstance(several, list) else [])]:
            uri = each.get("uri", each.get("url")) if isinstance(each, dict) else None
            if isinstance(uri, str):
                yield uri
        children = tile.get("children")
        stack += reversed(children if isinstance(children, list) else [])
