"""Finer smoke directly in front of a camera: around its eye, and nothing twice."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.smoke import close_up
from hypothesis import given
from hypothesis import strategies as st

VOXEL = 20.0
PLACES = st.floats(-3000.0, 3000.0)


def shot(distance=200.0, place=(500.0, -300.0, 80.0), **smoke):
    """One that films frame 1 from a place, looking along x."""
    turn = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    path = SimpleNamespace(position=np.array([place]), rotation=turn[None])
    other = SimpleNamespace(position=np.array([place]) + 1000.0, rotation=turn[None])
    settings = SimpleNamespace(smoke=SimpleNamespace(**({"voxel_size": 0.0} | smoke)))
    return SimpleNamespace(
        perspective_paths=[other, path],
        settings=settings,
        nearest_fire=[distance + 1000.0, distance],
        filmed=lambda path: np.array([0]),
    )


def test_it_is_round_the_eye_nearest_to_fire_and_more_of_it_before_it():
    found = close_up.window(shot(), 1, VOXEL)
    assert found.voxel == pytest.approx(VOXEL / close_up.FINER)
    low, high = np.array(found.low), np.array(found.high)
    assert np.all((low < [500.0, -300.0]) & (high > [500.0, -300.0]))
    assert high[0] - 500.0 > 2.0 * (500.0 - low[0])
    assert high[1] + 300.0 == pytest.approx(-300.0 - low[1])


@pytest.mark.parametrize(
    ("shot", "frame"), [(shot(distance=2000.0), 1), (shot(voxel_size=30.0), 1), (shot(), 2)]
)
def test_far_fires_told_voxels_and_frames_that_are_not_filmed_need_none(shot, frame):
    assert close_up.window(shot, frame, VOXEL) is None


@given(PLACES, PLACES)
def test_its_share_is_whole_in_the_middle_and_none_outside(x, y):
    window = close_up.window(shot(), 1, VOXEL)
    share = float(window.share(np.float64(x), np.float64(y)))
    inside = all(a <= at <= b for a, at, b in zip(window.low, (x, y), window.high, strict=True))
    assert 0.0 <= share <= 1.0
    assert (share > 0.0) <= inside
    middle = 0.5 * (np.array(window.low) + np.array(window.high))
    assert float(window.share(*middle)) == 1.0
