"""Gaps up to a width join components; means over squares against SciPy."""

import numpy as np
import pytest
from firetwin.dataset import components
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import ndimage

masks = arrays.arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12)))


@pytest.mark.parametrize(("gap", "count"), [(0, 2), (10, 2), (12, 1), (13, 1)])
def test_a_gap_of_twelve_pixels_joins_two_parts(gap, count):
    mask = np.zeros((20, 60), bool)
    mask[5:9, 3:10] = mask[5:9, 22:40] = True
    found, number = components.group(mask, gap)
    assert number == count
    assert np.array_equal(found > 0, mask)


@given(masks, st.integers(0, 4))
@settings(max_examples=40)
def test_a_mean_equals_that_of_scipy(mask, reach):
    square = np.ones((2 * reach + 1, 2 * reach + 1))
    total = ndimage.convolve(mask.astype(float), square, mode="constant")
    weight = ndimage.convolve(np.ones(mask.shape), square, mode="constant")
    assert components.local_mean(mask, reach) == pytest.approx(total / weight)


def test_the_mean_of_colours_is_that_of_each_channel():
    values = np.random.default_rng(1).random((9, 7, 3))
    found = components.local_mean(values, 1)
    assert found[4, 3] == pytest.approx(values[3:6, 2:5].mean((0, 1)))
    assert found[0, 0] == pytest.approx(values[:2, :2].mean((0, 1)))
