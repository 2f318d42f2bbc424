"""Content of 3D Tiles: headers, the order of matrices, nodes, precision, copyright."""

import json
import struct

import numpy as np
import pytest
import tile_files as made
from firetwin_core import InputError, tiles

EYE = np.eye(4)


def decode(content, matrix=EYE, **more):
    return tiles.decode(content, matrix, "tile", **more)


def places(tile):
    """Vertices in the scene's frame, float64."""
    return tile.origin + tile.position.astype(float)


def shifted(by, base=EYE):
    matrix = np.array(base, float)
    matrix[:3, 3] += by
    return matrix


SQUARE = made.to_z_up(made.SQUARE)


def test_a_glb_turns_from_y_up_to_z_up():
    tile = decode(made.square().glb())
    np.testing.assert_allclose(places(tile), SQUARE, atol=1e-7)
    np.testing.assert_array_equal(tile.triangle, made.SQUARE_TRIANGLES)
    np.testing.assert_allclose(tile.normal, np.tile([0, -1, 0], (4, 1)), atol=1e-7)  # glTF's +z
    assert tile.colour.shape == (0, 4)
    (part,) = tile.ranges
    assert (part.vertices, part.triangles, part.material, part.has_normals) == (4, 2, -1, False)


@pytest.mark.parametrize(("axis", "expected"), [("X", [0, 0, 1]), ("Y", [1, 0, 0]), ("Z", [1, 0, 0])])
def test_another_axis_may_point_up(axis, expected):
    tile = decode(made.square().glb(), up_axis=axis)
    np.testing.assert_allclose(places(tile)[1], expected, atol=1e-7)
    up = {"X": [1, 0, 0], "Y": [0, 1, 0], "Z": [0, 0, 1]}[axis]
    position = np.array([[0, 0, 0], up, [3, 4, 5]], np.float32)
    content = made.Gltf()
    content.node(content.mesh(content.primitive(position, [[0, 1, 2]])))
    np.testing.assert_allclose(places(decode(content.scene().glb(), up_axis=axis))[1], [0, 0, 1], atol=1e-7)


@pytest.mark.parametrize(
    "wrap", [made.b3dm, lambda g: made.b3dm_legacy(g, 20), lambda g: made.b3dm_legacy(g, 24)]
)
def test_every_b3dm_header(wrap):
    """The glb within is cut to its length: any bytes may follow."""
    content = wrap(made.square().glb() + b"\xff" * 12)
    np.testing.assert_allclose(places(decode(content)), SQUARE, atol=1e-7)
    assert tiles.content_type(content, "x") == "b3dm"


