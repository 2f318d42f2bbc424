"""Emitters against the plain transcription of Algorithm 1, and fluxes between model times."""

import algorithms
import geodesy
import numpy as np
import pytest
from firetwin_core import run as runs
from firetwin_core.flux import at_time, emitters
from firetwin_core.geo import LocalFrame
from hypothesis import given, settings
from hypothesis import strategies as st
from small_run import RUN_TOML


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


def test_at_time_is_exact_at_the_model_times(make_run):
    run = runs.open(make_run())
    for i, time in enumerate(run.times):
        np.testing.assert_array_equal(at_time(run, time), run.heat_flux(i))


def test_at_time_is_nothing_outside_the_run(make_run):
    run = runs.open(make_run())
    for time in (-1e-9, 120.0001, -np.inf, np.inf):
        assert not at_time(run, time).any()
    with pytest.raises(ValueError, match="not NaN"):
        at_time(run, np.nan)


def test_at_time_of_a_cell_that_burns_on(make_run):
    run = runs.open(make_run())
    assert at_time(run, 75.0)[1, 2] == pytest.approx(1000.5 + 0.25 * 999.75)


def front(times):
    """A straight front that moves 1.5 cells a minute over 12 x 30 cells and burns out in two minutes."""
    behind = 1.5 * np.asarray(times)[:, None] / 60 + 3 - np.arange(30)
    age = behind / 1.5 * 60
    flux = np.where(age > 0, 1e4 * np.exp(-age / 120), 0)
    return np.repeat(flux[:, None, :], 12, axis=1).astype(np.float32)


@pytest.fixture
def front_run(make_run):
    """The front at every fourth minute."""
    size = {"elevation": np.zeros((12, 30), np.float32), "latitude": 38.9 + 0.003 * np.arange(12)}
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    toml = RUN_TOML.replace("60.0", "240.0")
    longitude = -120.6 + 0.004 * np.arange(30)
    return runs.open(
        make_run(toml=toml, heat_flux=front(240.0 * np.arange(5)), longitude=longitude, **size, **none)
    )


def linear(run, time):
    i = int(time // 240)
    w = time / 240 - i
    return (1 - w) * run.heat_flux(i) + w * run.heat_flux(i + 1)


def test_at_time_moves_the_front_at_its_pace(front_run):
    times = np.arange(240.0, 960, 20)
    lit = np.array([(at_time(front_run, t)[6] > 0).sum() for t in times])
    assert (np.diff(lit) >= 0).all()
    np.testing.assert_allclose(lit, 3 + 1.5 * times / 60, atol=1.01)


def test_at_time_is_nearer_to_held_out_minutes_than_linear_blending(front_run):
    times = np.array([t for t in np.arange(0.0, 960, 60) if t % 240])
    truth = front(times)
    moved = np.array([at_time(front_run, t) for t in times])
    blended = np.array([linear(front_run, t) for t in times])
    assert ((moved > 0) != (truth > 0)).sum() < 0.5 * ((blended > 0) != (truth > 0)).sum()
    assert np.abs(moved - truth).sum() < 0.9 * np.abs(blended - truth).sum()


def test_at_time_where_the_whole_grid_burns(make_run):
    """From one burning cell a whole grid: nothing is left that does not burn, so it is a plain blend."""
    flux = np.zeros((2, 4, 5), np.float32)
    flux[0, 0, 0] = 1
    flux[1] = 1
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    run = runs.open(make_run(heat_flux=flux, **none))
    np.testing.assert_allclose(at_time(run, 15.0), np.where(flux[0] > 0, 1, 0.25))


def test_at_time_in_a_row_of_cells(make_run):
    """Cell 0 burned before, cells 1 and 2 light up, cell 3 does not: arrivals (1 - 1/2)/2 and (2 - 1/2)/2."""
    flux = np.zeros((2, 4, 5), np.float32)
    flux[0, :, 0] = 8
    flux[1, :, :3] = 8
    none = dict.fromkeys(("temperature", "wind_east", "wind_north"))
    run = runs.open(make_run(heat_flux=flux, **none))
    for fraction in (0.1, 0.3, 0.6, 0.8, 0.9):
        expected = [8, 8 * max(0, (fraction - 0.25) / 0.75), 8 * max(0, (fraction - 0.75) / 0.25), 0, 0]
        np.testing.assert_allclose(at_time(run, 60 * fraction), [expected] * 4, rtol=1e-6)


def test_at_time_of_a_single_frame(make_run):
    one = np.ones((1, 4, 5), np.float32)
    run = runs.open(make_run(heat_flux=one, temperature=None, wind_east=None, wind_north=None))
    assert at_time(run, 0.0).all()
    assert not at_time(run, 1.0).any()
