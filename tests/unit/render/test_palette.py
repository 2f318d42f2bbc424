"""Palettes of temperatures: their ends, their order, and matplotlib's inferno."""

import matplotlib
import numpy as np
import pytest
from firetwin_core.sensor import colour, palette, palettes

RAMP = np.linspace(300.0, 800.0, 511)[None]


def test_palettes_are_these():
    assert palettes() == ["white-hot", "black-hot", "ironbow", "inferno", "paper"]


@pytest.mark.parametrize("name", palettes())
def test_stops_are_the_colours_at_equal_steps(name):
    stops = palette(name)
    np.testing.assert_allclose(
        colour(np.linspace(300, 800, len(stops))[None], 300, 800, name)[0], stops, atol=1e-6
    )
    halfway = colour([[300.0 + 250.0 / (len(stops) - 1)]], 300, 800, name)[0, 0]
    np.testing.assert_allclose(halfway, 0.5 * (stops[0] + stops[1]), atol=1e-6)


def test_a_palette_that_is_not_there_is_named():
    with pytest.raises(ValueError, match="sepia"):
        palette("sepia")


def test_white_hot_and_black_hot_are_grey_and_opposite():
    white, black = (colour(RAMP, 300, 800, name) for name in ("white-hot", "black-hot"))
    np.testing.assert_allclose(white[0], np.repeat(np.linspace(0, 1, 511)[:, None], 3, 1), atol=1e-6)
    np.testing.assert_allclose(white, 1.0 - black, atol=1e-6)


def test_inferno_is_close_to_that_of_matplotlib():
    expected = matplotlib.colormaps["inferno"](np.linspace(0, 1, 511))[:, :3]
    assert np.abs(colour(RAMP, 300, 800, "inferno")[0] - expected).max() < 0.03


@pytest.mark.parametrize("name", ["white-hot", "ironbow", "inferno", "paper"])
def test_hotter_is_never_darker(name):
    light = colour(RAMP, 300, 800, name)[0] @ [0.2126, 0.7152, 0.0722]
    assert np.diff(light).min() > -0.002
    assert light[-1] > light[0] + 0.7


def test_beyond_the_ends_and_nan():
    found = colour([[0.0, 2000.0, np.nan, 300.0, 800.0]], 300, 800, "ironbow")[0]
    assert np.array_equal(found[0], found[3])
    assert np.array_equal(found[1], found[4])
    assert np.array_equal(found[2], found[3])


def test_a_knee_spreads_the_cold_end():
    shown = colour([[300.0, 310.0, 330.0, 800.0]], 300, 800, knee=10.0)[0, :, 0]
    np.testing.assert_allclose(shown, np.log([1.0, 2.0, 4.0, 51.0]) / np.log(51.0), atol=1e-6)


@pytest.mark.parametrize("wrong", [(800, 300), (np.nan, 800), (300, 300)])
def test_impossible_ends(wrong):
    with pytest.raises(ValueError, match="low and high"):
        colour(RAMP, *wrong)
    with pytest.raises(ValueError, match="palette"):
        colour(RAMP, 300, 800, "blue")
    with pytest.raises(ValueError, match="knee"):
        colour(RAMP, 300, 800, knee=-1.0)
