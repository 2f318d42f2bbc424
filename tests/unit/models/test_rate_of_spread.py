"""Rate of spread from arrival times, and the heat that follows from it, against known speeds and fuels."""

import numpy as np
import pytest
import upwind_front
from firetwin.run.models import heat_from_intensity, rate_of_spread
from firetwin_core import constants

CELL, CELLS, SPEED = 30.0, 64, 0.3


def fire(uneven: float, seed: int = 1, spots: int = 0):
    """Arrival (NaN: unburned) and speed (m/s) of a fire whose speed varies from cell to cell."""
    chance = np.random.default_rng(seed)
    speed = SPEED * np.exp(uneven * chance.standard_normal((CELLS, CELLS)))
    came = upwind_front.arrival(1.0 / speed, CELL, spots, seed)
    return np.where(came <= np.quantile(came, 0.6), came, np.nan), speed


def noisy(came, crossings, seed=2):
    """Arrival with errors, in times that the front takes to cross a cell."""
    return came + crossings * CELL / SPEED * np.random.default_rng(seed).standard_normal(came.shape)


def test_the_speed_of_a_level_set_is_exact():
    came, speed = fire(0.7)
    found = rate_of_spread.of_arrival(came, (CELL, CELL))
    inner = np.isfinite(came) & np.isfinite(found)
    assert np.mean(np.abs(found / speed - 1.0)[inner] < 1e-9) > 0.95


def test_a_front_that_stands_or_meets_another_has_a_speed():
    x = np.arange(20) * 30.0
    arrival = np.minimum(x, 600.0 - x) / 0.5  # two fronts that meet
    arrival[5:] += np.where(x[5:] < 330.0, 4000.0, 0.0)  # one of which stood for long
    found = rate_of_spread.of_arrival(np.tile(arrival, (4, 1)), (30.0, 30.0))
    np.testing.assert_allclose(found[:, 1:-1], 0.5)


def test_smoothing_keeps_a_straight_front():
    x, y = np.meshgrid(np.arange(9.0), np.arange(7.0))
    plane = np.where(x + y < 11, 3.0 * x + 4.0 * y, np.nan)
    np.testing.assert_allclose(rate_of_spread.smoothed(plane), plane)


@pytest.mark.parametrize("heavy", [0.8, 4.0])
@pytest.mark.parametrize(
    ("uneven", "time_noise"), [(0.0, 0.0), (0.25, 0.0), (0.7, 0.0), (0.1, 0.1), (0.1, 0.3), (0.1, 1.0)]
)
def test_heat_by_intensity_is_the_heat_of_the_fuel(heavy, uneven, time_noise):
    came, speed = fire(uneven)
    row, column = np.indices(came.shape) // 10
    fuel = np.where((row + column) % 2, 0.8, heavy) * constants.HEAT_OF_COMBUSTION
    burned = np.isfinite(came)
    found = heat_from_intensity.of_intensity(noisy(came, time_noise), fuel * speed, None, (CELL, CELL))
    assert found[burned].sum() == pytest.approx(fuel[burned].sum(), rel=0.02)


@pytest.mark.parametrize(
    ("time_noise", "spots", "each", "all_fires"),
    [(0.1, 7, 0.01, 0.01), (0.3, 7, 0.03, 0.01), (1.0, 7, 0.03, 0.01), (1.0, 20, 0.05, 0.02)],
)
def test_heat_by_intensity_of_spot_fires_that_merge(time_noise, spots, each, all_fires):
    """Heat is H times the sum of fuel, of a fire and of all of them, relative."""
    heat = np.zeros(2)
    for seed in range(1, 9):
        came, speed = fire(0.1, seed, spots)
        row, column = np.indices(came.shape) // 10
        fuel = np.where((row + column) % 2, 0.8, 4.0) * constants.HEAT_OF_COMBUSTION
        burned, arrival = np.isfinite(came), noisy(came, time_noise, seed + 9)
        found = heat_from_intensity.of_intensity(arrival, fuel * speed, None, (CELL, CELL))
        assert found[burned].sum() == pytest.approx(fuel[burned].sum(), rel=each)
        heat += found[burned].sum(), fuel[burned].sum()
    assert heat[0] == pytest.approx(heat[1], rel=all_fires)


@pytest.mark.parametrize("seed", range(1, 9))
def test_rounded_times_release_the_heat_of_their_fuel(seed):
    """A front crosses a cell in 100 s, and its times are rounded to minutes."""
    came, speed = fire(0.1, seed, spots=7)
    fuel = np.full(came.shape, 2.5 * constants.HEAT_OF_COMBUSTION)
    found = heat_from_intensity.of_intensity(60.0 * np.round(came / 60.0), fuel * speed, None, (CELL, CELL))
    burned = np.isfinite(came)
    assert found[burned].sum() == pytest.approx(fuel[burned].sum(), rel=0.03)


@pytest.mark.parametrize("share", [0.02, 0.05])
def test_late_cells_release_the_heat_of_their_fuel(share):
    """They released 20 % more than all fuel."""
    came, speed = fire(0.1)
    late = np.random.default_rng(3).random(came.shape) < share
    fuel = np.full(came.shape, 2.5 * constants.HEAT_OF_COMBUSTION)
    arrival = came + np.where(late, 5000.0, 0.0)
    found = heat_from_intensity.of_intensity(arrival, fuel * speed, None, (CELL, CELL))
    burned = np.isfinite(came)
    assert found[burned].sum() == pytest.approx(fuel[burned].sum(), rel=0.02)
    assert found.max() < 3.0 * fuel.max()
