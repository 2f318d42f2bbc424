"""Dilation against SciPy's filters."""

import numpy as np
import pytest
from firetwin.shot.terrain.dilation import dilate

ndimage = pytest.importorskip("scipy.ndimage")


@pytest.mark.parametrize("reach", [0, 1, 2, 5])
@pytest.mark.parametrize("shape", [(1, 1), (3, 8), (21, 17)])
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
