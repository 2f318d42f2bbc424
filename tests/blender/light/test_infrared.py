"""Infrared radiance outside of shaders: the clear sky by elevation."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.scene import infrared, temperature
from firetwin.shot.sections import Thermal
from firetwin.shot.shot import Shot
from firetwin_core import sensor

SINE = np.sin(np.radians([-3.0, 0.0, 2.0, 10.0, 30.0, 90.0]))


def sky_kelvin(shot, height):
    """Return the brightness temperatures of the sky, and of the air at the camera (K)."""
    air = temperature.field(shot, 0.0)
    place = np.array([*(air.corner + 3.0 * air.spacing), height])
    radiance = infrared.clear_sky(shot, air, place, SINE)
    return sensor.brightness_temperature(radiance), air.at(place)


def test_the_sky_is_as_warm_as_the_air_at_the_horizon_and_colder_upwards(shot):
    kelvin, air = sky_kelvin(shot, 300.0)
    assert kelvin[:2] == pytest.approx(air, abs=0.5)
    assert np.all(np.diff(kelvin[1:]) < -1.0)
    assert kelvin[-1] == pytest.approx(infrared.SKY, abs=15.0)


def test_humid_air_makes_the_sky_warmer_and_height_colder(settings, run):
    humid, dry = (
        sky_kelvin(Shot(replace(settings, thermal=Thermal(vapour=vapour)), run), 300.0)[0][2:]
        for vapour in (20.0, 5.0)
    )
    assert np.all(humid > dry)
    high, low = (sky_kelvin(Shot(settings, run), height)[0][2:] for height in (3000.0, 300.0))
    assert np.all(high < low)


@pytest.mark.parametrize("height", [50e3, 500e3])
def test_a_camera_above_the_air_has_the_cold_background(shot, height):
    kelvin, _ = sky_kelvin(shot, height)
    assert kelvin == pytest.approx(infrared._BACKGROUND, abs=0.1)
