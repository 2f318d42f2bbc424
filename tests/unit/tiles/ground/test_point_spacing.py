"""Spacing of points against clouds whose spacing is known."""

import numpy as np
import pytest
from firetwin.tiles import point_spacing


def grid(step, side=60):
    x, y = np.meshgrid(np.arange(side) * step, np.arange(side) * step)
    return np.column_stack([x.ravel(), y.ravel(), 0.3 * x.ravel() + 0.2 * y.ravel()]).astype(np.float32)


@pytest.mark.parametrize("step", [0.05, 1.0, 20.0])
def test_a_grid_has_its_spacing(step):
    slope = np.sqrt(1.0 + 0.3**2 + 0.2**2) ** 0.5  # its points stand for so much more area
    assert point_spacing.estimate(grid(step)) == pytest.approx(step * slope, rel=0.3)


def test_random_points_have_that_of_their_density():
    points = np.random.default_rng(1).uniform(0, 100, (20_000, 3)).astype(np.float32)
    points[:, 2] = 0.0
    assert point_spacing.estimate(points) == pytest.approx(np.sqrt(100**2 / 20_000), rel=0.15)


def test_few_points():
    assert point_spacing.estimate(np.zeros((0, 3), np.float32)) == 0.0
    assert point_spacing.estimate(np.ones((1, 3), np.float32)) == 0.0
    assert point_spacing.estimate(np.ones((9, 3), np.float32)) == 0.0
    assert 0.5 < point_spacing.estimate(np.array([[0, 0, 0], [1, 0, 0]], np.float32)) <= 2.0
