"""3D Tiles content made with struct and json alone: glTF from arrays, and the headers around it."""

import json
import struct

import numpy as np

COMPONENT = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPE = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
SQUARE_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]], np.uint16)


class Gltf:
    """A document that is filled by hand: ``json`` is the dictionary, ``binary`` the bytes of buffer 0."""

    def __init__(self, **more):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, **more}

    def list(self, key):
        return self.json.setdefault(key, [])

    def add(self, key, value):
        self.list(key).append(value)
        return len(self.list(key)) - 1

    def view(self, data, **more):
        """A buffer view of these bytes."""
        self.binary += bytes(-len(self.binary) % 4)
        offset = len(self.binary)
        self.binary += bytes(data)
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **more})

    def accessor(self, array, normalized=False, view=None, **more):
        """Add an accessor of rows, with a new view if none is given."""
        array = np.asarray(array)
        width = 1 if array.ndim == 1 else array.shape[1]
        accessor_ = {
            "bufferView": self.view(array.tobytes()) if view is None else view,
            "componentType": COMPONENT[array.dtype.str[1:]],
            "count": len(array),
            "type": TYPE[width],
            **more,
        }
        return self.add("accessors", accessor_ | ({"normalized": True} if normalized else {}))

    def mesh(self, *primitives):
        return self.add("meshes", {"primitives": list(primitives)})

    def primitive(self, position=SQUARE, triangles=SQUARE_TRIANGLES, attributes=None, **more):
        """A primitive of arrays; attributes that are numbers are accessors already."""
        named = {"POSITION": position, **(attributes or {})}
        primitive_ = {
            "attributes": {k: v if isinstance(v, int) else self.accessor(v) for k, v in named.items()},
            **more,
        }
        if triangles is not None:
            primitive_["indices"] = self.accessor(
                np.asarray(triangles, getattr(triangles, "dtype", "u2")).reshape(-1)
            )
        return primitive_

    def node(self, mesh=None, **more):
        return self.add("nodes", ({} if mesh is None else {"mesh": mesh}) | more)

    def scene(self, *nodes):
        self.json["scenes"] = [{"nodes": list(nodes or (0,))}]
        return self

    def document(self):
        found = dict(self.json)
        if self.binary and "buffers" not in found:
            found["buffers"] = [{"byteLength": len(self.binary)}]
        return found

    def glb(self):
        return glb(self.document(), self.binary)


def square(**more):
    """A document of one square of two triangles, in glTF's x-y plane."""
    made = Gltf(**more)
    made.node(made.mesh(made.primitive()))
    return made.scene()


def glb(document, binary=b""):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        binary += bytes(-len(binary) % 4)
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _padded_json(table):
    text = json.dumps(table).encode() if table else b""
    return text + b" " * (-len(text) % 8)


def _table(magic, table, binary, body, head=b""):
    text = _padded_json(table)
    length = 28 + len(head) + len(text) + len(binary) + len(body)
    header = struct.pack("<4sIIIIII", magic, 1, length, len(text), len(binary), 0, 0)
    return header + head + text + binary + body


def b3dm(body, table=None, binary=b""):
    return _table(b"b3dm", {"BATCH_LENGTH": 0} if table is None else table, binary, body)


def b3dm_legacy(body, form, batch_table=b'{"id":[1]}  '):
    """The two headers that came before version 1.0: of 20 and of 24 bytes."""
    tables = (1, len(batch_table)) if form == 20 else (len(batch_table), 0, 1)
    length = form + len(batch_table) + len(body)
    return struct.pack(f"<4sII{len(tables)}I", b"b3dm", 1, length, *tables) + batch_table + body


def i3dm(body, table, binary=b"", embedded=True):
    return _table(b"i3dm", table, binary, body, struct.pack("<I", int(embedded)))


def pnts(table, binary):
    return _table(b"pnts", table, binary, b"")


def cmpt(*tiles):
    body = b"".join(tiles)
    return struct.pack("<4sIII", b"cmpt", 1, 16 + len(body), len(tiles)) + body


def png(width=1, height=1):
    """The first bytes of a PNG."""
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", width, height) + b"\x08\x02\0\0\0"


def jpeg(width=1, height=1):
    """The first bytes of a JPEG."""
    return b"\xff\xd8\xff\xe0\0\x04ab\xff\xc0\0\x11\x08" + struct.pack(">HH", height, width) + bytes(12)


def webp(width=1, height=1):
    """The first bytes of an extended WebP."""
    size = (width - 1).to_bytes(3, "little") + (height - 1).to_bytes(3, "little")
    return b"RIFF" + struct.pack("<I", 22) + b"WEBPVP8X" + struct.pack("<II", 10, 0) + size


def wavy(count, seed=5):
    """A wavy surface of count x count squares: positions, normals, uv, triangles."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 100, count + 1), np.linspace(0, 100, count + 1))
    z = 3.0 * np.sin(x / 7.0) * np.cos(y / 9.0) + rng.normal(0, 0.05, x.shape)
    position = np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32)
    uv = np.stack([x, y], -1).reshape(-1, 2).astype(np.float32) / np.float32(100.0)
    i = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).reshape(-1)
    corners = [i, i + 1, i + count + 2, i, i + count + 2, i + count + 1]
    triangles = np.stack(corners, -1).reshape(-1, 3).astype(np.uint32)
    normal = np.tile(np.array([[0, 0, 1]], np.float32), (len(position), 1))
    return position, normal, uv, triangles


def to_z_up(points):
    """Convert the axes of glTF to the axes of 3D Tiles."""
    points = np.asarray(points, float)
    return np.stack([points[:, 0], -points[:, 2], points[:, 1]], 1)
