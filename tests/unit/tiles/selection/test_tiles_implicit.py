"""Implicit tilings against the definition, tile by tile; what subtrees may not do."""

import itertools
import struct

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.tiles import implicit, subtree, tree
from firetwin_core import tiles as core
from tilesets import GLB, box, load, packed, tile
from tilesets import subtree as binary


def tiling(scheme="QUADTREE", levels=2, available=4, **more):
    """A tile with an implicit tiling."""
    name = "{level}.{x}.{y}.{z}" if scheme == "OCTREE" else "{level}.{x}.{y}"
    own = {"subdivisionScheme": scheme, "subtreeLevels": levels, "availableLevels": available}
    own["subtrees"] = {"uri": f"s/{name}.subtree"}
    return tile(16.0, f"c/{name}.glb", implicitTiling=own, refine="REPLACE", **more)


def morton(dimensions, level):
    """Coordinates of a level's tiles in Morton order, one bit after another."""
    places = []
    for index in range(2 ** (dimensions * level)):
        place = [0] * 3
        for bit in range(level * dimensions):
            place[bit % dimensions] |= (index >> bit & 1) << (bit // dimensions)
        places.append(tuple(place))
    return places


@pytest.mark.parametrize(("scheme", "dimensions"), [("QUADTREE", 2), ("OCTREE", 3)])
def test_a_sparse_tiling_is_what_its_bits_say(scheme, dimensions):
    """Random availability over four levels in subtrees of two, against a walk by the definition."""
    rng = np.random.default_rng(3)
    n = 2**dimensions
    there = {(0, 0, 0, 0): True}
    for level in range(1, 4):
        for at in morton(dimensions, level):
            above = (level - 1, *(v // 2 for v in at))
            there[level, *at] = bool(there[above] and rng.random() < 0.6)
    shown = {at: bool(rng.random() < 0.7) for at in there}
    files = {}
    for level, *corner in [(0, 0, 0, 0), *((2, *at) for at in morton(dimensions, 2))]:
        if not there[level, *corner]:
            continue
        cells = [
            (level + down, *(2**down * c + v for c, v in zip(corner, at, strict=True)))
            for down in range(2)
            for at in morton(dimensions, down)
        ]
        below = [
            (level + 2, *(4 * c + v for c, v in zip(corner, at, strict=True))) for at in morton(dimensions, 2)
        ]
        name = ".".join(map(str, (level, *corner[:dimensions])))
        files[f"s/{name}.subtree"] = binary(
            [there[each] for each in cells],
            [[shown[each] for each in cells]],
            [there.get(each, False) for each in below],
        )
    loader = load(tiling(scheme), files)
    assert loader.expand_all()
    result = loader.tree
    wanted = [at for at, yes in there.items() if yes]
    assert result.size == 1 + len(wanted)
    names = sorted(result.reference(k) for k in range(result.contents))
    assert names == sorted(
        "c/" + ".".join(map(str, at[: 1 + dimensions])) + ".glb" for at in wanted if shown[at]
    )
    for content in range(result.contents):
        number, _, _, level, x, y, z = result.content[content]
        assert result.error[number] == 16.0 / 2**level
        edge = np.array([1.0 / 2**level] * dimensions + [1.0] * (3 - dimensions))
        centre = (2 * np.array([x, y, z]) + 1) * edge - 1.0
        np.testing.assert_allclose(
            result.volumes.centre[number], centre if dimensions == 3 else [*centre[:2], 0]
        )
        np.testing.assert_allclose(np.sort(result.volumes.half[number]), np.sort(edge))
        above = result.parent[number]
        assert result.error[above] == (16.0 if level == 0 else 16.0 / 2 ** (level - 1))
    assert n ** len(files)


def test_all_of_a_constant_tiling():
    files = {"s/0.0.0.subtree": binary(1, [1], 1)}
    files |= {f"s/2.{x}.{y}.subtree": binary(1, [0], 0) for x, y in itertools.product(range(4), repeat=2)}
    loader = load(tiling(), files)
    flags = loader.tree.flags()
    assert flags[0] == core.REPLACES | core.UNCONDITIONAL | core.PENDING | core.PASS_THROUGH
    loader.expand_all()
    assert loader.tree.size == 1 + 1 + 4 + 16 + 64
    assert loader.tree.contents == 5
    assert loader.tree.level.max() == 4
    assert not loader.tree.jobs


def test_regions_are_divided_across_the_date_line():
    numbers = np.array([3.0, -0.2, -3.0, 0.2, 10.0, 20.0])
    width = 2 * np.pi - 6.0
    at = np.array([[1, 0, 0, 0], [1, 1, 1, 1]])
    made = implicit.divide("region", numbers, at, 8)
    np.testing.assert_allclose(made[0], [3.0, -0.2, 3.0 + width / 2, 0.0, 10.0, 15.0])
    np.testing.assert_allclose(made[1], [3.0 + width / 2, 0.0, 3.0 + width, 0.2, 15.0, 20.0])


def test_a_volume_of_a_deep_level_is_divided_once():
    """Its edges are the edges of the root divided by a power of two, to the last bit."""
    at = np.array([[29, 123_456_789, 1, 0]])
    made = implicit.divide("box", np.array([0.1, 0, 0, 0.3, 0, 0, 0, 0.7, 0, 0, 0, 1.0]), at, 4)
    assert made[0, 3] == 0.3 / 2**29
    assert made[0, 0] == 0.1 + ((2 * 123_456_789 + 1) / 2.0**29 - 1) * 0.3


def test_metadata_replace_heights_errors_and_boxes():
    schema = {
        "classes": {
            "t": {
                "properties": {
                    "low": {"type": "SCALAR", "componentType": "INT16", "semantic": "TILE_MINIMUM_HEIGHT"},
                    "high": {"type": "SCALAR", "componentType": "FLOAT32", "semantic": "TILE_MAXIMUM_HEIGHT"},
                    "error": {
                        "type": "SCALAR",
                        "componentType": "FLOAT64",
                        "semantic": "TILE_GEOMETRIC_ERROR",
                    },
                }
            }
        }
    }
    lows, highs, errors = np.array([-5, -4], "<i2"), np.array([50, 60], "<f4"), np.array([9.0, 3.0], "<f8")
    parts = [(lows.tobytes(), 0), (highs.tobytes(), 8), (errors.tobytes(), 16)]
    buffer = b"".join(data + b"\0" * (8 - len(data) % 8 if len(data) % 8 else 0) for data, _ in parts)
    text = {
        "buffers": [{"byteLength": 40}],
        "bufferViews": [
            *({"buffer": 0, "byteOffset": at, "byteLength": len(data)} for data, at in parts),
            {"buffer": 0, "byteOffset": 32, "byteLength": 1},
        ],
        "tileAvailability": {"bitstream": 3},
        "contentAvailability": [{"constant": 1}],
        "childSubtreeAvailability": {"constant": 0},
        "tileMetadata": 0,
        "propertyTables": [
            {
                "class": "t",
                "count": 2,
                "properties": {"low": {"values": 0}, "high": {"values": 1}, "error": {"values": 2}},
            }
        ],
    }
    buffer += bytes([0b01001]) + b"\0" * 7  # the root, and the third child
    root = tiling(available=2)
    root["boundingVolume"] = {"region": [0.1, 0.1, 0.2, 0.2, 0.0, 1000.0]}
    loader = load(root, {"s/0.0.0.subtree": packed(text, buffer)}, schema=schema)
    loader.expand_all()
    assert loader.tree.error.tolist() == [16.0, 9.0, 3.0]
    flat = load(tile(1.0, volume={"region": [0.1, 0.15, 0.15, 0.2, -4.0, 60.0]})).tree.volumes
    np.testing.assert_allclose(loader.tree.volumes.half[2], flat.half[0], rtol=1e-9)


def test_1_0_by_the_extension_with_its_own_names():
    own = {"subdivisionScheme": "quadtree", "subtreeLevels": 1, "maximumLevel": 1}
    own["subtrees"] = {"uri": "{level}{x}{y}"}
    root = tile(4.0, "{level}_{x}_{y}.b3dm", extensions={"3DTILES_implicit_tiling": own})
    text = {
        "buffers": [{"uri": "bits.bin", "byteLength": 1}],
        "bufferViews": [{"buffer": 0, "byteLength": 1}],
        "tileAvailability": {"constant": 1},
        "contentAvailability": {"constant": 1},
        "childSubtreeAvailability": {"bufferView": 0},
    }
    files = {"000": text, "bits.bin": b"\x02"}
    files["110"] = binary(1, [1], 0)
    loader = load(root, files)
    loader.expand_all()
    assert [loader.tree.reference(k) for k in range(2)] == ["0_0_0.b3dm", "1_1_0.b3dm"]


def changed(**change):
    root = tiling()
    root["implicitTiling"] |= change
    return root


@pytest.mark.parametrize(
    ("root", "message"),
    [
        (changed(subdivisionScheme="BINARY"), "must be QUADTREE or OCTREE"),
        (changed(subtreeLevels=13), "subtreeLevels: must be a whole number from 1 to 12"),
        (changed(subtreeLevels=0), "subtreeLevels: must be"),
        (changed(availableLevels=31), "availableLevels: must be a whole number from 1 to 30"),
        (changed(subdivisionScheme="OCTREE", availableLevels=22), "from 1 to 21"),
        (changed(subtrees={}), "subtrees: uri is missing"),
        (tiling(volume={"sphere": [0, 0, 0, 1]}), "a sphere cannot be divided"),
        (tiling(children=[tile(1.0)]), "must not have explicit children"),
    ],
)
def test_refused_tilings(root, message):
    with pytest.raises(InputError, match=message):
        load(root)


def short(**change):
    text = {
        "buffers": [{"byteLength": 8}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 8}],
        "tileAvailability": {"bitstream": 0},
        "contentAvailability": [{"constant": 0}],
        "childSubtreeAvailability": {"constant": 0},
    }
    return packed(text | change, b"\1" * 8)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"subt", "ends within its header"),
        (b"subt" + struct.pack("<IQQ", 2, 0, 0), "version 2"),
        (b"subt" + struct.pack("<IQQ", 1, 2**63, 2**63), "says"),
        (short(buffers=[{"byteLength": 9}]), r"buffers\[0\]: says 9 bytes, there are 8"),
        (short(bufferViews=[{"buffer": 0, "byteOffset": 4, "byteLength": 5}]), "ends at byte 9"),
        (short(bufferViews=[{"buffer": 1, "byteLength": 1}]), "buffer: must be a whole number"),
        (short(bufferViews=[{"buffer": 0, "byteOffset": -1, "byteLength": 1}]), "byteOffset: must be"),
        (short(tileAvailability={"bitstream": 7}), "bitstream: must be a whole number"),
        (short(tileAvailability={}), "bitstream is missing"),
        (short(tileAvailability={"constant": 2}), "constant: must be a whole number from 0 to 1"),
        (short(bufferViews=[{"buffer": 0, "byteLength": 0}]), "needs 1 bytes for 5 bits, there are 0"),
        (short(buffers=[{"byteLength": 8}, {"byteLength": 1}]), "has no uri"),
        (b"[]", "must be an object"),
        (b"GIF89a", "is not JSON"),
    ],
)
def test_refused_subtrees(data, message):
    loader = load(tiling(), {"s/0.0.0.subtree": data})
    with pytest.raises(InputError, match=rf"^s/0\.0\.0\.subtree:.*{message}"):
        loader.expand_all()


