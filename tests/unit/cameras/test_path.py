"""Moving averages and maxima along a camera's path."""

import numpy as np
import pytest
from firetwin.shot.cameras import path
from numpy.lib.stride_tricks import sliding_window_view


@pytest.mark.parametrize("reach", [1, 7, path._FFT_REACH, path._FFT_REACH + 1])
def test_a_mean_by_fft_is_the_sum_under_the_window(reach):
    values = np.random.default_rng(reach).normal(1.0e4, 300.0, 5 * reach + 3)
    window = np.hanning(2 * reach + 3)[1:-1]
    expected = sliding_window_view(values, 2 * reach + 1) @ (window / window.sum())
    np.testing.assert_allclose(path.hann_mean(values, reach), expected, rtol=0, atol=1e-8)
