"""Connected components against SciPy and by hand; gaps up to a width join them."""

import numpy as np
import pytest
from firetwin.dataset import components
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import ndimage

masks = arrays.arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12)))


@given(masks)
@settings(max_examples=80)
def test_components_equal_those_of_scipy(mask):
    found, count = components.label(mask)
    expected, number = ndimage.label(mask, np.ones((3, 3)))
    assert count == number
    assert np.array_equal(found > 0, mask)
    pairs = {(a, b) for a, b in zip(found[mask], expected[mask], strict=True)}
    assert len(pairs) == number
    firsts = [np.flatnonzero(found.ravel() == k)[0] for k in range(1, count + 1)]
    assert firsts == sorted(firsts)


def test_a_large_noise_equals_scipy_and_a_spiral_is_one():
    mask = np.random.default_rng(0).random((240, 320)) < 0.4
    assert components.label(mask)[1] == ndimage.label(mask, np.ones((3, 3)))[1]
    spiral = np.zeros((101, 101), bool)
    row, column, step, way = 50, 50, 2, 0
    while 0 < row < 100 and 0 < column < 100:
        for _ in range(2):
            down, right = ((0, 1), (1, 0), (0, -1), (-1, 0))[way]
            for _ in range(step):
                spiral[np.clip(row, 0, 100), np.clip(column, 0, 100)] = True
                row, column = row + down, column + right
            way = (way + 1) % 4
        step += 2
    assert components.label(spiral)[1] == 1
    assert components.label(spiral)[1] == ndimage.label(spiral, np.ones((3, 3)))[1]


@pytest.mark.parametrize(("gap", "count"), [(0, 2), (10, 2), (12, 1), (13, 1)])
def test_a_gap_of_twelve_pixels_joins_two_parts(gap, count):
    mask = np.zeros((20, 60), bool)
    mask[5:9, 3:10] = mask[5:9, 22:40] = True
    found, number = components.group(mask, gap)
    assert number == count
    assert np.array_equal(found > 0, mask)


@given(masks, st.integers(0, 4))
@settings(max_examples=40)
def test_dilation_and_mean_equal_those_of_scipy(mask, reach):
    square = np.ones((2 * reach + 1, 2 * reach + 1))
    assert np.array_equal(components.dilate(mask, reach), ndimage.binary_dilation(mask, square))
    total = ndimage.convolve(mask.astype(float), square, mode="constant")
    weight = ndimage.convolve(np.ones(mask.shape), square, mode="constant")
    assert components.local_mean(mask, reach) == pytest.approx(total / weight)


def test_the_mean_of_colours_is_that_of_each_channel():
    values = np.random.default_rng(1).random((9, 7, 3))
    found = components.local_mean(values, 1)
    assert found[4, 3] == pytest.approx(values[3:6, 2:5].mean((0, 1)))
    assert found[0, 0] == pytest.approx(values[:2, :2].mean((0, 1)))
