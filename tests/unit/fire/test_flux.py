"""Emitters against the plain transcription of Algorithm 1."""

import algorithms
import geodesy
import numpy as np
import pytest
from firetwin_core.flux import emitters
from firetwin_core.geo import LocalFrame
from hypothesis import given, settings
from hypothesis import strategies as st


def burning_minute():
    """One minute of 144 x 144 cells: a ring of fire with a few bad cells."""
    rng = np.random.default_rng(9)
    latitude = 38.7 + 0.00333 * np.arange(144)
    longitude = -120.8 + 0.00427 * np.arange(144)
    elevation = rng.uniform(600, 2800, (144, 144)).astype(np.float32)
    y, x = np.mgrid[:144, :144]
    ring = np.abs(np.hypot(y - 70, x - 60) - 40) < 6
    flux = np.where(ring, rng.lognormal(9, 1, (144, 144)), 0).astype(np.float32)
    flux[0, :3] = [-5.0, 1e-40, 3e38]
    return latitude, longitude, elevation, flux


def test_one_minute_equals_the_transcription():
    latitude, longitude, elevation, flux = burning_minute()
    low, high = 0.0, 60_000.0
    origin = (38.94, -120.5, 0.0)
    position = LocalFrame(*origin).forward_grid(latitude, longitude, elevation)
    result = emitters(flux, position, low, high)
    expected = algorithms.algorithm1(flux, low, high)
    cell, curved, scale, colour = (np.array(column) for column in zip(*expected, strict=True))
    assert len(result) == len(expected) > 1000
    np.testing.assert_array_equal(result.cell, cell)
    np.testing.assert_allclose(result.intensity, curved, rtol=4e-16, atol=0)
    np.testing.assert_allclose(result.scale, scale, rtol=4e-16)
    np.testing.assert_allclose(result.colour, colour, rtol=4e-16)
    np.testing.assert_array_equal(result.flux, flux.ravel()[cell])
    y, x = np.divmod(cell, 144)
    independent = geodesy.enu(latitude[y], longitude[x], elevation[y, x], origin)
    np.testing.assert_allclose(result.position, independent, rtol=0, atol=2e-8)
    assert result.invalid == 0


def of_values(values, low, high):
    flux = np.array([values], np.float32)
    return emitters(flux, np.zeros((*flux.shape, 3)), low, high)


def test_limits_of_the_mapping():
    result = of_values([100, 200, 400, 500, 50], 100, 500)
    np.testing.assert_allclose(result.intensity, [0, 0.125, 0.75**1.5, 1, 0])
    assert result.scale.tolist()[::3] == [100, 150]
    assert result.colour.tolist()[::3] == [100, 500]


def test_what_is_not_a_number():
    result = of_values([np.nan, np.inf, -np.inf, -0.0, 0.0, 1e-45, 7], 0, 10)
    assert result.invalid == 1
    assert result.cell.tolist() == [1, 5, 6]
    assert result.intensity[0] == 1


def test_a_run_with_one_flux_value():
    assert of_values([5, 4, 6], 5, 5).intensity.tolist() == [1, 0, 1]
    assert of_values([3e38, 1], -3.4e38, 3.4e38).intensity[0] == pytest.approx((6.4 / 6.8) ** 1.5)


@pytest.mark.parametrize("limits", [(2, 1), (np.nan, 1), (0, np.inf)])
def test_impossible_range(limits):
    with pytest.raises(ValueError, match="flux_min"):
        of_values([1], *limits)


def test_wrong_shapes():
    with pytest.raises(ValueError, match="flux must have shape"):
        emitters([1.0], np.zeros((1, 3)), 0, 1)
    with pytest.raises(ValueError, match=r"position must have shape \(1, 2, 3\)"):
        emitters([[1.0, 2.0]], np.zeros((2, 1, 3)), 0, 1)


@settings(deadline=None)
@given(st.lists(st.floats(0, 1e6, width=32), min_size=2, max_size=20))
def test_intensity_is_monotone_and_within_0_and_1(values):
    result = of_values(sorted(values), 10, 1e5)
    assert (np.diff(result.intensity) >= 0).all()
    assert ((result.intensity >= 0) & (result.intensity <= 1)).all()


@settings(deadline=None)
@given(st.permutations(range(12)))
def test_the_order_of_cells_changes_nothing_else(order):
    flux = np.arange(12, dtype=np.float32)
    a, b = of_values(flux, 0, 11), of_values(flux[list(order)], 0, 11)
    assert sorted(a.intensity) == sorted(b.intensity)
