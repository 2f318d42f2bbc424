"""Features of glTF: component types, strides, sparse and quantised accessors, instances, materials."""

import base64
import struct

import numpy as np
import pytest
import tile_files as made
from firetwin_core import InputError, tiles

EYE = np.eye(4)


def decode(content, **more):
    return tiles.decode(content, EYE, "tile", up_axis="Z", **more)


def places(tile):
    return tile.origin + tile.position.astype(float)


def points_of(accessor_of):
    """Decodes a document of points whose positions are an accessor that the function adds."""
    content = made.Gltf()
    content.node(content.mesh({"attributes": {"POSITION": accessor_of(content)}, "mode": 0}))
    tile = decode(content.scene().glb())
    assert all(r.points for r in tile.ranges)
    return places(tile)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "f4"])
@pytest.mark.parametrize("normalized", [False, True])
def test_component_types(kind, normalized):
    dtype = np.dtype(kind)
    info = None if kind == "f4" else np.iinfo(dtype)
    values = (
        np.array([[0, 1, 2], [100, 5, 7]], dtype)
        if info is None
        else np.array([[info.min, 1, 2], [info.max, 5, 7]], dtype)
    )
    found = points_of(lambda content: content.accessor(values, normalized and info is not None))
    expected = values.astype(float)
    if info is not None and normalized:
        expected = np.maximum(expected / info.max, -1)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("kind", ["u1", "u2", "u4"])
def test_types_of_indices(kind):
    content = made.Gltf()
    content.node(content.mesh(content.primitive(triangles=made.SQUARE_TRIANGLES.astype(kind))))
    np.testing.assert_array_equal(decode(content.scene().glb()).triangle, made.SQUARE_TRIANGLES)


def test_interleaved_attributes_at_an_odd_place():
    rows = np.zeros(4, [("p", "<f4", 3), ("n", "i1", 4), ("t", "<u2", 2)])
    rows["p"], rows["n"][:, 2], rows["t"] = made.SQUARE, 127, [[0, 0], [65535, 0], [65535, 65535], [0, 65535]]
    content = made.Gltf()
    view = content.view(b"??" + rows.tobytes(), byteStride=rows.itemsize)

    def column(offset, component, kind, **more):
        return content.add(
            "accessors",
            {
                "bufferView": view,
                "byteOffset": offset,
                "componentType": component,
                "count": 4,
                "type": kind,
                **more,
            },
        )

    named = {
        "POSITION": column(2, 5126, "VEC3"),
        "NORMAL": column(14, 5120, "VEC3", normalized=True),
        "TEXCOORD_0": column(18, 5123, "VEC2", normalized=True),
    }
    content.node(content.mesh(content.primitive(attributes=named)))
    tile = decode(content.scene().glb())
    np.testing.assert_allclose(places(tile), made.SQUARE, atol=1e-7)
    np.testing.assert_allclose(tile.normal, [[0, 0, 1]] * 4, atol=1e-7)
    np.testing.assert_allclose(tile.uv, [[0, 1], [1, 1], [1, 0], [0, 0]], atol=1e-6)  # v upward


def test_sparse_accessors():
    def sparse(content, base):
        where = {"bufferView": content.view(np.array([1, 3], "<u2").tobytes()), "componentType": 5123}
        values = {"bufferView": content.view(np.array([[7, 8, 9], [1, 2, 3]], "<f4").tobytes())}
        described = {"count": 2, "indices": where, "values": values}
        if base:
            return content.accessor(made.SQUARE, sparse=described)
        return content.add(
            "accessors", {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": described}
        )

    for base in (True, False):
        expected = made.SQUARE.copy() if base else np.zeros((4, 3))
        expected[[1, 3]] = [[7, 8, 9], [1, 2, 3]]
        found = points_of(lambda content, base=base: sparse(content, base))
        np.testing.assert_allclose(found, expected, atol=1e-6)


def test_quantised_positions_with_their_matrix():
    """KHR_mesh_quantization: whole numbers in a node that scales and moves them."""
    content = made.Gltf(extensionsRequired=["KHR_mesh_quantization"])
    position = np.array([[0, 0, 0], [65535, 0, 0], [65535, 65535, 100]], np.uint16)
    by = [-2709464.25, -4285102.5, 3856521.125]
    mesh = content.mesh(content.primitive(position, [[0, 1, 2]]))
    content.node(mesh, scale=[1e-3] * 3, translation=by)
    np.testing.assert_allclose(places(decode(content.scene().glb())), position * 1e-3 + by, atol=4e-6)


def test_instances_of_a_node():
    content = made.Gltf(extensionsRequired=["EXT_mesh_gpu_instancing"])
    by = np.array([[0, 0, 0], [10, 0, 0]], np.float32)
    turn = np.array([[0, 0, 0, 127], [0, 0, 90, 90]], np.int8)
    size = np.array([[1, 1, 1], [2, 2, 2]], np.float32)
    attributes = {
        "TRANSLATION": content.accessor(by),
        "ROTATION": content.accessor(turn, normalized=True),
        "SCALE": content.accessor(size),
    }
    content.node(
        content.mesh(content.primitive()),
        translation=[0, 0, 5],
        extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}},
    )
    tile = decode(content.scene().glb())
    turned = 2 * np.stack([-made.SQUARE[:, 1], made.SQUARE[:, 0], made.SQUARE[:, 2]], 1) + [10, 0, 5]
    expected = [*(made.SQUARE + np.array([0, 0, 5])), *turned]
    np.testing.assert_allclose(places(tile), expected, atol=1e-6)
    assert tile.triangle.max() == 7
    assert len(tile.ranges) == 1


