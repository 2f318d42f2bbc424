"""Draco and meshopt against the uncompressed data; both packages are in the extra `test`."""

import numpy as np
import pytest
import tile_files as made
from firetwin_core import InputError, tiles

EYE = np.eye(4)
POSITION, NORMAL, UV, TRIANGLES = made.wavy(12)


def decode(content):
    return tiles.decode(content, EYE, "tile", up_axis="Z")


def corners(tile):
    """Places of triangles' corners (m, 3, 3), in an order that does not depend on the vertices'."""
    found = (tile.origin + tile.position.astype(float))[tile.triangle]
    place = np.round(found[..., :2]) @ [1, 1000]  # neighbours are 8 m apart
    first = np.argmin(place, axis=1)
    turned = np.take_along_axis(found, (first[:, None] + np.arange(3))[..., None] % 3, axis=1)
    return turned[np.argsort(np.round(found.mean(axis=1)[:, :2]) @ [1, 1000])]


def draco_gltf(counts=(0, 0), damage=None, **more):
    draco = pytest.importorskip("DracoPy")
    data = draco.encode(
        POSITION, TRIANGLES, quantization_bits=20, normals=NORMAL.astype(float), tex_coord=UV.astype(float)
    )
    mesh = draco.decode(data)
    ids = {a["attribute_type"]: a["unique_id"] for a in mesh.attributes}
    if damage:
        data = damage(data)
    content = made.Gltf(extensionsRequired=["KHR_draco_mesh_compression"])

    def said(count, kind, component=5126):
        return content.add("accessors", {"count": count, "type": kind, "componentType": component})

    n = len(mesh.points) + counts[0]
    attributes = {"POSITION": said(n, "VEC3"), "NORMAL": said(n, "VEC3"), "TEXCOORD_0": said(n, "VEC2")}
    extension = {
        "bufferView": content.view(data),
        "attributes": {"POSITION": ids[0], "NORMAL": ids[1], "TEXCOORD_0": ids[3], **more},
    }
    primitive = {
        "attributes": attributes,
        "indices": said(3 * len(mesh.faces) + counts[1], "SCALAR", 5125),
        "extensions": {"KHR_draco_mesh_compression": extension},
    }
    content.node(content.mesh(primitive))
    return content.scene().glb()


def test_draco_meshes():
    tile = decode(draco_gltf())
    plain = made.Gltf()
    plain.node(plain.mesh(plain.primitive(POSITION, TRIANGLES, {"NORMAL": NORMAL, "TEXCOORD_0": UV})))
    expected = decode(plain.scene().glb())
    np.testing.assert_allclose(corners(tile), corners(expected), atol=2e-4)  # 100 m / 2^20, and more
    np.testing.assert_allclose(tile.normal, [[0, 0, 1]] * len(tile.normal), atol=1e-2)
    where = tile.origin[:2] + tile.position[:, :2]
    np.testing.assert_allclose(tile.uv, np.stack([where[:, 0] / 100, 1 - where[:, 1] / 100], 1), atol=1e-3)


@pytest.mark.parametrize(
    ("counts", "reason"),
    [((1, 0), "points instead of"), ((0, 3), "triangles instead of"), ((0, 1), "must have triangles")],
)
def test_draco_counts_that_lie(counts, reason):
    with pytest.raises(InputError, match="/meshes/0/primitives/0/extensions/KHR_draco") as error:
        decode(draco_gltf(counts))
    assert reason in error.value.reason


def test_draco_attributes_that_are_not_there():
    with pytest.raises(InputError, match="POSITION: names an attribute that is not in the Draco data"):
        decode(draco_gltf(POSITION=77))


@pytest.mark.parametrize(
    "damage", [lambda d: d[:100], lambda d: b"DRACO" + bytes(50), lambda d: d[:60] + b"\xff" * 40 + d[100:]]
)
def test_damaged_draco(damage):
    with pytest.raises(InputError, match="Draco data is damaged"):
        decode(draco_gltf(damage=damage))


def test_draco_points():
    draco = pytest.importorskip("DracoPy")
    colours = np.array([[255, 0, 128]] * len(POSITION), np.uint8)
    data = draco.encode(POSITION, quantization_bits=20, colors=colours)
    ids = {a["attribute_type"]: a["unique_id"] for a in draco.decode(data).attributes}
    extension = {"properties": {"POSITION": ids[0], "RGB": ids[2]}, "byteOffset": 0, "byteLength": len(data)}
    table = {
        "POINTS_LENGTH": len(POSITION),
        "POSITION": {"byteOffset": 0},
        "RGB": {"byteOffset": 0},
        "extensions": {"3DTILES_draco_point_compression": extension},
    }
    tile = decode(made.pnts(table, data))
    found = tile.origin + tile.position
    by_place = [a[np.lexsort(np.round(a, 2).T)] for a in (found, POSITION)]
    np.testing.assert_allclose(by_place[0], by_place[1], atol=2e-4)
    np.testing.assert_allclose(tile.colour[0], [1, 0, ((128 / 255 + 0.055) / 1.055) ** 2.4, 1], atol=1e-6)
    table["POINTS_LENGTH"] += 1
    with pytest.raises(InputError, match="points instead of"):
        decode(made.pnts(table, data))


