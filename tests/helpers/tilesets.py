"""Small tilesets for tests: in memory, in folders, and their subtrees."""

import json
import struct
from pathlib import Path

import numpy as np
from firetwin.tiles.loader import Loader
from firetwin.tiles.sources._source import MAX_BYTES, Source, missing, unpack
from firetwin.tiles.sources.local import relative

GLB = b"glTF" + struct.pack("<II", 2, 12)
"""Bytes with the header of a glTF and its length."""


class Memory(Source):
    """Files by their names; counts reads."""

    def __init__(self, files, root="tileset.json"):
        self.files, self.root, self.reads = files, root, []

    def resolve(self, base, reference):
        return relative(base, reference, base)

    def read(self, uri, most=MAX_BYTES):
        self.reads.append(uri)
        if uri not in self.files:
            raise missing(uri, "is not there")
        return unpack(as_bytes(self.files[uri]), most, uri)


def as_bytes(value):
    return value if isinstance(value, bytes) else json.dumps(value).encode()


def box(x=0.0, y=0.0, z=0.0, half=1.0):
    """A cube as a bounding volume."""
    return {"box": [x, y, z, half, 0, 0, 0, half, 0, 0, 0, half]}


def tile(error=0.0, uri=None, children=(), volume=None, **more):
    """A tile, with a content if it has a URI."""
    made = {"boundingVolume": volume or box(), "geometricError": error, **more}
    if uri is not None:
        made["content"] = {"uri": uri}
    if children:
        made["children"] = list(children)
    return made


def tileset(root, **more):
    """A tileset.json of version 1.1."""
    return {"asset": {"version": "1.1"}, "geometricError": 1000.0, "root": root, **more}


def load(root, files=None, **more):
    """Loader of a tileset in memory."""
    return Loader(Memory({"tileset.json": tileset(root, **more), **(files or {})}))


def write(folder: Path, files):
    """Write files, JSON or bytes, into a folder."""
    for name, value in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(as_bytes(value))
    return folder


def bits(values):
    """Availability as bytes, the lowest bit of each first."""
    return np.packbits(np.array(values, np.uint8), bitorder="little").tobytes()


def subtree(tiles, contents, children, more=None, extra=b""):
    """A binary subtree; each availability is a number (constant) or a list of bits."""
    buffer, views = b"", []

    def availability(values):
        nonlocal buffer
        if isinstance(values, int):
            return {"constant": values}
        data = bits(values)
        buffer += b"\0" * (-len(buffer) % 8)
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        buffer += data
        return {"bitstream": len(views) - 1}

    text = {
        "tileAvailability": availability(tiles),
        "contentAvailability": [availability(each) for each in contents],
        "childSubtreeAvailability": availability(children),
        **(more or {}),
    }
    if extra:
        buffer += b"\0" * (-len(buffer) % 8)
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(extra)})
        buffer += extra
    text |= {"buffers": [{"byteLength": len(buffer)}], "bufferViews": views}
    return packed(text, buffer)


def packed(text, buffer):
    """JSON and a buffer as a binary subtree."""
    head = json.dumps(text).encode()
    head += b" " * (-len(head) % 8)
    return b"subt" + struct.pack("<IQQ", 1, len(head), len(buffer)) + head + buffer
