"""Tilesets to flat arrays: accepted and tolerated input, and rejected input by its JSON path."""

import json
import math
import time

import numpy as np
import pytest
from firetwin import ellipsoid
from firetwin.errors import InputError
from firetwin.tiles import cut, explicit, json_text, metadata, tree, volumes
from firetwin.tiles.loader import Loader
from firetwin_core import tiles as core
from tile_views import HERE, looking, names
from tilesets import GLB, Memory, box, load, tile, tileset

SHIFT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1]  # column by column
DOUBLE = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]


def test_parents_come_before_children_and_refine_is_inherited():
    leaf = tile(1.0, "c.glb")
    result = load(tile(8.0, "a.glb", [tile(4.0, "b.glb", [leaf], refine="ADD"), leaf], refine="REPLACE")).tree
    assert result.parent.tolist() == [-1, 0, 1, 0]
    assert result.error.tolist() == [8.0, 4.0, 1.0, 1.0]
    assert result.replaces.tolist() == [True, False, False, True]
    assert result.level.tolist() == [0, 1, 2, 1]
    assert [result.reference(k) for k in range(4)] == ["a.glb", "b.glb", "c.glb", "c.glb"]
    assert result.path(2) == "$.root.children[0].children[0]"


def test_transforms_chain_and_scale_errors_spheres_and_boxes_but_no_regions():
    region = {"region": [0.1, 0.2, 0.11, 0.21, 0.0, 50.0]}
    ball = {"sphere": [1, 0, 0, 3]}
    inner = [tile(1.0, volume=ball, transform=DOUBLE), tile(1.0, volume=region, transform=DOUBLE)]
    result = load(tile(4.0, children=inner, transform=SHIFT, refine="ADD")).tree
    np.testing.assert_array_equal(result.matrix_of(0)[:3, 3], [10, 20, 30])
    np.testing.assert_array_equal(result.matrix_of(1) @ [1, 0, 0, 1], [12, 20, 30, 1])
    assert result.error.tolist() == [4.0, 2.0, 2.0]
    np.testing.assert_allclose(result.volumes.centre[:2], [[10, 20, 30], [12, 20, 30]])
    np.testing.assert_allclose(result.volumes.padding, [0, 6, 0])
    alone = load(tile(1.0, volume=region)).tree
    np.testing.assert_array_equal(result.volumes.centre[2], alone.volumes.centre[0])


def test_an_external_tileset_continues_the_transforms_below_its_holder():
    files = {"in/sub.json": tileset(tile(2.0, "x.glb", transform=DOUBLE)), "in/x.glb": GLB}
    loader = load(tile(8.0, "in/sub.json", transform=SHIFT, refine="REPLACE"), files)
    assert loader.tree.flags().tolist() == [
        core.REPLACES | core.UNCONDITIONAL | core.PENDING | core.PASS_THROUGH,
    ]
    loader.expand([0])
    result = loader.tree
    assert result.parent.tolist() == [-1, 0]
    assert result.error.tolist() == [8.0, 4.0]
    np.testing.assert_array_equal(result.matrix_of(1) @ [1, 0, 0, 1], [12, 20, 30, 1])
    assert loader.content_uri(1) == "in/x.glb"
    assert result.replaces.all()  # inherited
    assert result.flags().tolist()[1] == core.REPLACES | core.CONTENT


def test_a_content_is_told_by_its_bytes():
    """A tileset without .json, and a glTF with it."""
    files = {"hidden": tileset(tile(1.0, "x.glb")), "x.glb": GLB, "m.json": {"asset": {"version": "2.0"}}}
    loader = load(tile(8.0, None, [tile(4.0, "hidden"), tile(4.0, "m.json")], refine="ADD"), files)
    loader.expand(list(loader.tree.jobs))
    assert loader.check([0, 1])
    assert loader.tree.parent.tolist() == [-1, 0, 0, 1]
    assert loader.kind(0) == "tileset"
    assert loader.kind(1) == "gltf"
    flags = loader.tree.flags()
    assert flags[1] & core.PASS_THROUGH
    assert flags[2] == core.CONTENT


def test_empty_tiles_are_refined_if_their_error_is_not_below_their_parents():
    below = [tile(8.0, children=[tile(1.0, "a.glb")]), tile(4.0, children=[tile(1.0, "b.glb")]), tile(9.0)]
    flags = load(tile(8.0, "r.glb", below, refine="REPLACE")).tree.flags()
    assert [bool(each & core.UNCONDITIONAL) for each in flags] == [False, True, False, False, False, False]