class Meshopt:
    """A document whose views are compressed."""

    def __init__(self):
        self.meshopt = pytest.importorskip("meshopt")
        self.content = made.Gltf(extensionsRequired=["EXT_meshopt_compression", "KHR_mesh_quantization"])

    def view(self, data, count, stride, mode="ATTRIBUTES", size=None, **more):
        described = self.content.view(data)
        at = self.content.json["bufferViews"].pop(described)
        extension = {**at, "byteStride": stride, "count": count, "mode": mode, **more}
        view = {
            "buffer": 1,
            "byteLength": count * stride if size is None else size,
            "extensions": {"EXT_meshopt_compression": extension},
        }
        if mode == "ATTRIBUTES":
            view["byteStride"] = stride
        return self.content.add("bufferViews", view)

    def vertices(self, rows, **more):
        data = self.meshopt.encode_gltf_buffer(np.ascontiguousarray(rows), "ATTRIBUTES")
        return self.view(bytes(data), len(rows), rows.dtype.itemsize * rows.shape[1], **more)

    def accessor(self, view, kind, component, **more):
        count = self.content.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]["count"]
        return self.content.add(
            "accessors",
            {"bufferView": view, "count": count, "type": kind, "componentType": component, **more},
        )

    def glb(self, primitive, **node):
        self.content.node(self.content.mesh(primitive), **node)
        self.content.json["buffers"] = [
            {"byteLength": len(self.content.binary)},
            {
                "byteLength": 1,
                "uri": "fallback.bin",
                "extensions": {"EXT_meshopt_compression": {"fallback": True}},
            },
        ]
        self.content.scene()
        return self.content.glb()


def meshopt_gltf(damage=lambda view, name: None):
    """Quantised positions, octahedral normals, exponential uv, triangles."""
    made_of = Meshopt()
    codec = made_of.meshopt
    low, step = POSITION.min(axis=0), 1e-3
    whole = np.zeros((len(POSITION), 4), np.uint16)
    whole[:, :3] = np.round((POSITION - low) / step / 4)
    position = made_of.vertices(whole)
    normal = codec.encode_filter_oct(np.hstack([NORMAL, np.zeros((len(NORMAL), 1), np.float32)]), 4, 8)
    normal = made_of.vertices(np.asarray(normal).view(np.int8).reshape(len(NORMAL), -1), filter="OCTAHEDRAL")
    uv = made_of.vertices(
        np.asarray(codec.encode_filter_exp(UV, 15)).view(np.uint32).reshape(-1, 2), filter="EXPONENTIAL"
    )
    index = bytes(codec.encode_gltf_buffer(TRIANGLES.reshape(-1), "TRIANGLES"))
    index = made_of.view(index, TRIANGLES.size, 4, "TRIANGLES")
    stride = made_of.content.json["bufferViews"][normal]["byteStride"]
    attributes = {
        "POSITION": made_of.accessor(position, "VEC3", 5123),
        "NORMAL": made_of.accessor(normal, "VEC3", 5120 if stride == 4 else 5122, normalized=True),
        "TEXCOORD_0": made_of.accessor(uv, "VEC2", 5126),
    }
    primitive = {"attributes": attributes, "indices": made_of.accessor(index, "SCALAR", 5125)}
    for name, view in (("position", position), ("normal", normal), ("uv", uv), ("index", index)):
        damage(made_of.content.json["bufferViews"][view], name)
    return made_of.glb(primitive, scale=[4 * step] * 3, translation=low.astype(float).tolist())


def test_meshopt_meshes():
    content = meshopt_gltf()
    assert tiles.list_missing_resources(content, "a") == []  # a fallback has no file
    tile = decode(content)
    plain = made.Gltf()
    plain.node(plain.mesh(plain.primitive(POSITION, TRIANGLES)))
    np.testing.assert_allclose(corners(tile), corners(decode(plain.scene().glb())), atol=2.1e-3)
    np.testing.assert_allclose(tile.normal, [[0, 0, 1]] * len(tile.normal), atol=2e-2)
    where = tile.origin[:2] + tile.position[:, :2]
    np.testing.assert_allclose(tile.uv, np.stack([where[:, 0] / 100, 1 - where[:, 1] / 100], 1), atol=1e-3)


LIES = {
    "count": (lambda e: e.update(count=10**9), "/count: must not be 1000000000 for this mode"),
    "other count": (lambda e: e.update(count=e["count"] - 3), "bytes when decompressed"),
    "stride": (lambda e: e.update(byteStride=3), "/byteStride: must not be 3 for this mode"),
    "mode": (lambda e: e.update(mode="LINES"), "has an unknown mode: LINES"),
    "filter": (lambda e: e.update(filter="WAVY"), "has an unknown filter: WAVY"),
    "place": (lambda e: e.update(byteOffset=2**40), "ends at byte"),
    "cut": (lambda e: e.update(byteLength=e["byteLength"] // 2), "its compressed data is damaged"),
}


@pytest.mark.parametrize("lie", LIES)
@pytest.mark.parametrize("which", ["position", "index"])
def test_meshopt_that_lies(lie, which):
    change, reason = LIES[lie]

    def damage(view, name):
        if name == which:
            change(view["extensions"]["EXT_meshopt_compression"])

    with pytest.raises(InputError) as error:
        decode(meshopt_gltf(damage))
    assert reason in error.value.reason or (lie, which) == ("filter", "index"), error.value.reason
    assert "EXT_meshopt_compression" in error.value.reason
