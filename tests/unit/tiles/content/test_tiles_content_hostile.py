"""Content that lies: every one is refused with its name and the place in its JSON, or is harmless."""

import json
import struct

import numpy as np
import pytest
import tile_files as made
from firetwin_core import InputError, tiles


def decode(content, **more):
    return tiles.decode(content, np.eye(4), "set/a.b3dm", **more)


def refused(content, reason, **more):
    with pytest.raises(InputError) as error:
        decode(content, **more)
    assert error.value.path.startswith("set/a.b3dm")
    assert reason in error.value.reason, error.value.reason


def changed(change):
    """A square whose document was changed."""
    content = made.square()
    change(content.json)
    return content.glb()


def put(*path_and_value):
    """Sets a value deep in a document."""
    *path, key, value = path_and_value

    def change(document):
        for each in path:
            document = document[each]
        document[key] = value

    return changed(change)


CASES = {
    "accessor beyond its view": (put("accessors", 0, "count", 5), "/accessors/0: its 5 elements need 60"),
    "accessor count that overflows": (put("accessors", 0, "count", 2**53), "/accessors/0/count: is 9007"),
    "negative count": (put("accessors", 0, "count", -1), "/accessors/0/count: must be a whole number"),
    "count of a half": (put("accessors", 0, "count", 1.5), "/accessors/0/count: must be a whole number"),
    "offset that overflows": (put("accessors", 0, "byteOffset", 2**53), "/accessors/0: its 4 elements"),
    "view beyond its buffer": (put("bufferViews", 0, "byteLength", 10**6), "/bufferViews/0: ends at byte"),
    "view offset that overflows": (put("bufferViews", 0, "byteOffset", 2**53), "/bufferViews/0: ends"),
    "stride below the element": (put("bufferViews", 0, "byteStride", 4), "overlap: the stride is 4"),
    "stride too wide": (put("bufferViews", 0, "byteStride", 260), "/bufferViews/0/byteStride: is 260"),
    "buffer that is too short": (
        put("buffers", [{"byteLength": 10**6}]),
        "/buffers/0: declares 1000000 bytes",
    ),
    "buffer of nowhere": (
        put("buffers", [{"byteLength": 4, "uri": "a.bin"}]),
        "/buffers/0/uri: the file a.bin",
    ),
    "type that is none": (
        put("accessors", 0, "componentType", 5124),
        "5124, which is not a glTF component type",
    ),
    "matrix accessor": (put("accessors", 0, "type", "MAT4"), "/accessors/0/type: is MAT4"),
    "positions of two numbers": (put("accessors", 0, "type", "VEC2"), "/POSITION: names 4 x 2 numbers"),
    "indices that are floats": (put("accessors", 1, "componentType", 5126), "cannot be indices"),
    "mesh that is not there": (put("nodes", 0, "mesh", 3), "/nodes/0/mesh: is 3, but there are only 1"),
    "node that is its own child": (
        put("nodes", 0, "children", [0]),
        "/nodes/0/children/0: node 0 is reached",
    ),
    "scene that is not there": (put("scene", 4), "/scene: is 4"),
    "mode that is none": (put("meshes", 0, "primitives", 0, "mode", 9), "/mode: is 9"),
    "perspective": (put("nodes", 0, "matrix", [1, 0, 0, 1] * 4), "/nodes/0/matrix: must be affine"),
    "short matrix": (put("nodes", 0, "matrix", [1]), "/nodes/0/matrix: must have 16 numbers, not 1"),
    "unknown extension": (put("extensionsRequired", ["EXT_new"]), "/extensionsRequired/0: requires EXT_new"),
    "basisu": (put("extensionsRequired", ["KHR_texture_basisu"]), "KTX2"),
    "techniques": (put("extensionsRequired", ["KHR_techniques_webgl"]), "KHR_techniques_webgl"),
    "glTF 1": (put("asset", {"version": "1.0"}), "/asset: is glTF 1.0"),
    "text for a number": (put("nodes", 0, "translation", ["1", 2, 3]), "/translation/0: must be a number"),
    "list for an object": (put("meshes", [[]]), "/meshes/0: must be an object"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_document_that_lies(case):
    refused(*CASES[case])


def test_indices_beyond_the_vertices():
    content = made.Gltf()
    content.node(content.mesh(content.primitive(triangles=[[0, 1, 4]])))
    refused(content.scene().glb(), "its indices exceed the number of vertices")


def test_nodes_in_a_circle_or_with_two_parents():
    def circle(document):
        document["nodes"] = [{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}]

    def diamond(document):
        document["nodes"] = [{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}]

    refused(changed(circle), "node 0 is reached twice")
    refused(changed(diamond), "node 3 is reached twice")


def test_a_long_chain_of_nodes_is_no_recursion():
    def chain(document):
        document["nodes"] = [{"children": [i + 1]} for i in range(100_000)] + [{"mesh": 0}]

    assert len(decode(changed(chain)).position) == 4


def test_attributes_of_another_length():
    content = made.Gltf()
    content.node(content.mesh(content.primitive(attributes={"TEXCOORD_0": np.zeros((3, 2), np.float32)})))
    content.json["materials"] = [{}]
    content.json["meshes"][0]["primitives"][0]["material"] = 0
    refused(content.scene().glb(), "/TEXCOORD_0: names 3 x 2 numbers instead of 4 x 2")


@pytest.mark.parametrize(
    ("sparse", "reason"),
    [
        ({"count": 5}, "replaces 5 of 4"),
        ({"count": 1}, "names element 200 of 4"),
        ({"count": 2}, "need 24 bytes"),
    ],
)
def test_sparse_accessors_that_lie(sparse, reason):
    content = made.square()
    where = {"bufferView": content.view(bytes([200, 1])), "componentType": 5121}
    values = {"bufferView": content.view(bytes(12))}
    content.json["accessors"][0]["sparse"] = {"indices": where, "values": values, **sparse}
    refused(content.glb(), reason)


def test_json_that_is_deep_long_or_broken():
    refused(b'{"a":' + b"[" * 300 + b"]" * 300 + b"}", "nested deeper than 256")
    with pytest.raises(InputError, match="not valid") as error:
        decode(b'{"asset": {},\n "nodes": [1,, 2]}')
    assert (error.value.line, error.value.column) == (2, 14)
    refused(b'{"asset": {"version": "2.0"}, "scene": 1e999}', "not valid")
    refused(b'{"asset": 3}', "/asset: must be an object")


@pytest.mark.parametrize("where", [4, 8, 12, 16])  # version, length, length of a chunk, its type
def test_a_glb_with_a_wrong_header(where):
    content = bytearray(made.square().glb())
    content[where : where + 4] = struct.pack("<I", 2**31)
    refused(bytes(content), "glb")


@pytest.mark.parametrize("field", range(4))
def test_tables_longer_than_the_content(field):
    content = bytearray(made.b3dm(made.square().glb()))
    content[12 + 4 * field : 16 + 4 * field] = struct.pack("<I", 500_000_000)
    refused(bytes(content), "its tables are longer")


@pytest.mark.parametrize(
    "make",
    [
        made.b3dm,
        lambda g: made.i3dm(g, {"INSTANCES_LENGTH": 1, "POSITION": [0, 0, 0]}),
        lambda g: made.cmpt(made.b3dm(g)),
        lambda g: g,
    ],
)
def test_content_cut_anywhere(make):
    whole = make(made.square().glb())
    for length in range(len(whole)):
        with pytest.raises(InputError):
            decode(whole[:length])
    assert len(decode(whole).position) == 4


def test_composites_too_deep_and_broken():
    content = made.square().glb()
    for _ in range(9):
        content = made.cmpt(content)
    assert len(decode(content).position) == 4
    refused(made.cmpt(content), "is nested in more than 8 cmpt")
    refused(made.cmpt(b"glTF" + struct.pack("<II", 2, 0)), "its length does not fit")
    refused(struct.pack("<4sIII", b"cmpt", 1, 16, 2**32 - 1), "its length does not fit")


def test_counts_beyond_the_limits():
    model = made.square().glb()
    refused(made.i3dm(model, {"INSTANCES_LENGTH": 1_000_001}), "/INSTANCES_LENGTH: is 1000001")
    refused(made.pnts({"POINTS_LENGTH": 10_000_001}, b""), "/POINTS_LENGTH: is 10000001")
    refused(
        made.pnts({"POINTS_LENGTH": 9, "POSITION": {"byteOffset": 4}}, bytes(108)),
        "needs 108 bytes from byte 4",
    )
    refused(made.pnts({"POINTS_LENGTH": 9, "POSITION": [1]}, b""), "/POSITION: must have 27 numbers")


def test_vertices_beyond_the_limit_by_instances():
    """20,000 instances of 600 vertices."""
    content = made.Gltf()
    n = 20_000
    position = np.random.default_rng(1).normal(size=(600, 3)).astype(np.float32)
    instances = {"TRANSLATION": content.add("accessors", {"count": n, "type": "VEC3", "componentType": 5126})}
    mesh = content.mesh(content.primitive(position, None))
    content.node(mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": instances}})
    refused(content.scene().glb(), "more than 10000000 vertices")


def test_instances_that_nobody_sees_count_too():
    """A million instances of a model of 2,000 hidden nodes would go on for an hour."""
    model = made.square()
    model.json["nodes"] = [{"mesh": 0, "scale": [0, 0, 0]}] * 2_000
    model.scene(*range(2_000))
    table = {"INSTANCES_LENGTH": 1_000, "POSITION": {"byteOffset": 0}}
    refused(made.i3dm(model.glb(), table, bytes(12_000)), "more than 1000000 instances")
    content = made.square()
    many = content.add("accessors", {"count": 1_000_001, "type": "VEC3", "componentType": 5126})
    extension = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": many}}}
    content.json["nodes"][0]["extensions"] = extension
    refused(content.glb(), "/TRANSLATION: has 1000001 instances")


def test_many_views_of_one_buffer_are_no_bomb():
    """Each primitive decodes the same bytes again: 1 GB is the most."""
    content = made.Gltf()
    zeros = content.add("accessors", {"count": 9_000_000, "type": "VEC3", "componentType": 5126})
    content.node(content.mesh(*[{"attributes": {"POSITION": zeros}, "mode": 0}] * 40))
    refused(content.scene().glb(), "exceeds 1 GB")


PICTURES = {
    "gif": (b"GIF89a" + bytes(30), "/images/0: is neither JPEG, PNG nor WebP"),
    "ktx2": (b"\xabKTX 20\xbb\r\n\x1a\n" + bytes(30), "/images/0: is a KTX2 texture"),
    "wide png": (made.png(16385, 1), "has 16385 x 1 pixels"),
    "high jpeg": (made.jpeg(1, 20000), "has 1 x 20000 pixels"),
    "wide webp": (made.webp(20000, 5), "has 20000 x 5 pixels"),
    "cut png": (made.png()[:20], "its png header is damaged"),
    "cut jpeg": (made.jpeg()[:12], "its jpeg header is damaged"),
    "cut webp": (made.webp()[:20], "its webp header is damaged"),
}


@pytest.mark.parametrize("case", PICTURES)
def test_pictures_that_are_refused(case):
    data, reason = PICTURES[case]
    content = made.square()
    content.json["images"] = [{"bufferView": content.view(data)}]
    content.json["textures"] = [{"source": 0}]
    content.json["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    content.json["meshes"][0]["primitives"][0]["material"] = 0
    refused(content.glb(), reason)


def test_a_texture_of_ktx2_alone():
    content = made.square(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
    content.json["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]
    content.json["meshes"][0]["primitives"][0]["material"] = 0
    refused(content.glb(), "/textures/0: has only a KTX2 image")


def test_every_byte_of_a_small_b3dm_changed():
    """An answer, or an InputError; nothing else."""
    whole = made.b3dm(made.square().glb(), {"BATCH_LENGTH": 0, "RTC_CENTER": [1, 2, 3]})
    good = 0
    for place in range(len(whole)):
        for value in (0, 0xFF, ord("9"), ord('"')):
            damaged = bytearray(whole)
            damaged[place] = value
            try:
                tile = decode(bytes(damaged))
                assert np.isfinite(tile.position).all()
                good += 1
            except InputError as error:
                json.dumps(error.reason)
    assert good > 100