@pytest.mark.parametrize(
    ("change", "error", "replaces"),
    [
        ({"refine": "add"}, 8.0, False),
        ({"refine": "replace"}, 8.0, True),
        ({"geometricError": 2**53}, float(2**53), True),
        ({"geometricError": None}, 1000.0, True),
        ({"children": []}, 8.0, True),
        ({"content": {"url": "a.glb"}}, 8.0, True),
        ({"content": {"uri": ""}}, 8.0, True),
        ({"boundingVolume": {"box": [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0]}}, 8.0, True),
        ({"boundingVolume": {"box": [0] * 12}}, 8.0, True),
    ],
)
def test_what_tilesets_in_use_have(change, error, replaces):
    made = load(tile(8.0) | change).tree
    assert (made.error.tolist(), made.replaces.tolist()) == ([error], [replaces])
    assert np.isfinite(made.volumes.axis).all()


def test_a_missing_error_is_half_the_parents_and_a_larger_one_is_kept():
    children = [tile(0.0, "a.glb"), tile(90.0, "b.glb")]
    del children[0]["geometricError"]
    assert load(tile(8.0, children=children)).tree.error.tolist() == [8.0, 4.0, 90.0]


def test_a_byte_order_mark_and_gzip_are_no_matter():
    import gzip

    text = b"\xef\xbb\xbf" + json.dumps(tileset(tile(8.0))).encode()
    assert Loader(Memory({"tileset.json": gzip.compress(text)})).tree.size == 1


def test_several_contents_of_1_1_and_of_the_extension():
    several = [{"uri": "a.glb"}, {"uri": "b.glb", "boundingVolume": box(half=0.5)}]
    extension = {"extensions": {"3DTILES_multiple_contents": {"content": several}}}
    for more in ({"contents": several}, extension):
        made = load(tile(8.0) | more).tree
        assert made.content[:, 0].tolist() == [0, 0]
        assert list(made.content_volume) == [1]
        assert made.contents_of(np.array([0])).tolist() == [0, 1]


def test_metadata_of_a_tile_replace_its_volume_and_error():
    kinds = {
        "b": {"type": "SCALAR", "componentType": "FLOAT64", "array": True, "count": 4},
        "e": {"type": "SCALAR", "componentType": "FLOAT64", "semantic": "TILE_GEOMETRIC_ERROR"},
    }
    kinds["b"]["semantic"] = "TILE_BOUNDING_SPHERE"
    schema = {"classes": {"tile": {"properties": kinds}}}
    own = {"class": "tile", "properties": {"b": [1, 2, 3, 4], "e": 5}}
    made = load(tile(8.0, metadata=own), schema=schema).tree
    assert (made.error[0], made.volumes.padding[0]) == (5.0, 4.0)
    outside = load(tile(8.0, metadata=own), {"s.json": schema}, schemaUri="s.json").tree
    assert outside.error[0] == 5.0
    heights = metadata.Overrides(low=-1.0, high=7.0)
    assert heights.with_heights("region", [0, 0, 1, 1, 2, 3]) == [0, 0, 1, 1, -1.0, 7.0]


