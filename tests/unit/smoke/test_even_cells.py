"""Averages of the apron's fields over squares."""

import numpy as np
import pytest
from firetwin.run import areas
from firetwin.shot.terrain import even_cells
from firetwin.shot.terrain.apron import TerrainFields


@pytest.fixture
def fields():
    """A grid of 8 x 8 cells of 100 m with an apron of 10 rows and columns up to 5 km away."""
    steps = 100.0 * np.cumsum(1.35 ** np.arange(1, 11))
    metres = np.concatenate([-steps[::-1], 100.0 * np.arange(8), 700.0 + steps])
    latitude, longitude = (metres / size for size in areas.metres_per_degree(0.0))
    none = np.zeros((28, 28))
    return TerrainFields(latitude, longitude, none, none, none, 10)


def test_a_streak_of_the_apron_becomes_as_wide_as_it_is_long(fields):
    values = np.zeros((28, 28))
    values[:3, 14] = 1.0
    found = even_cells.average(values, fields)
    assert found[0].max() < 0.25
    assert (found[0] > 0.0).sum() > 8
    assert found[14].max() == 0.0


def test_the_grid_of_the_run_and_even_values_are_unchanged(fields):
    values = np.random.default_rng(1).uniform(size=(28, 28))
    inside = slice(10, -10)
    assert np.array_equal(even_cells.average(values, fields)[inside, inside], values[inside, inside])
    assert even_cells.average(np.full((28, 28), 0.7), fields) == pytest.approx(0.7)
