"""Two groups of members by hand, and samples of one group."""

import numpy as np
import pytest
from firetwin.forecasts.ensemble import groups


def test_values_apart_are_two_groups():
    values = [10.0, 10.5, 11.0, 10.2, 10.7, 10.9, 30.0, 30.5, 29.5, 10.1]
    found = groups.split_values(values)
    assert found.tolist() == [False] * 6 + [True] * 3 + [False]
    assert groups.split_values(values[::-1]).tolist() == [False] + [True] * 3 + [False] * 6


def test_width_by_hand():
    """Values 0, 1 and 10: widths (10 - 1) / 10 and (9 - 1) / 9; a group of one member has 0."""
    values = np.array([0.0, 1.0, 10.0])
    distance = np.abs(values[:, None] - values)
    second = groups._around_medoids(distance)
    assert second[0] == second[1] != second[2]
    assert groups._silhouette(distance, second) == pytest.approx((0.9 + 8.0 / 9.0) / 3.0)


@pytest.mark.parametrize(
    "values",
    [
        range(20),
        [5.0] * 20,
        [1.0] * 9,  # few members
        [*np.linspace(0.0, 1.0, 19), 50.0],  # one outlier
        np.random.default_rng(3).normal(size=20),
    ],
)
def test_one_group_is_not_split(values):
    assert groups.split_values(values) is None