REFUSED = [
    ({"asset": None}, "asset is missing"),
    ({"asset": {"version": "3.0"}}, r"\$\.asset: version '3\.0'"),
    ({"root": None}, "root is missing"),
    ({"root": []}, r"\$\.root: must be an object"),
    ({"extensionsRequired": ["X_y"]}, r"extensionsRequired\[0\]: the required extension 'X_y'"),
    ({"geometricError": -1}, r"\$\.geometricError: must not be negative"),
]
REFUSED_TILES = [
    ({"geometricError": -0.5}, r"\$\.root\.geometricError: must not be negative"),
    ({"geometricError": "1"}, "must be a finite number"),
    ({"geometricError": 10**400}, "must be a finite number"),
    ({"geometricError": True}, "must be a finite number"),
    ({"boundingVolume": None}, "boundingVolume is missing"),
    ({"boundingVolume": {"extensions": {"S2": {}}}}, "has no box, region or sphere .extensions, S2"),
    ({"boundingVolume": {"box": [0] * 11}}, "must be 12 numbers"),
    ({"boundingVolume": {"sphere": [0, 0, 0, -1]}}, "negative radius"),
    ({"boundingVolume": {"region": [0, 1, 0, 0.5, 0, 0]}}, "south <= north"),
    ({"boundingVolume": {"region": [0, 0, 7, 0.5, 0, 0]}}, "beyond a turn"),
    ({"boundingVolume": {"sphere": [1e16, 0, 0, 1]}}, "beyond 1e15"),
    ({"refine": "BOTH"}, r"\$\.root\.refine: must be ADD or REPLACE"),
    ({"transform": [1.0] * 16}, "not affine"),
    ({"transform": [1e150, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, "scale of its transform"),
    ({"transform": [1, 2]}, "must be 16 numbers"),
    ({"content": {}}, r"\$\.root\.content: uri is missing"),
    ({"content": {"uri": 5}}, "must be a string"),
    ({"contents": [{"uri": "a"}] * 65}, r"\$\.root\.contents: has more than 64 contents"),
    ({"children": {}}, r"\$\.root\.children: must be an array"),
    ({"children": [1]}, r"\$\.root\.children\[0\]: must be an object"),
]


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_refused_tilesets(change, message):
    with pytest.raises(InputError, match=message):
        Loader(Memory({"tileset.json": tileset(tile(8.0)) | change}))


@pytest.mark.parametrize(("change", "message"), REFUSED_TILES)
def test_refused_tiles(change, message):
    root = tile(8.0) | change
    if change.get("geometricError") is None and "transform" in change:
        root["geometricError"] = 1e200
    with pytest.raises(InputError, match=rf"^tileset\.json: .*{message}"):
        load(root)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"{", r":1:2: is not JSON"),
        (b"\xff{}", "is not UTF-8"),
        (b'{"a": NaN}', "NaN is not a number"),
        (b"[" * 257 + b"]" * 257, "more than 256"),
        (b"[" * 100_000, "more than 256"),
        (b'{"a": "' + b"[" * 300 + b'"', "is not JSON"),
        (b'{"a": ' + b"9" * 5000 + b"}", "is not JSON"),
    ],
)
def test_refused_json(text, message):
    with pytest.raises(InputError, match=f"^x.json:?.*{message}"):
        json_text.parse(text, "x.json")


def test_a_json_text_of_more_than_64_mb_is_refused(monkeypatch):
    monkeypatch.setattr(json_text, "MAX_BYTES", 10)
    with pytest.raises(InputError, match="is larger than"):
        json_text.parse(b'{"a": [1, 2]}', "x.json")
    assert json_text.parse(b'{"a":"[["}', "x.json").value == {"a": "[["}


def test_cycles_are_refused():
    files = {"a.json": tileset(tile(4.0, "b.json")), "b.json": tileset(tile(2.0, "a.json"))}
    loader = load(tile(8.0, "a.json"), files)
    with pytest.raises(InputError, match=r"^a\.json: \$: the tileset contains itself"):
        loader.expand_all()


def test_nested_tilesets_are_limited(monkeypatch):
    files = {f"{i}.json": tileset(tile(4.0, f"{i + 1}.json")) for i in range(70)}
    loader = load(tile(8.0, "0.json"), files)
    with pytest.raises(InputError, match="more than 64 tilesets in one another"):
        loader.expand_all()
    assert loader.tree.size == 64


def test_tiles_are_limited(monkeypatch):
    monkeypatch.setattr(tree, "MOST_TILES", 5)
    files = {"a.json": tileset(tile(4.0, children=[tile(1.0)] * 3))}
    loader = load(tile(8.0, children=[tile(4.0, "a.json"), tile(4.0, "a.json")]), files)
    with pytest.raises(InputError, match="more than 5 tiles"):
        loader.expand_all()
    assert loader.tree.size == 3  # nothing of the file was appended


def test_what_is_missing_makes_a_tile_broken():
    loader = load(tile(8.0, "r.glb", [tile(4.0, "gone.json")]), {"r.glb": GLB})
    assert loader.expand_all()
    assert list(loader.tree.broken) == [1]
    assert loader.tree.flags()[1] & core.BROKEN
    assert loader.check([0, 1]) is True
    assert loader.tree.broken == {1: "gone.json: is not there"}


def test_a_deep_tree_is_read_without_recursion():
    inner = tile(1.0)
    for depth in range(120):
        inner = tile(float(depth + 2), children=[inner])
    assert load(inner).tree.level.max() == 120


def test_many_tiles_are_read_in_linear_time():
    def seconds(count):
        root = tile(8.0, children=[tile(1.0, f"{i}.glb") for i in range(count)])
        node = json_text.parse(json.dumps(tileset(root)).encode(), "t")
        before = time.process_time()
        explicit.read(tree.Tree(), node, "t")
        return time.process_time() - before

    few, many = (min(seconds(count) for _ in range(2)) for count in (500, 4000))
    assert many < 40 * max(few, 0.005)


