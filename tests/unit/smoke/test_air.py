"""The air that smoke rises into: stable, clear, and as warm aloft by night as by day; moments of a shot."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.shot import frames
from firetwin.shot.sections import Time
from firetwin.smoke import atmosphere


@pytest.mark.parametrize("sun", [-40.0, -4.0, 0.0, 50.0])
@pytest.mark.parametrize("ground", [0.0, 1200.0, 2800.0])
def test_the_sky_is_clear_and_the_air_stable(sun, ground):
    around = atmosphere.air(sun, ground)
    pressure = atmosphere._pressure(ground + around.height)
    humidity = around.water / atmosphere._saturation(around.potential_temperature, pressure)
    assert humidity.min() > 0.0
    assert humidity.max() <= 0.8 + 1e-9
    assert np.all(np.diff(around.potential_temperature) > 0.0)


def test_nights_are_cold_below_and_no_warmer_aloft():
    day, night = atmosphere.air(50.0, 1200.0), atmosphere.air(-40.0, 1200.0)
    assert night.potential_temperature[0] < day.potential_temperature[0] - 5.0
    high = day.height >= 3300.0
    assert night.potential_temperature[high] == pytest.approx(day.potential_temperature[high])


def test_air_holds_the_water_that_tables_say():
    """Saturation mixing ratios at 1000 hPa in g/kg are from the Smithsonian Meteorological Tables."""
    celsius = np.array([0.0, 20.0, 30.0])
    held = atmosphere._saturation(celsius + 273.15, np.full(3, 1e5))
    mixing = held / (1.0 - held)
    assert mixing == pytest.approx(np.array([3.84, 14.95, 27.69]) * 1e-3, rel=0.01)


def test_a_still_has_one_moment(make_run):
    run = runs.open(make_run())
    start = datetime(2014, 9, 17, 4, 46, tzinfo=UTC)
    still = frames.resolve(Time(start=start, frames=1), run)
    assert (still.first, still.last) == (60.0, 60.0)
    film = frames.resolve(Time(start=start, frames=2), run)
    assert (film.first, film.last) == (60.0, 120.0)
