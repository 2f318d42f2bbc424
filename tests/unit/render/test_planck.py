"""Band radiance against 30-digit quadrature, known values and closed forms, and its inverse."""

import mpmath
import numpy as np
import pytest
from firetwin_core.sensor import (
    PlanckTable,
    brightness_temperature,
    radiance,
    spectral_radiance,
    spectral_temperature,
)
from hypothesis import given, settings
from hypothesis import strategies as st

BANDS = [(8.0, 14.0), (3.0, 5.0), (0.4, 0.7), (10.35, 12.3), (0.1, 1000.0)]


def exact(kelvin: float, band: tuple[float, float]) -> mpmath.mpf:
    """Planck's law integrated over wavelength, in SI units."""
    with mpmath.workdps(30):
        h, c, k = mpmath.mpf("6.62607015e-34"), mpmath.mpf(299792458), mpmath.mpf("1.380649e-23")

        def spectral(wavelength: mpmath.mpf) -> mpmath.mpf:
            return 2 * h * c**2 / wavelength**5 / mpmath.expm1(h * c / (wavelength * k * kelvin))

        low, high = (mpmath.mpf(limit) * mpmath.mpf("1e-6") for limit in band)
        pieces = [low * (high / low) ** (mpmath.mpf(i) / 8) for i in range(9)]
        return mpmath.quad(spectral, pieces)


@pytest.mark.parametrize("band", BANDS)
@pytest.mark.parametrize("kelvin", [60.0, 250.0, 300.0, 500.0, 1027.5, 1500.0, 6000.0, 40000.0])
def test_against_quadrature(kelvin, band):
    assert radiance(kelvin, band) == pytest.approx(float(exact(kelvin, band)), rel=2e-13)


def test_known_values():
    np.testing.assert_allclose(
        radiance([300, 400, 800, 1000, 1200]), [54.9, 177, 1224, 1924, 2677], rtol=2e-3
    )


@pytest.mark.parametrize(("wavelength", "known"), [(3.9, 0.6025), (11.2, 9.467)])
def test_known_values_at_one_wavelength(wavelength, known):
    found = spectral_radiance(300.0, wavelength)
    assert found == pytest.approx(known, rel=1e-4)
    narrow = (wavelength - 0.001, wavelength + 0.001)
    assert radiance(300.0, narrow) / 0.002 == pytest.approx(found, rel=1e-6)


@given(st.floats(100, 1e5), st.floats(0.4, 20))
def test_the_temperature_of_a_spectral_radiance(kelvin, wavelength):
    value = spectral_radiance(kelvin, wavelength)
    assert spectral_temperature(value, wavelength) == pytest.approx(kelvin, rel=1e-12)


def test_a_hot_part_of_a_pixel_shows_at_short_waves():
    """J. Dozier 1981: 1000 K over 0.37 % of 300 K."""
    part = 0.0037
    shown = [
        spectral_temperature(
            part * spectral_radiance(1000.0, wave) + (1.0 - part) * spectral_radiance(300.0, wave), wave
        )
        for wave in (3.9, 11.2)
    ]
    assert shown == pytest.approx([400.0, 306.5], abs=0.3)  # 0.37 % is rounded


def test_half_a_pixel_of_fire_is_not_the_mean_of_kelvin():
    table = PlanckTable()
    mean = 0.5 * (table.radiance(300.0) + table.radiance(1200.0))
    assert 835.0 < table.brightness_temperature(mean) < 845.0


TABLE_BANDS = [(8.0, 14.0), (3.4, 4.1)]


@pytest.mark.parametrize("band", TABLE_BANDS)
def test_a_table_is_as_good_as_the_integral(band):
    table, kelvin = PlanckTable(band), np.geomspace(100.0, 4000.0, 4001, dtype=np.float32)
    assert table.radiance(kelvin) == pytest.approx(radiance(kelvin, band), rel=7e-8)  # half a step of float32
    for each in (200.0, 300.0, 1000.0, 1500.0):
        assert float(table.radiance(each)) == pytest.approx(float(exact(each, band)), rel=7e-8)


@pytest.mark.parametrize("band", TABLE_BANDS)
def test_a_table_gives_temperatures_back_within_a_millikelvin(band):
    table, kelvin = PlanckTable(band), np.linspace(200.0, 1500.0, 13_001)
    back = table.brightness_temperature(table.radiance(kelvin))
    assert np.abs(back - kelvin).max() < 5e-4
    exactly = brightness_temperature(table.radiance(kelvin), band)
    assert np.abs(back - exactly).max() < 2e-4


def test_tables_with_few_knots_are_worse():
    kelvin = np.linspace(200.0, 1500.0, 2001)
    errors = [
        np.abs(PlanckTable(knots=knots).radiance(kelvin) / radiance(kelvin) - 1.0).max() for knots in (8, 16)
    ]
    assert 1e-7 < errors[1] < 0.2 * errors[0]
    with pytest.raises(ValueError, match="knots"):
        PlanckTable(knots=1)


@pytest.mark.parametrize("kelvin", [300.0, 1200.0])
def test_the_whole_spectrum_is_stefan_boltzmann(kelvin):
    assert radiance(kelvin, (0.01, 1e6)) * np.pi == pytest.approx(5.670374419e-8 * kelvin**4, rel=1e-9)


def test_bands_add_up():
    assert radiance(700.0, (3, 8)) + radiance(700.0, (8, 14)) == pytest.approx(
        radiance(700.0, (3, 14)), rel=1e-14
    )


@settings(deadline=None)
@given(st.floats(80, 1e5), st.sampled_from(BANDS))
def test_the_inverse_gives_the_temperature_back(kelvin, band):
    assert brightness_temperature(radiance(kelvin, band), band) == pytest.approx(kelvin, rel=1e-13)


@settings(deadline=None)
@given(st.floats(1e-300, 1e20), st.sampled_from(BANDS))
def test_the_inverse_of_any_radiance(value, band):
    assert radiance(brightness_temperature(value, band), band) == pytest.approx(value, rel=1e-11)


@pytest.mark.parametrize(
    "function",
    [
        radiance,
        brightness_temperature,
        lambda value: spectral_radiance(value, 3.9),
        lambda value: spectral_temperature(value, 3.9),
        PlanckTable().radiance,
        PlanckTable().brightness_temperature,
    ],
)
def test_what_is_no_temperature_or_radiance(function):
    np.testing.assert_array_equal(function([0.0, -1.0, np.nan, np.inf]), [0, np.nan, np.nan, np.inf])


def test_extremes():
    assert radiance(1e-3) == 0
    assert radiance([[1.0, 2.0]]).shape == (1, 2)
    assert np.isfinite(radiance(1e60))


@pytest.mark.parametrize("band", [(0, 1), (5, 3), (3, 3), (3, np.inf), (np.nan, 3)])
def test_impossible_bands(band):
    with pytest.raises(ValueError, match="band"):
        radiance(300.0, band)
    with pytest.raises(ValueError, match="band"):
        PlanckTable(band)


@pytest.mark.parametrize("wavelength", [0.0, -1.0, np.nan, np.inf])
def test_impossible_wavelengths(wavelength):
    with pytest.raises(ValueError, match="wavelength"):
        spectral_radiance(300.0, wavelength)
