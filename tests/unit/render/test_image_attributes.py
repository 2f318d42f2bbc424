"""Attributes and storage of EXR files, read by the OpenEXR library's own Python module."""

from fractions import Fraction

import numpy as np
import pytest
from firetwin_core.sensor import TimeCode, read_channels, read_image, write_image

OpenEXR = pytest.importorskip("OpenEXR")
MATRIX = np.arange(16.0).reshape(4, 4)


def header(path):
    return OpenEXR.File(str(path)).header()


@pytest.mark.parametrize(
    ("name", "value", "kind"),
    [
        ("colorInteropID", "lin_rec709_scene", str),
        ("comments", "planar depth, m", str),
        ("owner", "Someone", str),
        ("capDate", "2014:09:17 23:12:00", str),
        ("imageCounter", 24, int),
        ("utcOffset", 25200.0, float),
        ("pinholeFocalLength", np.float32(35.0), float),
        ("framesPerSecond", Fraction(24000, 1001), Fraction),
        ("sensorOverallDimensions", (36.0, 20.25), np.ndarray),
        ("whiteLuminanceColour", np.array([1.0, 0.5, 0.25]), np.ndarray),
        ("worldToCamera", MATRIX, np.ndarray),
        ("worldToNDC", MATRIX, np.ndarray),
    ],
)
def test_attributes_have_their_standard_name_type_and_value(tmp_path, name, value, kind):
    write_image(tmp_path / "a.exr", np.zeros((2, 3, 3)), {name: value})
    found = header(tmp_path / "a.exr")[name]
    assert isinstance(found, kind)
    np.testing.assert_array_equal(found, value)


@pytest.mark.parametrize(
    ("code", "numbers"),
    [
        (TimeCode(1, 2, 3, 24), (1, 2, 3, 24, 0, 0, 0)),
        (TimeCode(23, 59, 58, 29, drop_frame=True), (23, 59, 58, 29, 1, 0, 0)),
        (TimeCode(1, 0, 0, 7, second_field=True), (1, 0, 0, 7, 0, 0, 1)),
    ],
)
def test_time_codes(tmp_path, code, numbers):
    write_image(tmp_path / "a.exr", np.zeros((2, 3)), {"timeCode": code})
    found = header(tmp_path / "a.exr")["timeCode"]
    assert (found.hours, found.minutes, found.seconds, found.frame) == numbers[:4]
    assert (found.dropFrame, found.colorFrame, found.fieldPhase) == numbers[4:]


@pytest.mark.parametrize("numbers", [(24, 0, 0, 0), (0, 60, 0, 0), (0, 0, 60, 0), (0, 0, 0, 30)])
def test_wrong_time_codes(numbers):
    with pytest.raises(ValueError, match="at most 23 hours"):
        TimeCode(*numbers)


@pytest.mark.parametrize("value", [np.zeros(4), np.zeros((3, 3)), None, [1.0, "two"]])
def test_wrong_attributes(tmp_path, value):
    with pytest.raises(ValueError, match="metadata place"):
        write_image(tmp_path / "a.exr", np.zeros((2, 3)), {"place": value})


def test_half_floats_round_to_the_nearest_and_stay_finite(tmp_path):
    pixels = np.random.default_rng(3).lognormal(0.0, 4.0, (9, 7, 4)).astype(np.float32)
    pixels[0, 0] = 1.0e6, -1.0e6, np.inf, 65519.0
    write_image(tmp_path / "a.exr", pixels, names=["R", "G", "B", "A"], half=True, one_line=True)
    expected = np.clip(pixels, -65504.0, 65504.0)
    expected[0, 0, 2] = np.inf
    np.testing.assert_array_equal(read_image(tmp_path / "a.exr"), expected.astype(np.float16))
    read = OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True)
    assert {channel.pixels.dtype for channel in read.channels().values()} == {np.dtype(np.float16)}
    assert read.header()["compression"] == OpenEXR.ZIPS_COMPRESSION


def test_floats_and_layers_are_exact(tmp_path):
    pixels = np.random.default_rng(3).lognormal(0.0, 4.0, (40, 7, 3)).astype(np.float32)
    names = ["Z", "fire.R", "N.X"]
    write_image(tmp_path / "a.exr", pixels, names=names)
    found = read_channels(tmp_path / "a.exr")
    for k, name in enumerate(names):
        np.testing.assert_array_equal(found[name], pixels[..., k])
    assert header(tmp_path / "a.exr")["compression"] == OpenEXR.ZIP_COMPRESSION


def test_one_name_per_channel(tmp_path):
    with pytest.raises(ValueError, match="names must have one name per channel, 3"):
        write_image(tmp_path / "a.exr", np.zeros((2, 2, 3)), names=["R", "G"])
