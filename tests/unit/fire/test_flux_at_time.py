"""Fluxes between model times: the front moves, nothing ghosts and the sum of F^1.5 does not ripple."""

import shutil
from concurrent.futures import ThreadPoolExecutor

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core.flux import Interpolator, at_time
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from hypothesis_profiles import examples
from small_run import NX, NY, RUN_TOML, small_fields, write_field

STEP = 60.0
ALONE = dict.fromkeys(("temperature", "wind_east", "wind_north"))


def brightness(flux):
    return np.sum(np.maximum(flux, 0).astype(float) ** 1.5)


def even(before, after, fraction):
    """F^1.5 that changes linearly, as F."""
    powers = np.asarray(before, float) ** 1.5, np.asarray(after, float) ** 1.5
    return ((1 - fraction) * powers[0] + fraction * powers[1]) ** (2 / 3)


def test_exact_at_the_model_times(make_run):
    run = runs.open(make_run())
    for i, time in enumerate(run.times):
        np.testing.assert_array_equal(at_time(run, time), run.heat_flux(i))


def test_nothing_outside_the_run(make_run):
    run = runs.open(make_run())
    for time in (-1e-9, 120.0001, -np.inf, np.inf):
        assert not at_time(run, time).any()
    with pytest.raises(ValueError, match="must not be NaN"):
        at_time(run, np.nan)


def test_a_single_frame(make_run):
    run = runs.open(make_run(heat_flux=np.ones((1, NY, NX), np.float32), **ALONE))
    assert at_time(run, 0.0).all()
    assert not at_time(run, 1.0).any()


def test_cells_that_burn_on_are_even_in_brightness(make_run):
    flux = np.random.default_rng(2).uniform(1, 1e5, (2, NY, NX)).astype(np.float32)
    run = runs.open(make_run(heat_flux=flux, **ALONE))
    np.testing.assert_allclose(at_time(run, 15.0), even(*flux, 0.25), rtol=1e-6)


def test_what_has_no_brightness_changes_linearly(make_run):
    flux = np.ones((2, NY, NX), np.float32)
    flux[:, 0, :2] = [[-4, 2], [-8, np.nan]]
    found = at_time(runs.open(make_run(heat_flux=flux, **ALONE)), 15.0)
    np.testing.assert_array_equal(found[0], np.array([-5, np.nan, 1, 1, 1], np.float32))


def test_a_row_of_cells(make_run):
    """Cell 0 burned before, cells 1 and 2 begin, cell 3 does not.

    By their place they begin at 1/4 and 3/4. That leaves less than the 2.5 % of cell 0's brightness that are
    granted: the first begins at 0.0125 instead of 0, the second at 0.5125 instead of 0.5.
    """
    flux = np.zeros((2, NY, NX), np.float32)
    flux[0, :, 0] = 8
    flux[1, :, :3] = 8
    run = runs.open(make_run(heat_flux=flux, **ALONE))
    for fraction in (0.01, 0.1, 0.4, 0.51, 0.6, 0.8, 0.99):
        risen = np.clip([1, (fraction - 0.0125) / 0.5, (fraction - 0.5125) / 0.4875], 0, 1)
        factor = (1 + 2 * fraction) / sum(risen)
        expected = 8 * (factor * np.array([*risen, 0, 0])) ** (2 / 3)
        np.testing.assert_allclose(at_time(run, 60 * fraction), [expected] * NY, rtol=1e-6)


def test_where_the_whole_grid_burns(make_run):
    """From one burning cell a whole grid: no cell tells when it begins, so they do together."""
    flux = np.ones((2, NY, NX), np.float32)
    flux[0].flat[1:] = 0
    found = at_time(runs.open(make_run(heat_flux=flux, **ALONE)), 15.0)
    assert np.ptp(found.flat[1:]) == 0
    assert found[1, 1] == pytest.approx(0.25 ** (2 / 3), rel=0.01)
    assert brightness(found) == pytest.approx(1 + 0.25 * 19, rel=1e-6)


def front(times):
    """A straight front that moves 1.5 cells a minute over 12 x 30 cells and burns out in two minutes."""
    behind = 1.5 * np.asarray(times)[:, None] / 60 + 3 - np.arange(30)
    age = behind / 1.5 * 60
    flux = np.where(age > 0, 1e4 * np.exp(-age / 120), 0)
    return np.repeat(flux[:, None, :], 12, axis=1).astype(np.float32)


@pytest.fixture
def front_run(make_run):
    """The front at every fourth minute, in which it moves six cells that fade away behind it."""
    size = {"elevation": np.zeros((12, 30), np.float32), "latitude": 38.9 + 0.003 * np.arange(12)}
    toml = RUN_TOML.replace("60.0", "240.0\nmean_s = 0")
    longitude = -120.6 + 0.004 * np.arange(30)
    flux = front(240.0 * np.arange(5))
    return runs.open(make_run(toml=toml, heat_flux=flux, longitude=longitude, **size, **ALONE))


