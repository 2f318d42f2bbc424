"""Ragged spread of invented fires: rim, islands, slope, and the undisturbed fire's pace."""

import numpy as np
import pytest
import ragged_spread
import whole_run

WIND, SPEED = (4.0, 3.0), 0.5
METRES = (np.arange(120) - 59.5) * 10.0
X, Y = np.meshgrid(METRES, METRES)


def travel(x, y):
    """Seconds of an elliptical fire."""
    return whole_run._travel(x, y, SPEED, WIND)


def solve(height=None, seed=5):
    """Arrival times on a small grid, s."""
    ground = np.zeros_like(X) if height is None else height
    return ragged_spread.arrival(X, Y, ground, ((0.0, 0.0, 0.0),), travel, WIND, seed)


def outline(burned):
    """Length of the outer rim in cell sides over the square root of the area."""
    sides = sum(np.count_nonzero(np.diff(burned, axis=axis)) for axis in (0, 1))
    return sides / np.sqrt(np.count_nonzero(burned))


@pytest.fixture(scope="module")
def came():
    """Arrival times over flat ground, s."""
    return solve()


def test_rim_is_longer_than_an_ellipse(came):
    for share in (0.1, 0.2, 0.4):
        even = travel(X, Y)
        ragged = outline(came < np.quantile(came, share))
        assert ragged > 1.3 * outline(even < np.quantile(even, share))


def test_fire_reaches_every_cell_from_an_earlier_neighbour(came):
    earliest = np.min(
        [np.roll(came, (i, j), (0, 1)) for i in range(-3, 4) for j in range(-3, 4) if (i, j) != (0, 0)],
        axis=0,
    )
    inner = np.s_[3:-3, 3:-3]
    assert np.count_nonzero((came <= earliest) & np.isfinite(came) & (earliest < np.inf)) == 1
    assert np.isfinite(came[inner]).mean() > 0.9


def test_islands_stay_unburned(came):
    assert 0.5 * ragged_spread.UNBURNED < np.isinf(came).mean() < 1.5 * ragged_spread.UNBURNED


def test_half_of_the_area_burns_in_the_time_of_the_undisturbed_fire(came):
    assert np.median(came) == pytest.approx(np.median(travel(X, Y)))


def test_a_seed_fixes_the_arrival_times(came):
    np.testing.assert_array_equal(came, solve())
    assert not np.array_equal(came, solve(seed=6))


def test_fire_is_faster_uphill():
    height = 0.15 * X
    flat, hill = solve(), solve(height)
    burns = np.isfinite(flat)
    ratio = hill[burns] / flat[burns]
    assert np.nanmedian(ratio[X[burns] > 400.0]) < 0.7 * np.nanmedian(ratio[X[burns] < -400.0])