def instances(table, binary=b"", **more):
    tree = made.Gltf()
    tree.node(tree.mesh(tree.primitive(np.array([[0, 0, 0], [1, 0, 0], [0, 2, 3]], np.float32), [[0, 1, 2]])))
    tile = decode(made.i3dm(tree.scene().glb(), table, binary), **more)
    return places(tile).reshape(-1, 3, 3)


def test_instanced_content():
    right, up = [0, 1, 0, 1, 0, 0], [-1, 0, 0, 0, 1, 0]  # a quarter turn about z, and none
    table = {
        "INSTANCES_LENGTH": 2,
        "POSITION": [1, 2, 3, 4, 5, 6],
        "RTC_CENTER": [100, 0, 0],
        "NORMAL_UP": up,
        "NORMAL_RIGHT": right,
        "SCALE": [1, 2],
        "SCALE_NON_UNIFORM": [1, 1, 1, 1, 3, 1],
    }
    expected = [[[101, 2, 3], [101, 3, 3], [99, 2, 6]], [[104, 5, 6], [106, 5, 6], [104, 17, 12]]]
    np.testing.assert_allclose(instances(table), expected, atol=1e-5)


def test_quantised_instances():
    """POSITION_QUANTIZED, and normals in two numbers: x to +x, y to +z."""
    binary = struct.pack("<6H", 0, 65535, 0, 65535, 0, 32768) + struct.pack(
        "<8H", *(32768, 32768) * 2, *(65535, 32768) * 2
    )
    table = {
        "INSTANCES_LENGTH": 2,
        "POSITION_QUANTIZED": {"byteOffset": 0},
        "QUANTIZED_VOLUME_OFFSET": [1, 2, 3],
        "QUANTIZED_VOLUME_SCALE": [10, 20, 30],
        "NORMAL_UP_OCT32P": {"byteOffset": 12},
        "NORMAL_RIGHT_OCT32P": {"byteOffset": 20},
    }
    found = instances(table, binary)
    np.testing.assert_allclose(found[:, 0], [[1, 22, 3], [11, 2, 18]], atol=3e-3)
    np.testing.assert_allclose(found[0, 2] - found[0, 0], [0, -3, 2], atol=1e-3)


def test_instances_that_stand_upright():
    """On the equator at 90 degrees east: east is -x, north z, up y."""
    table = {
        "INSTANCES_LENGTH": 1,
        "POSITION": [0, 0, 0],
        "RTC_CENTER": [0, 6378137, 0],
        "EAST_NORTH_UP": True,
    }
    expected = np.array([[0, 0, 0], [-1, 0, 0], [0, 3, 2]]) + np.array([0, 6378137, 0])
    np.testing.assert_allclose(instances(table)[0], expected, atol=1e-6)
    moved = np.array([[0, 1, 0, 0], [-1, 0, 0, 6378137], [0, 0, 1, 0], [0, 0, 0, 1]], float)
    table["RTC_CENTER"] = [0, 0, 0]
    inner = np.array([[0, 0, 0], [0, -1, 0], [-3, 0, 2]], float)  # in the content's own axes
    np.testing.assert_allclose(instances(table, earth_matrix=moved)[0], inner, atol=1e-6)


def test_files_beside_the_content():
    """An i3dm's model by uri, whose buffer and picture are in its folder."""
    content = made.square(
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        images=[{"uri": "wood.png"}],
        textures=[{"source": 0}],
    )
    content.json["meshes"][0]["primitives"][0]["material"] = 0
    content.json["buffers"] = [{"byteLength": len(content.binary), "uri": "tree.bin"}]
    model = made.glb(content.document())
    i3dm = made.i3dm(b"models/tree.glb ", {"INSTANCES_LENGTH": 1, "POSITION": [0, 0, 0]}, embedded=False)
    resources = {}
    assert tiles.list_missing_resources(i3dm, "a") == ["models/tree.glb"]
    with pytest.raises(InputError, match=r"models/tree\.glb is not among the resources"):
        decode(i3dm)
    resources["models/tree.glb"] = model
    assert tiles.list_missing_resources(i3dm, "a", resources) == ["models/tree.bin"]
    resources["models/tree.bin"] = content.binary
    assert tiles.list_missing_resources(made.cmpt(i3dm), "a", resources) == []
    tile = decode(i3dm, resources=resources)
    np.testing.assert_allclose(places(tile), made.SQUARE, atol=1e-7)
    assert [(i.kind, i.uri, i.data) for i in tile.images] == [("", "models/wood.png", b"")]
    resources["models/wood.png"] = made.png(7, 9)
    (image,) = decode(i3dm, resources=resources).images
    assert (image.kind, image.width, image.height, image.data) == ("png", 7, 9, made.png(7, 9))


