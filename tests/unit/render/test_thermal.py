"""The thermal gradient and the paper's additive blend, against an image computed by hand."""

import numpy as np
import pytest
from firetwin_core.sensor import overlay, thermal_composite


def gradient(kelvin, low, high):
    """The colours alone, on a black picture."""
    return thermal_composite(np.zeros((*np.shape(kelvin), 3)), kelvin, low, high)


def test_gradient_at_and_between_its_stops():
    kelvin = [[300, 400, 500, 600, 700, 800, 350, 750, 0, 2000, np.nan]]
    expected = [
        [0, 0, 0],
        [0.5, 0, 0.5],
        [1, 0, 0],
        [1, 0.5, 0],
        [1, 1, 0],
        [1, 1, 1],
        [0.25, 0, 0.25],
        [1, 1, 0.5],
        [0, 0, 0],
        [1, 1, 1],
        [0, 0, 0],
    ]
    np.testing.assert_allclose(gradient(kelvin, 300, 800), [expected], atol=1e-7)


def test_blend_equals_an_image_computed_by_hand():
    """2 x 2 pixels, 300..800 K, strength 0.5: pixel + 0.5 colour, clamped."""
    rgb = [[[0.2, 0.4, 0.6], [0.8, 0.1, 0.0]], [[0.3, 0.3, 0.3], [1.5, -0.5, np.nan]]]
    kelvin = [[300, 500], [400, 800]]
    by_hand = [[[0.2, 0.4, 0.6], [1.0, 0.1, 0.0]], [[0.55, 0.3, 0.55], [1.0, 0.5, 0.5]]]
    np.testing.assert_allclose(thermal_composite(rgb, kelvin, 300, 800, 0.5), by_hand, atol=1e-7)


def test_strength_is_1_unless_said():
    result = thermal_composite([[[0.25, 0.25, 0.25]]], [[400.0]], 300, 800)
    np.testing.assert_allclose(result, [[[0.75, 0.25, 0.75]]], atol=1e-7)


def test_8_bit_pixels_are_refused():
    with pytest.raises(ValueError, match="divide 8-bit pixels by 255"):
        thermal_composite(np.zeros((1, 1, 3), np.uint8), [[300.0]], 300, 800)


@pytest.mark.parametrize("limits", [(800, 300), (300, 300), (np.nan, 800), (300, np.inf)])
def test_impossible_limits(limits):
    with pytest.raises(ValueError, match="low and high"):
        gradient([[300.0]], *limits)


def test_wrong_shapes():
    with pytest.raises(ValueError, match=r"rgb must have shape \(1, 2, 3\)"):
        thermal_composite(np.zeros((2, 1, 3)), np.zeros((1, 2)), 300, 800)
    with pytest.raises(ValueError, match="kelvin must have shape"):
        gradient([300.0], 300, 800)
    with pytest.raises(ValueError, match="strength"):
        thermal_composite(np.zeros((1, 1, 3)), [[300.0]], 300, 800, np.nan)


def test_overlay_equals_pixels_computed_by_hand():
    below, above = [[[0.2, 0.4, 0.6]] * 4], [[[1.0, 0.0, 0.5]] * 4]
    made = overlay(below, above, [[340.0, 400.0, 900.0, np.nan]], 350.0, 450.0, 0.8)
    by_hand = [[[0.2, 0.4, 0.6], [0.52, 0.24, 0.56], [0.84, 0.08, 0.52], [0.2, 0.4, 0.6]]]
    np.testing.assert_allclose(made, by_hand, atol=1e-7)


@pytest.mark.parametrize(
    ("start", "full", "opacity", "reason"), [(2, 1, 1, "start and full"), (1, 2, 1.5, "opacity")]
)
def test_an_overlay_that_cannot_be(start, full, opacity, reason):
    with pytest.raises(ValueError, match=reason):
        overlay(np.zeros((1, 1, 3)), np.zeros((1, 1, 3)), [[300.0]], start, full, opacity)
