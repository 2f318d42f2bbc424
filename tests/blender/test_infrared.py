"""Infrared radiance in shaders: temperatures of the run, sun, pixels of two temperatures, air."""

from firetwin.scene import temperature


def test_nights_have_no_sun():
    assert temperature.sunlight(-5.0) == 0.0
    assert 850.0 < temperature.sunlight(60.0) < 950.0  # W/m2 on a clear day
    assert temperature.sunlight(5.0) < 0.4 * temperature.sunlight(60.0)