def test_data_uris():
    content = made.square(
        images=[{"uri": "data:image/png;base64," + base64.b64encode(made.png(5, 6)).decode()}]
    )
    text = base64.b64encode(content.binary).decode()
    content.json["buffers"] = [
        {"byteLength": len(content.binary), "uri": "data:application/gltf-buffer;base64," + text}
    ]
    content.json |= {
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    }
    content.json["meshes"][0]["primitives"][0]["material"] = 0
    document = made.glb(content.document())
    assert tiles.list_missing_resources(document, "a") == []
    tile = decode(document)
    np.testing.assert_allclose(places(tile), made.SQUARE, atol=1e-7)
    assert (tile.images[0].width, tile.images[0].height, tile.images[0].uri) == (5, 6, "")
    content.json["buffers"][0]["uri"] = "data:application/octet-stream,abc"
    with pytest.raises(InputError, match="/buffers/0/uri: must be base64 data"):
        decode(made.glb(content.document()))


@pytest.mark.parametrize("kind", ["png", "jpeg", "webp"])
def test_materials(kind):
    data = getattr(made, kind)(300, 20)
    content = made.Gltf(
        extensionsRequired=["KHR_texture_transform", "EXT_texture_webp", "KHR_materials_unlit"]
    )
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    content.json["images"] = [
        {"uri": "unused.ktx2"},
        {"bufferView": content.view(data), "mimeType": "text/html"},
    ]
    content.json["samplers"] = [{"wrapS": 33071, "wrapT": 33648}]
    content.json["textures"] = [
        {"source": 0, "sampler": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}
    ]
    moved = {"offset": [0.25, 0.5], "rotation": np.pi / 2, "scale": [2, 3], "texCoord": 1}
    texture = {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": moved}}
    content.json["materials"] = [
        {"name": "unused"},
        {
            "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "baseColorTexture": texture},
            "alphaMode": "MASK",
            "alphaCutoff": 0.75,
            "doubleSided": True,
            "extensions": {"KHR_materials_unlit": {}},
        },
    ]
    attributes = {"TEXCOORD_0": uv * 0, "TEXCOORD_1": uv}
    content.node(content.mesh(content.primitive(attributes=attributes, material=1)))
    tile = decode(content.scene().glb())
    (material,), (image,) = tile.materials, tile.images
    assert (material.image, material.wrap_u, material.wrap_v) == (0, "clamp", "mirror")
    assert (material.alpha_mode, material.alpha_cutoff, material.double_sided) == ("mask", 0.75, True)
    np.testing.assert_allclose(material.colour, [0.1, 0.2, 0.3, 0.4])
    assert (image.kind, image.width, image.height, image.data) == (kind, 300, 20, data)
    u, v = 2 * uv[:, 0], 3 * uv[:, 1]  # the extension's own example: T R S
    c, s = 0, 1
    expected = np.stack([c * u + s * v + 0.25, 1 - (-s * u + c * v + 0.5)], 1)
    np.testing.assert_allclose(tile.uv, expected, atol=1e-6)


def test_texture_coordinates_that_are_not_finite():
    uv = np.array([[np.nan, 0], [1e38, 1e38], [0, np.inf], [0, 0.25]], np.float32)
    content = made.Gltf(materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
    moved = {"KHR_texture_transform": {"scale": [1e10, 1]}}
    content.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = moved
    content.json |= {"textures": [{"source": 0}], "images": [{"uri": "a.png"}]}
    content.node(content.mesh(content.primitive(attributes={"TEXCOORD_0": uv}, material=0)))
    np.testing.assert_allclose(decode(content.scene().glb()).uv, [[0, 0]] * 3 + [[0, 0.75]])


def test_colours_of_vertices():
    content = made.Gltf()
    rgb = np.array([[0, 255, 51]] * 4, np.uint8)
    named = {"COLOR_0": content.accessor(rgb, normalized=True)}
    content.node(content.mesh(content.primitive(attributes=named), content.primitive()))
    np.testing.assert_allclose(
        decode(content.scene().glb()).colour, [[0, 1, 0.2, 1]] * 4 + [[1] * 4] * 4, atol=1e-6
    )


def test_normals_without_length_point_up():
    content = made.Gltf()
    normal = np.array([[0, 0, 0], [np.nan, 0, 0], [0, 0, 5], [3, 0, 0]], np.float32)
    content.node(content.mesh(content.primitive(attributes={"NORMAL": normal})))
    found = decode(content.scene().glb()).normal
    np.testing.assert_allclose(found, [[0, 0, 1]] * 3 + [[1, 0, 0]], atol=1e-6)


def test_arrays_are_views_of_the_tile():
    tile = decode(made.square().glb())
    kept = tile.position
    del tile
    assert not kept.flags.writeable
    np.testing.assert_allclose(np.ptp(kept, axis=0), [1, 1, 0])
