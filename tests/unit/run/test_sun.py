"""The moon over a run: full and new at the dates that almanacs have, dark below the horizon."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.run import sun, times

FULL, NEW = datetime(2014, 9, 9, 8, tzinfo=UTC), datetime(2014, 9, 24, 20, tzinfo=UTC)
"""Hours after full moon (9 September, 1:38) and new moon (24 September, 6:14), with it up in California."""


@pytest.fixture
def run(make_run):
    return runs.open(make_run())


def moon(run, moment):
    return sun.moon(run, times.seconds(run, moment))


def test_a_full_moon_is_bright_and_a_new_one_is_not(run):
    assert moon(run, FULL).light > 0.4
    assert 0.0 < moon(run, NEW).light < 0.01


def test_light_comes_from_the_moon_when_the_sun_is_down(run):
    full = moon(run, FULL)
    towards = sun.shadow_direction(300.0, -30.0, full)
    assert np.allclose(towards, sun.direction(full.bearing, full.height))
    assert not np.allclose(sun.shadow_direction(300.0, 5.0, full), towards)


def test_a_moon_below_the_horizon_gives_no_light(run):
    hours = [moon(run, datetime(2014, 9, 9, hour, tzinfo=UTC)) for hour in range(24)]
    assert {each.light > 0.0 for each in hours} == {True, False}
    assert all(each == sun.NO_MOON for each in hours if each.light == 0.0)


def test_air_mass_is_kasten_and_youngs():
    assert sun.air_mass(90.0) == pytest.approx(1.0, abs=1e-3)
    assert sun.air_mass(30.0) == pytest.approx(1.994, abs=2e-3)
    assert sun.air_mass(0.0) == pytest.approx(38.0, abs=0.3)


def test_nights_have_no_sun():
    assert sun.direct(-5.0) == 0.0
    assert 850.0 < sun.direct(60.0) < 950.0  # W/m2 on a clear day
    assert sun.direct(5.0) < 0.4 * sun.direct(60.0)


@pytest.mark.parametrize(
    ("moment", "latitude", "longitude", "bearing", "height", "elongation"),
    [
        (datetime(2014, 9, 17, 10, 30, tzinfo=UTC), 38.88, -120.6, 89.596, 28.076, 74.149),
        (datetime(2014, 9, 9, 8, tzinfo=UTC), 38.88, -120.6, 176.299, 48.899, 176.003),
        (datetime(2020, 1, 5, 11, tzinfo=UTC), -34.0, 150.0, 332.088, 40.690, 114.861),
    ],
)
def test_the_moon_is_where_an_ephemeris_has_it(moment, latitude, longitude, bearing, height, elongation):
    # PyEphem 4.2.1, topocentric, without refraction
    assert sun.moon_angles(latitude, longitude, moment) == pytest.approx((bearing, height), abs=0.15)
    assert sun.elongation(latitude, longitude, moment) == pytest.approx(elongation, abs=0.2)