def test_a_constant_of_too_many_tiles_is_refused_at_once():
    root = tiling("OCTREE", levels=12, available=21)
    loader = load(root, {"s/0.0.0.0.subtree": binary(1, [1], 1)})
    with pytest.raises(InputError, match="more than 1,000,000 tiles"):
        loader.expand_all()
    assert loader.tree.size == 1


def test_a_subtree_that_is_missing_leaves_the_tile_above():
    loader = load(tiling(), {"s/0.0.0.subtree": binary(1, [1], [1] + [0] * 15), "c/1.0.0.glb": GLB})
    assert loader.expand_all()
    (broken,) = loader.tree.broken
    assert loader.tree.path(broken) == "implicit tile 1"
    assert loader.tree.level[broken] == 2
    assert isinstance(loader.tree.documents[0], tree.Document)
    gone = load(tiling(), {})
    gone.expand_all()
    assert gone.tree.flags()[0] & core.BROKEN
    assert gone.tree.flags()[0] & core.CONTENT


def test_ranks_count_the_ones_before():
    values = np.random.default_rng(0).integers(0, 2, 1000)
    made = subtree.Bits(1000, np.packbits(values.astype(np.uint8), bitorder="little"))
    index = np.arange(1000)
    np.testing.assert_array_equal(made.at(index), values > 0)
    np.testing.assert_array_equal(made.ranks(index), np.cumsum(values) - values)


def test_an_implicit_root_keeps_its_box():
    loader = load(tiling(volume=box(5.0, 0, 0, 2.0)), {"s/0.0.0.subtree": binary([1, 0, 0, 0, 0], [1], 0)})
    loader.expand_all()
    np.testing.assert_allclose(loader.tree.volumes.centre[1], [5.0, 0, 0])
