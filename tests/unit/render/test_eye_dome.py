"""Eye-dome lighting against a plain reference, and pixels that stay as bright."""

import numpy as np
import pytest
from firetwin_core.sensor import eye_dome


def reference(depth, strength, radius):
    log = np.log2(np.clip(np.nan_to_num(depth, nan=1e9), 1e-3, 1e9))
    padded = np.pad(log, radius, constant_values=np.inf)
    height, width = depth.shape
    total = np.zeros(depth.shape)
    for down in (-radius, 0, radius):
        for across in (-radius, 0, radius):
            there = padded[radius + down : radius + down + height, radius + across : radius + across + width]
            total += np.maximum(0.0, log - there)
    return np.exp(-strength * total / 8.0)


@pytest.mark.parametrize("radius", [1, 3, 40, 2**40])
def test_against_a_reference(radius):
    depth = np.random.default_rng(3).uniform(100.0, 5000.0, (23, 31)).astype(np.float32)
    depth[2, 3], depth[5] = np.nan, 1e10
    expected = reference(depth, 2.0, min(radius, 40))  # nothing is so far away
    np.testing.assert_allclose(eye_dome(depth, 2.0, radius), expected, rtol=2e-5)


def test_even_ground_and_what_stands_before_others_is_not_darkened():
    assert np.all(eye_dome(np.full((9, 9), 700.0)) == 1.0)
    depth = np.full((9, 9), 1000.0)
    depth[4, 4] = 500.0
    shade = eye_dome(depth, 1.0)
    assert shade[4, 4] == 1.0
    assert shade[4, 5] == pytest.approx(np.exp(-1.0 / 8.0), rel=1e-6)
    assert shade[4, 6] == 1.0


def test_only_ratios_of_depth_count():
    depth = np.random.default_rng(4).uniform(1.0, 50.0, (12, 12))
    np.testing.assert_allclose(eye_dome(depth), eye_dome(100.0 * depth), rtol=1e-4)


@pytest.mark.parametrize("wrong", [{"strength": -1.0}, {"strength": np.nan}, {"radius": 0}])
def test_impossible_parameters(wrong):
    with pytest.raises(ValueError, match="strength"):
        eye_dome(np.ones((2, 2)), **wrong)
