"""Distance levels at their exact limits, and the nearest positions under a budget."""

import numpy as np
import pytest
from firetwin_core import lod
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays


@pytest.mark.parametrize(
    ("distance", "level", "multiplier"),
    [
        (0.0, 0, 1.0),
        (1500.0, 0, 1.0),
        (np.nextafter(1500.0, np.inf), 1, 0.7),
        (np.nextafter(3500.0, 0), 1, 0.7),
        (3500.0, 1, 0.7),
        (np.nextafter(3500.0, np.inf), 2, 0.4),
        (1e7, 2, 0.4),
        (np.inf, 2, 0.4),
        (np.nan, 2, 0.4),
    ],
)
def test_levels_of_the_paper(distance, level, multiplier):
    assert lod.levels([distance]).tolist() == [level]
    assert lod.LevelTable().levels([distance]).tolist() == [level]
    assert lod.LevelTable().multiplier([distance]).tolist() == [multiplier]


def test_shape_stays():
    assert lod.levels(np.zeros((3, 4))).shape == (3, 4)
    assert lod.levels(2000.0).shape == ()


def test_other_tables():
    table = lod.LevelTable((10.0,), (1.0, 0.0))
    assert (table.thresholds, table.multipliers) == ([10.0], [1.0, 0.0])
    assert table.levels([10, 11]).tolist() == [0, 1]


@pytest.mark.parametrize(
    ("thresholds", "multipliers", "message"),
    [
        ((2, 1), (1, 1, 1), "ascend"),
        ((1, 1), (1, 1, 1), "ascend"),
        ((1, np.nan), (1, 1, 1), "finite"),
        ((1,), (1, np.inf), "finite"),
        ((1, 2), (1, 1), "one more"),
    ],
)
def test_impossible_tables(thresholds, multipliers, message):
    with pytest.raises(ValueError, match=message):
        lod.LevelTable(thresholds, multipliers)


@settings(deadline=None)
@given(st.lists(st.floats(0, 1e7), min_size=2))
def test_levels_never_fall_with_distance(distances):
    assert (np.diff(lod.levels(sorted(distances)).astype(int)) >= 0).all()


@settings(deadline=None)
@given(
    arrays(float, st.tuples(st.integers(0, 40), st.just(3)), elements=st.integers(-5, 5).map(float)),
    arrays(float, st.tuples(st.integers(0, 4), st.just(3)), elements=st.integers(-5, 5).map(float)),
    st.integers(0, 50),
)
def test_nearest_first_with_ties_by_index(position, camera, budget):
    square = ((position[:, None] - camera[None]) ** 2).sum(-1).min(axis=1, initial=np.inf)
    expected = np.lexsort((np.arange(len(position)), square))[:budget]
    np.testing.assert_array_equal(lod.select_nearest(position, camera, budget), expected)


def test_what_is_not_a_number_comes_last():
    position = [[np.nan, 0, 0], [5, 0, 0], [1, 0, 0]]
    assert lod.select_nearest(position, [[0, 0, 0]], 3).tolist() == [2, 1, 0]
    assert lod.select_nearest(position, [[np.nan, 0, 0], [4, 0, 0]], 2).tolist() == [1, 2]
    assert lod.select_nearest(position, [[np.nan, 0, 0]], 2).tolist() == [0, 1]


def test_wrong_arguments():
    with pytest.raises(ValueError, match="budget"):
        lod.select_nearest(np.zeros((1, 3)), np.zeros((1, 3)), -1)
    with pytest.raises(ValueError, match="camera must have shape"):
        lod.select_nearest(np.zeros((1, 3)), np.zeros(3), 1)
