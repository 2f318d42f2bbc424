"""Band radiance against 30-digit quadrature, known values and closed forms, and its inverse."""

import mpmath
import numpy as np
import pytest
from firetwin_core.sensor import brightness_temperature, radiance
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
    for wavelength, spectral in ((3.9, 0.6025), (11.2, 9.467)):
        narrow = (wavelength - 0.001, wavelength + 0.001)
        assert radiance(300.0, narrow) / 0.002 == pytest.approx(spectral, rel=1e-4)


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


@pytest.mark.parametrize("function", [radiance, brightness_temperature])
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