def linear(run, time):
    i = int(time // 240)
    w = time / 240 - i
    return (1 - w) * run.heat_flux(i) + w * run.heat_flux(i + 1)


def test_the_front_moves_at_its_pace(front_run):
    times = np.arange(240.0, 960, 20)
    pace = 3 + 1.5 * times / 60

    def ahead(interpolate):
        lit = np.array([(interpolate(front_run, t)[6] > 0).sum() for t in times])
        assert (np.diff(lit) >= 0).all()
        return np.abs(lit - pace)

    assert ahead(at_time).max() <= 2.5 < 5 < ahead(linear).max()
    assert ahead(at_time).mean() < 0.65 * ahead(linear).mean()


def test_nearer_to_held_out_minutes_than_linear_blending(front_run):
    times = np.array([t for t in np.arange(240.0, 960, 60) if t % 240])
    truth = front(times)
    moved = np.array([at_time(front_run, t) for t in times])
    blended = np.array([linear(front_run, t) for t in times])
    assert ((moved > 0) != (truth > 0)).sum() < 0.7 * ((blended > 0) != (truth > 0)).sum()
    bright = np.array([brightness(f) for f in moved])
    course = np.interp(times, front_run.times, [brightness(front_run.heat_flux(i)) for i in range(5)])
    np.testing.assert_allclose(bright, course, rtol=1e-6)


def fires(frames=3):
    """Heat fluxes (frames, NY, NX) W/m2, of which some burn."""
    burning = st.one_of(st.just(0.0), st.floats(1, 1e5, width=32))
    return arrays(np.float32, (frames, NY, NX), elements=burning)


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    """Opens a run of these fluxes."""
    number = 0

    def write(flux):
        nonlocal number
        number += 1
        folder = tmp_path_factory.mktemp(f"run{number}")
        (folder / "run.toml").write_text(RUN_TOML)
        for name, values in (small_fields() | ALONE | {"heat_flux": flux}).items():
            if values is not None:
                write_field(folder, name, values, "npy")
        return runs.open(folder)

    return write


quick = settings(deadline=None, max_examples=examples(60), suppress_health_check=[HealthCheck.too_slow])


@quick
@given(flux=fires(), fraction=st.floats(0.001, 0.999))
def test_brightness_is_even_and_the_front_between_the_two(opened, flux, fraction):
    run = opened(flux)
    for i in range(2):
        before, after = flux[i], flux[i + 1]
        between = at_time(run, STEP * (i + fraction))
        whole = (1 - fraction) * brightness(before) + fraction * brightness(after)
        assert brightness(between) == pytest.approx(whole, rel=1e-5)
        assert not between[(before == 0) & (after == 0)].any()
        assert (between[before > 0] > 0).all()
        low, high = np.minimum(before, after), np.maximum(before, after)
        assert (between <= 1.06 * high).all()
        assert (between >= 0.94 * low).all()


@quick
@given(flux=fires(), time=st.floats(0, 2 * STEP))
def test_continuous(opened, flux, time):
    """A thousandth of an interval changes little of the whole, also across a model time."""
    run = opened(flux)
    near = min(2 * STEP, time + 1e-3 * STEP)
    change = np.abs(at_time(run, near).astype(float) ** 1.5 - at_time(run, time).astype(float) ** 1.5)
    assert change.sum() <= 0.05 * max(brightness(f) for f in flux) + 1e-6


@quick
@given(flux=fires(2), fractions=st.tuples(st.floats(0.001, 0.999), st.floats(0.001, 0.999)))
def test_cells_that_are_lit_stay_lit(opened, flux, fractions):
    run = opened(flux)
    early, late = (at_time(run, STEP * f) > 0 for f in sorted(fractions))
    assert not (early & ~late).any()


def test_any_order_and_any_number_of_threads_give_the_same(front_run, all_threads):
    times = np.linspace(0.0, 960.0, 97)
    expected = [at_time(front_run, t) for t in times]
    shared = Interpolator(front_run)
    order = np.random.default_rng(4).permutation(len(times))
    for i in order:
        np.testing.assert_array_equal(shared.at(times[i]), expected[i])
    for threads in (1, 2, 4):
        core.set_threads(threads)
        fresh = Interpolator(runs.open(front_run.path))
        with ThreadPoolExecutor(8) as pool:
            for i, found in zip(order, pool.map(fresh.at, times[order]), strict=True):
                np.testing.assert_array_equal(found, expected[i])


def test_what_burns_is_what_is_not_0(front_run):
    shared = Interpolator(front_run)
    for time in (0.0, 100.0, 240.0, 777.0, 1e9):
        cell, flux = shared.burning(time)
        assert (np.diff(cell) > 0).all()
        whole = np.zeros((12, 30), np.float32)
        whole.flat[cell] = flux
        np.testing.assert_array_equal(whole, shared.at(time))
        assert (flux != 0).all()


def test_frames_asked_for_in_order_are_read_once(make_run):
    """Deleted frames cannot be read again, and need not be."""
    run = runs.open(make_run("text"))
    shared = Interpolator(run)
    first = [shared.at(t) for t in (0.0, 20.0, 60.0, 80.0)]
    shutil.rmtree(f"{run.path}/heat_flux")
    for time, found in zip((0.0, 20.0, 60.0, 80.0, 120.0), [*first, None], strict=True):
        assert found is None or np.array_equal(shared.at(time), found)
    with pytest.raises(core.InputError):
        Interpolator(run).at(20.0)