def inside(volume, places):
    """Return the distances of points (n, 3) from the first box, m."""
    along = np.abs((places - volume.centre[0]) @ volume.axis[0].T) - volume.half[0]
    return along.max()


@pytest.mark.parametrize(
    "region",
    [
        [0.1, 0.2, 0.11, 0.21, -30.0, 90.0],
        [-2.1, 0.6, -2.0, 0.75, 0.0, 4000.0],
        [3.1, -0.3, -3.1, 0.4, 0.0, 100.0],  # across the date line
        [-0.4, 1.2, 0.9, math.pi / 2, 0.0, 10.0],  # the pole
        [-1.5, -1.4, 1.6, 1.0, -500.0, 500.0],
        [-math.pi, -math.pi / 2, math.pi, math.pi / 2, -100.0, 9000.0],
        [-2.0, 0.3, 2.5, 0.4, 0.0, 9000.0],
        [0.5, 0.5, 0.5, 0.5, 10.0, 0.0],  # no width, and the heights swapped
    ],
)
def test_a_box_holds_its_region_and_is_hardly_larger(region):
    boxes = volumes.of_regions(np.array([region]))
    west, south, east, north, low, high = region
    width = (east - west) % (2 * math.pi) or (2 * math.pi if east > west else 0.0)
    grid = np.meshgrid(np.linspace(0, width, 41), np.linspace(south, north, 41), [low, high])
    lon, lat, height = (each.ravel() for each in grid)
    places = ellipsoid.ecef(lat, west + lon, height)
    assert inside(boxes, places) < 1e-6
    along = (places - boxes.centre[0]) @ boxes.axis[0].T
    if width <= math.pi:
        np.testing.assert_allclose(np.abs(along).max(axis=0), boxes.half[0], rtol=0.01, atol=1e-6)


def test_slanted_boxes_are_held_by_their_box():
    rng = np.random.default_rng(1)
    numbers = rng.normal(size=(200, 12))
    boxes = volumes.of_boxes(numbers)
    signs = rng.choice([-1.0, 1.0], size=(200, 3))
    corner = numbers[:, :3] + np.einsum("nk,nki->ni", signs, numbers[:, 3:].reshape(-1, 3, 3))
    along = np.abs(np.einsum("nki,ni->nk", boxes.axis, corner - boxes.centre)) - boxes.half
    assert along.max() < 1e-9
    np.testing.assert_allclose(
        np.einsum("nki,nji->nkj", boxes.axis, boxes.axis), [np.eye(3)] * 200, atol=1e-12
    )
    assert (boxes.radius >= np.linalg.norm(corner - boxes.centre, axis=1) - 1e-9).all()


FLAT = [[0] * 15 + [1], [1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 1] + [0] * 9 + [1]]


@pytest.mark.parametrize("transform", FLAT)
def test_a_tile_that_its_transform_flattens_is_left_out_with_one_line(transform):
    """The specification's validator passes it. Its parent stays in its place, its siblings are shown."""
    files = {"root.glb": GLB, "beside.glb": GLB}
    flat = tile(1.0, "flat.glb", [tile(0.0, "below.glb")], transform=transform)
    loader = load(tile(8.0, "root.glb", [flat, tile(1.0, "beside.glb")], refine="REPLACE"), files)
    tree = loader.tree
    (reason,) = tree.broken.values()
    assert reason == (
        "tileset.json: $.root.children[0].transform: flattens the tile (determinant 0), which is not shown"
    )
    assert [tree.reference(k) for k in range(len(tree.content))] == ["root.glb", "beside.glb"]
    number = next(iter(tree.broken))
    assert tree.flags()[number] & core.BROKEN
    assert tree.flags()[number] & core.CONTENT
    chosen = cut.select_tiles(loader, looking(-50.0), HERE, 0.01)
    assert names(loader, chosen) == ["root.glb"]
    assert list(chosen.missing.values()) == [reason]


def test_a_tileset_that_its_transform_flattens_has_no_tile_and_one_line():
    tree = load(tile(8.0, "root.glb", [tile(1.0, "a.glb")], transform=FLAT[0])).tree
    assert (tree.size, tree.contents, len(tree.broken)) == (1, 0, 1)


def test_a_transform_that_is_not_finite_with_its_parents_is_refused():
    huge = [1e300, 0, 0, 0, 0, 1e300, 0, 0, 0, 0, 1e300, 0, 0, 0, 0, 1]
    with pytest.raises(InputError, match="is not finite with its parents"):
        load(tile(0.0, children=[tile(0.0, transform=huge)], transform=huge))
