"""Dilation, distances and connected components against SciPy."""

import numpy as np
import pytest
from firetwin.geometry.grids import dilate, label, within
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import ndimage

masks = arrays.arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12)))


@pytest.mark.parametrize("reach", [0, 1, 2, 5])
@pytest.mark.parametrize("shape", [(1, 1), (3, 8), (21, 17), (5, 9, 7)])
def test_a_field_has_the_largest_value_around(shape, reach):
    field = np.random.default_rng(3).normal(size=shape)
    expected = ndimage.maximum_filter(field, 2 * reach + 1, mode="nearest")
    assert np.array_equal(dilate(field, reach), expected)


@pytest.mark.parametrize("beyond", [True, False])
@pytest.mark.parametrize("reach", [1, 2, 3])
def test_a_mask_grows_by_steps_of_eight_neighbours(reach, beyond):
    mask = np.random.default_rng(4).random((19, 23)) < 0.04
    square = np.ones((3, 3), bool)
    expected = ndimage.binary_dilation(mask, square, iterations=reach, border_value=beyond)
    assert np.array_equal(dilate(mask, reach, beyond), expected)


@given(masks, st.floats(0.5, 20.0), st.sampled_from([(1.0, 1.0), (0.7, 1.3), (3.0, 2.0)]))
@settings(max_examples=80)
def test_distances_to_a_mask_are_euclidean(mask, reach, cell):
    away = np.full(mask.shape, np.inf)
    if mask.any():
        away = ndimage.distance_transform_edt(~mask, sampling=cell[::-1])
    near = within(mask, reach, cell)
    clear = np.abs(away - reach) > 1e-9
    assert np.array_equal(near[clear], (away <= reach)[clear])


@given(masks)
@settings(max_examples=80)
def test_components_equal_those_of_scipy(mask):
    labels, count = label(mask)
    expected, number = ndimage.label(mask, np.ones((3, 3)))
    assert count == number
    assert np.array_equal(labels > 0, mask)
    pairs = {(a, b) for a, b in zip(labels[mask], expected[mask], strict=True)}
    assert len(pairs) == number
    firsts = [np.flatnonzero(labels.ravel() == k)[0] for k in range(1, count + 1)]
    assert firsts == sorted(firsts)


def test_a_large_noise_equals_scipy_and_a_spiral_is_one():
    mask = np.random.default_rng(0).random((240, 320)) < 0.4
    assert label(mask)[1] == ndimage.label(mask, np.ones((3, 3)))[1]
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
    assert label(spiral)[1] == 1
    assert label(spiral)[1] == ndimage.label(spiral, np.ones((3, 3)))[1]
