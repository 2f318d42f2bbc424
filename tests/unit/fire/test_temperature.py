"""The lower end of the thermal palette: the coldest ground or air."""

from datetime import datetime

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.run import sun, times
from firetwin.shot.fire import air_temperature
from firetwin.shot.sections.thermal import BANDS
from firetwin_core import sensor
from hypothesis import given
from hypothesis import strategies as st

NIGHT, DUSK, NOON = (f"2014-09-17T{hour}-07:00" for hour in ("01:00", "18:40", "13:00"))


@pytest.fixture
def run(make_run):
    """A run without temperature."""
    return runs.open(make_run(temperature=None))


def at(run, moment):
    return times.seconds(run, datetime.fromisoformat(moment))


@pytest.mark.parametrize("band", BANDS.values(), ids=BANDS)
def test_by_night_no_level_ground_is_colder(run, band):
    """Ground 70/30 K colder than the air, of any emissivity down to stone's, under a sky of 250 K."""
    time = at(run, NIGHT)
    low, air = air_temperature.coldest_ground(run, time, band), air_temperature.coldest(run, time)
    for emissivity in (0.94, 0.96, 0.985, 1.0):
        radiance = emissivity * sensor.radiance(air - 70.0 / 30.0, band)
        shown = sensor.brightness_temperature(
            radiance + (1.0 - emissivity) * sensor.radiance(250.0, band), band
        )
        assert low <= shown + 1e-6
    assert air - 6.0 < low < air - 2.0


def test_by_day_the_air_is_the_coldest(run):
    time = at(run, NOON)
    assert air_temperature.coldest_ground(run, time, BANDS["lwir"]) == air_temperature.coldest(run, time)


def test_the_suns_height_alone_changes_it_and_smoothly(run):
    """Through an evening the colours move by a fraction of a kelvin a minute, as the ground cools."""
    start = at(run, DUSK) - 3600.0
    minutes = start + 60.0 * np.arange(120)
    below = [
        air_temperature.coldest(run, time) - air_temperature.coldest_ground(run, time, BANDS["lwir"])
        for time in minutes
    ]
    assert below[0] == 0.0
    assert np.all(np.diff(below) > -1e-2)  # the air cools too, and with it the radiation to the sky
    assert np.abs(np.diff(below)).max() < 0.2
    assert below[-1] > 3.0


@given(st.floats(-90.0, 89.0), st.floats(0.0, 1.0))
def test_direct_sunlight_grows_with_height(height, more):
    assert 0.0 <= sun.direct(height) <= sun.direct(height + more) < 1353.0
