"""Point clouds of 3D Tiles."""

import struct

import numpy as np
import pytest
import tile_files as made
from firetwin_core import InputError, tiles

POSITION = np.array([[0, 0, 0], [1, 2, 3], [-4, 5, 6]], np.float32)


def decode(table, binary=b""):
    return tiles.decode(made.pnts({"POINTS_LENGTH": 3, **table}, binary), np.eye(4), "tile")


def places(tile):
    return tile.origin + tile.position.astype(float)


def linear(srgb):
    srgb = np.asarray(srgb, float)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def test_points_are_not_turned():
    """z is up already."""
    centre = [6378137.25, -100.5, 33.125]
    table = {"POSITION": {"byteOffset": 4}, "RTC_CENTER": centre}
    tile = decode(table, b"????" + POSITION.tobytes())
    np.testing.assert_allclose(places(tile), POSITION + centre, atol=1e-6)
    (part,) = tile.ranges
    assert (part.points, part.vertices, part.triangles, part.has_normals) == (True, 3, 0, False)
    assert not tile.normal.any()
    assert tile.triangle.shape == (0, 3)


def test_quantised_points():
    table = {
        "POSITION_QUANTIZED": {"byteOffset": 0},
        "QUANTIZED_VOLUME_OFFSET": [10, 20, 30],
        "QUANTIZED_VOLUME_SCALE": [1, 2, 3],
    }
    binary = struct.pack("<9H", 0, 0, 0, 65535, 65535, 65535, 13107, 26214, 39321)
    expected = [[10, 20, 30], [11, 22, 33], [10.2, 20.8, 31.8]]
    np.testing.assert_allclose(places(decode(table, binary)), expected, atol=1e-6)
    del table["QUANTIZED_VOLUME_SCALE"]
    with pytest.raises(InputError, match="neither POSITION nor POSITION_QUANTIZED"):
        decode(table, binary)


@pytest.mark.parametrize(
    ("key", "values", "srgb", "alpha"),
    [
        ("RGB", [255, 0, 128] * 3, [1, 0, 128 / 255], 1),
        ("RGBA", [255, 0, 128, 51] * 3, [1, 0, 128 / 255], 0.2),
        ("CONSTANT_RGBA", [255, 0, 128, 51], [1, 0, 128 / 255], 0.2),
        ("RGB565", [31 << 11 | 21 << 5 | 3] * 3, [1, 21 / 63, 3 / 31], 1),
    ],
)
def test_colours_become_linear(key, values, srgb, alpha):
    tile = decode({"POSITION": POSITION.ravel().tolist(), key: values})
    np.testing.assert_allclose(tile.colour, [[*linear(srgb), alpha]] * 3, atol=1e-6)


def test_colours_beyond_their_range():
    tile = decode({"POSITION": POSITION.ravel().tolist(), "RGB": [1e300, -5, 255] * 3})
    np.testing.assert_allclose(tile.colour, [[1, 0, 1, 1]] * 3)
    tile = decode({"POSITION": POSITION.ravel().tolist(), "RGB565": [-1e9, 1e300, 65535]})
    np.testing.assert_allclose(tile.colour, [[0, 0, 0, 1], [1, 1, 1, 1], [1, 1, 1, 1]])


def test_normals():
    table = {"POSITION": POSITION.ravel().tolist()}
    plain = decode({**table, "NORMAL": [0, 0, 2, 0, 1, 0, -1, 0, 0]})
    np.testing.assert_allclose(plain.normal, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-6)
    packed = decode({**table, "NORMAL_OCT16P": [128, 128, 128, 255, 0, 128]})
    np.testing.assert_allclose(packed.normal, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=2e-2)
    assert packed.ranges[0].has_normals


def test_points_that_are_not_finite():
    position = POSITION.copy()
    position[0, 1] = np.nan
    tile = decode({"POSITION": {"byteOffset": 0}, "RGB": [9, 9, 9, 255, 0, 0, 0, 255, 0]}, position.tobytes())
    assert (len(tile.position), tile.not_finite) == (2, 1)
    np.testing.assert_allclose(tile.colour, [[1, 0, 0, 1], [0, 1, 0, 1]], atol=1e-6)