def test_matrices_in_their_order():
    """matrix, RTC_CENTER (z up), CESIUM_RTC (z up), y to z, node, node's child."""
    quarter = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]  # about glTF's z
    content = made.square(extensions={"CESIUM_RTC": {"center": [10, 20, 30]}}, extensionsUsed=["CESIUM_RTC"])
    content.json["nodes"] = [
        {"children": [1], "translation": [5, 0, 0], "rotation": quarter},
        {"mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 3, 0, 1]},
    ]
    binary = struct.pack("<3f", 1000, 2000, 3000)
    b3dm = made.b3dm(content.glb(), {"BATCH_LENGTH": 0, "RTC_CENTER": {"byteOffset": 0}}, binary)
    matrix = np.array([[0, -1, 0, 7], [1, 0, 0, 8], [0, 0, 1, 9], [0, 0, 0, 1]], float)
    local = made.SQUARE * 2.0 + np.array([0, 3, 0])
    parent = np.stack([-local[:, 1], local[:, 0], local[:, 2]], 1) + np.array([5, 0, 0])
    outer = made.to_z_up(parent) + np.array([1010, 2020, 3030])
    expected = np.stack([-outer[:, 1], outer[:, 0], outer[:, 2]], 1) + np.array([7, 8, 9])
    np.testing.assert_allclose(places(decode(b3dm, matrix)), expected, atol=1e-5)


def test_a_last_row_may_be_off_by_rounding():
    content = made.square()
    content.json["nodes"][0]["matrix"] = [1, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 0.9999998]
    found = places(decode(content.glb(), shifted([0, 0, 1e6])))
    np.testing.assert_allclose(found, SQUARE + np.array([5, -7, 1e6 + 6]), atol=1e-6)


def test_float32_about_an_origin_of_whole_metres():
    """Earth-centred: float32 alone would be 0.5 m off."""
    centre = np.array([-2709464.3217, -4285102.8813, 3856521.4532])
    content = made.square(extensions={"CESIUM_RTC": {"center": list(centre)}})
    tile = decode(content.glb())
    np.testing.assert_array_equal(tile.origin, np.round(tile.origin))
    assert np.abs(places(tile) - (SQUARE + centre)).max() < 1e-7 * 4
    assert np.abs(tile.position).max() < 2


def test_content_tells_what_float32_cost_it():
    """Earth-centred positions in float32 lie 0.5 m apart; stretched ten times, 5 m."""
    content = made.Gltf()
    centre = np.array([-2709464.3217, -4285102.8813, 3856521.4532])
    content.node(content.mesh(content.primitive((made.SQUARE + centre).astype(np.float32))))
    content.scene()
    assert decode(content.glb()).spacing == 0.5
    assert decode(content.glb(), np.diag([10, 10, 10, 1.0])).spacing == pytest.approx(5.0)
    assert decode(made.square().glb()).spacing < 2e-7


def test_a_mirror_turns_triangles_and_not_normals_inward():
    mirror = np.diag([-1.0, 1, 1, 1])
    tile = decode(made.square().glb(), mirror)
    a, b, c = (places(tile)[tile.triangle[:, i]] for i in range(3))
    facing = np.cross(b - a, c - a)
    np.testing.assert_allclose(facing / np.linalg.norm(facing, axis=1)[:, None], [[0, -1, 0]] * 2, atol=1e-6)
    np.testing.assert_allclose(tile.normal, [[0, -1, 0]] * 4, atol=1e-6)


def test_normals_of_a_slope_stay_orthogonal_when_it_is_stretched():
    content = made.Gltf()
    position = np.array([[0, 0, 0], [1, 0, 1], [0, 1, 0], [1, 1, 1]], np.float32)
    normal = np.tile(np.array([[-1, 0, 1]], np.float32) / np.float32(np.sqrt(2)), (4, 1))
    triangles = [[0, 1, 3], [0, 3, 2]]
    content.node(content.mesh(content.primitive(position, triangles, {"NORMAL": normal})), scale=[4, 1, 1])
    tile = decode(content.scene().glb(), up_axis="Z")
    assert tile.ranges[0].has_normals
    np.testing.assert_allclose(np.linalg.norm(tile.normal, axis=1), 1, rtol=1e-6)
    along = places(tile)[1] - places(tile)[0]
    np.testing.assert_allclose(tile.normal @ along, 0, atol=1e-6)
    computed = content.json["meshes"][0]["primitives"][0]["attributes"]
    del computed["NORMAL"]
    other = decode(content.glb(), up_axis="Z")
    assert not other.ranges[0].has_normals
    np.testing.assert_allclose(other.normal, tile.normal, atol=1e-6)


def test_smooth_normals_go_across_seams():
    """A ridge whose two slopes share no vertex: the ridge's normals point up."""
    position = np.array([[0, 0, 0], [1, 0, 1], [1, 1, 1], [1, 0, 1], [2, 0, 0], [1, 1, 1]], np.float32)
    content = made.Gltf()
    content.node(content.mesh(content.primitive(position, [[0, 1, 2], [3, 4, 5]])))
    tile = decode(content.scene().glb(), up_axis="Z")
    np.testing.assert_allclose(tile.normal[[1, 2, 3, 5]], [[0, 0, 1]] * 4, atol=1e-6)


def test_unused_vertices_are_left_out_and_shared_accessors_read():
    """Two materials over one accessor: each range has its own vertices."""
    content = made.Gltf()
    position = content.accessor(np.arange(30, dtype=np.float32).reshape(10, 3) ** 2)
    parts = [content.primitive(position, t, material=i) for i, t in enumerate(([[7, 1, 4]], [[9, 4, 2]]))]
    content.json["materials"] = [{}, {"doubleSided": True}]
    content.node(content.mesh(*parts))
    tile = decode(content.scene().glb(), up_axis="Z")
    expected = np.arange(30.0).reshape(10, 3) ** 2
    assert len(tile.position) == 6
    np.testing.assert_allclose(places(tile)[tile.triangle[0]], expected[[7, 1, 4]], atol=1e-4)
    np.testing.assert_allclose(places(tile)[tile.triangle[1]], expected[[9, 4, 2]], atol=1e-4)
    assert [(r.material, r.first_vertex, r.first_triangle) for r in tile.ranges] == [(0, 0, 0), (1, 3, 1)]
    assert [m.double_sided for m in tile.materials] == [False, True]


def test_strips_and_fans_and_lines():
    content = made.Gltf()
    square = content.accessor(made.SQUARE[[0, 1, 3, 2]])
    strip = content.primitive(square, [0, 1, 2, 3], mode=5)
    fan = content.primitive(square, [0, 1, 3, 2], mode=6)
    line = content.primitive(square, [0, 1], mode=3)
    content.json["scenes"] = [{"nodes": [content.node(content.mesh(strip, fan, line))]}]
    tile = decode(content.glb(), up_axis="Z")
    assert (len(tile.triangle), tile.lines) == (4, 1)
    a, b, c = (places(tile)[tile.triangle[:, i]] for i in range(3))
    np.testing.assert_allclose(np.cross(b - a, c - a), [[0, 0, 1]] * 4, atol=1e-6)


def test_vertices_that_are_not_finite_are_left_out_and_counted():
    content = made.Gltf()
    position = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, np.nan, 0], [np.inf, 0, 0]], np.float32)
    content.node(content.mesh(content.primitive(position, [[0, 1, 2], [0, 2, 3], [0, 1, 4], [0, 1, 1]])))
    tile = decode(content.scene().glb())
    assert (len(tile.position), len(tile.triangle), tile.not_finite) == (3, 1, 2)
    assert np.isfinite(tile.position).all()


