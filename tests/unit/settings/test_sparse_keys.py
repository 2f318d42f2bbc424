"""Few keys in place of many, against the values that they stand for."""

import numpy as np
import pytest
from firetwin.shot.cameras import sparse_keys
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import CubicHermiteSpline

NUMBERS = st.floats(-1e4, 1e4, allow_nan=False, width=32)


def test_the_curve_is_the_cubic_of_hermite():
    rng = np.random.default_rng(3)
    kept, values, slopes = np.array([0, 4, 5, 17, 30]), rng.normal(size=(5, 3)), rng.normal(size=(5, 3))
    expected = CubicHermiteSpline(kept, values, slopes)(np.arange(31))
    assert sparse_keys.curve(kept, values, slopes, 31) == pytest.approx(expected, abs=1e-12)


@given(
    arrays(np.float64, st.tuples(st.integers(2, 60), st.integers(1, 4)), elements=NUMBERS), st.floats(0, 100)
)
def test_every_frame_is_within_the_tolerance(values, tolerance):
    kept, slopes = sparse_keys.keys(values, tolerance)
    assert kept[0] == 0
    assert kept[-1] == len(values) - 1
    assert (np.diff(kept) > 0).all()
    off = np.linalg.norm(sparse_keys.curve(kept, values[kept], slopes, len(values)) - values, axis=1)
    assert off.max() <= tolerance + 1e-9


def test_a_smooth_way_needs_few_keys():
    t = np.linspace(0.0, 1.0, 481)[:, None]
    way = 1000.0 * np.concatenate([np.sin(3.0 * t), np.cos(2.0 * t), t**3], axis=1)
    assert len(sparse_keys.keys(way, 0.005)[0]) < 60
    assert len(sparse_keys.keys(way[:, 2:], 0.005)[0]) == 2, "a cubic is one piece"
    assert len(sparse_keys.keys(way[:1], 0.005)[0]) == 1