@pytest.mark.parametrize("scale", [0.0, 1e300])
def test_a_tile_may_be_empty(scale):
    content = made.square()
    content.json["nodes"][0]["scale"] = [scale] * 3
    tile = decode(content.glb())
    assert tile.position.shape == (0, 3)
    assert tile.triangle.shape == (0, 3)
    assert tile.ranges == []
    assert tile.not_finite == (3 if scale else 0) or tile.not_finite == 4
    assert len(decode(made.Gltf().glb()).position) == 0


def test_a_composite_within_a_composite():
    east = made.square(asset={"version": "2.0", "copyright": "Ann; Bob "})
    west = made.square(asset={"version": "2.0", "copyright": "Bob;;Cid"})
    west.json["nodes"][0]["translation"] = [9, 0, 0]
    points = made.pnts({"POINTS_LENGTH": 1, "POSITION": [1, 2, 3]}, b"")
    tile = decode(made.cmpt(made.b3dm(east.glb()), made.cmpt(points, west.glb())))
    assert tile.copyright == "Ann; Bob; Cid"
    assert [(r.points, r.vertices) for r in tile.ranges] == [(False, 8), (True, 1)]
    np.testing.assert_allclose(places(tile)[4:8], SQUARE + np.array([9, 0, 0]), atol=1e-6)
    np.testing.assert_allclose(places(tile)[8], [1, 2, 3], atol=1e-6)


def test_what_content_is():
    kinds = {
        kind: tiles.content_type(content, "x")
        for kind, content in {
            "glb": made.glb({}),
            "gltf": b"\xef\xbb\xbf \n" + json.dumps(made.square().json).encode(),
            "tileset": b'{"asset": {"version": "1.0"}, "geometricError": 1, "root": {}}',
            "subtree": b"subt\0\0\0\0",
            "pnts": made.pnts({}, b""),
        }.items()
    }
    assert kinds == {kind: kind for kind in kinds}
    with pytest.raises(InputError, match="begins with 3c 68 74 6d"):
        tiles.content_type(b"<html>", "x")
    with pytest.raises(InputError, match="tile: is a tileset"):
        decode(b'{"root": {}}')


@pytest.mark.parametrize("matrix", [np.zeros((4, 4)), np.diag([1, 1, np.nan, 1]), np.diag([1, 1, 1, 2.0])])
def test_a_matrix_must_be_affine(matrix):
    with pytest.raises(ValueError, match="matrix"):
        decode(made.square().glb(), matrix)
