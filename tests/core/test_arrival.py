"""When cells begin to burn, between model times: against fires whose arrival is known."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import flux
from firetwin_core import run as runs
from small_run import RUN_TOML

CELLS, FINE, STEP, DECAY = 24, 8, 60.0, 600.0  # cells a side, parts of a cell a side, s, s


def line(x, y):
    """Distance behind which a straight front lies that runs askew over the grid."""
    return 0.8 * x + 0.6 * y


def circle(x, y):
    return np.hypot(x - 3.3, y - 5.1)


def burning(shape, speed, averaged):
    """Fluxes (nt, cells, cells) of a front (cells per step) that burns out, and each cell's true arrival."""
    middle = (np.arange(CELLS * FINE) + 0.5) / FINE
    arrival = shape(*np.meshgrid(middle, middle)) / speed * STEP + 0.3 * STEP
    times = np.arange(int(30 / speed) + 4) * STEP
    frames = []
    for time in times:
        age = np.maximum(time - arrival, 0)
        if averaged:
            frame = (np.exp(-np.maximum(age - STEP, 0) / DECAY) - np.exp(-age / DECAY)) * DECAY / STEP
        else:
            frame = np.where(time >= arrival, np.exp(-age / DECAY), 0)
        frames.append(blocks(frame).mean(axis=(1, 3)) * 5e4)
    return times, np.array(frames, np.float32), blocks(arrival).min(axis=(1, 3))


def blocks(fine):
    return fine.reshape(CELLS, FINE, CELLS, FINE)


def run_of(make_run, frames, toml=RUN_TOML):
    ny, nx = frames.shape[1:]
    return runs.open(
        make_run(
            latitude=38.9 + 0.003 * np.arange(ny),
            longitude=-120.6 + 0.004 * np.arange(nx),
            elevation=np.zeros((ny, nx), np.float32),
            heat_flux=frames,
            temperature=None,
            wind_east=None,
            wind_north=None,
            toml=toml,
        )
    )


@pytest.mark.parametrize("averaged", [True, False])
@pytest.mark.parametrize("speed", [0.15, 0.6, 2.0])
@pytest.mark.parametrize("shape", [line, circle])
def test_nearer_than_the_first_frame_and_than_half_an_interval(make_run, shape, speed, averaged):
    times, frames, truth = burning(shape, speed, averaged)
    run = run_of(make_run, frames)
    plain, fine = run.arrival_time(), flux.arrival_time(run, averaged)
    inside = (plain > 0) & np.isfinite(plain)
    assert inside.sum() > 500

    def error(estimate):
        return np.abs(estimate - truth)[inside].mean()

    assert error(fine) < 0.35 * error(plain)
    assert error(fine) < 0.75 * error(plain - STEP / 2)
    assert abs((fine - truth)[inside].mean()) < 0.15 * STEP
    first = np.searchsorted(times, plain[inside])
    assert (fine[inside] <= times[first]).all()
    assert (fine[inside] >= times[first - 1]).all()


def grown(values, times=None, averaged=False):
    """Arrival of one cell with these fluxes."""
    frames = np.array(values, np.float32)[:, None, None]

    def make(make_run):
        toml = RUN_TOML if times is None else RUN_TOML.replace("interval_s = 60.0", f"times_s = {times}")
        return float(flux.arrival_time(run_of(make_run, frames, toml), averaged)[0, 0])

    return make


HALF, FLUX = 60.0**2 / 12, 0.04 * 60.0**2


@pytest.mark.parametrize(
    ("values", "averaged", "began", "known"),
    [
        ([0, 1, 3], False, 30.0, True),  # F = k s at s = 30 and 90
        ([0, 1, 8], True, 30.0, True),  # k 30^2 / 120 to k (30 + 30), s = 30
        ([0, 1, 5], False, 45.0, True),
        ([0, 3, 2], False, 30.0, False),  # no growth
        ([0, 5, 6], False, 30.0, False),  # began too early
        ([0, 0, 4], False, 90.0, False),  # the last frame
    ],
)
def test_one_cell_by_hand(make_run, values, averaged, began, known):
    """The two estimates weigh as the inverse of their variances."""
    middle = 30.0 + 60.0 * (np.argmax(np.array(values) > 0) - 1)
    share = HALF / (HALF + FLUX) if known else 0.5
    expected = middle + share * (began - middle)
    assert grown(values, averaged=averaged)(make_run) == pytest.approx(expected)


@pytest.mark.parametrize(("values", "began"), [([0, 1, 5], 5.0), ([0, 1, 11], 8.0)])
def test_uneven_times(make_run, values, began):
    """F = k s at s = 5 and 25, or 2 and 22, after an interval of 10 s."""
    share = HALF / (HALF + FLUX)
    expected = 5.0 + share * (began - 5.0)
    assert grown(values, times=[0, 10, 30])(make_run) == pytest.approx(expected)


@pytest.mark.parametrize(("values", "began"), [([0, 5.625, 65], 45.0), ([0, 30, 90], 20.0)])
def test_means_of_less_than_the_interval(make_run, values, began):
    """F = k s, as means of 20 s: k 15^2 / 40, then k (75 - 10), or k (40 - 10), then k (100 - 10)."""
    frames = np.array(values, np.float32)[:, None, None]
    toml = RUN_TOML.replace("60.0", "60.0\nmean_s = 20")
    share = HALF / (HALF + FLUX)
    expected = 30.0 + share * (began - 30.0)
    assert flux.arrival_time(run_of(make_run, frames, toml))[0, 0] == pytest.approx(expected)


def test_mean_s_counts_only_where_fluxes_are_averaged(make_run):
    frames = np.array([0, 1, 3], np.float32)[:, None, None]
    run = run_of(make_run, frames, RUN_TOML.replace("60.0", "60.0\nmean_s = 20"))
    assert flux.arrival_time(run, averaged=False)[0, 0] == pytest.approx(30.0)


def test_what_has_no_arrival_between_times(make_run):
    frames = np.zeros((3, 4, 5), np.float32)
    frames[:, 0, 0] = 7  # burns from the beginning
    frames[1, 1, 1], frames[2, 1, 1] = 1, np.nan
    frames[0, 2, 2], frames[1:, 2, 2] = np.nan, 5
    found = flux.arrival_time(runs.open(make_run(heat_flux=frames)))
    assert found[0, 0] == 0
    assert 0 <= found[1, 1] <= 60
    assert 0 <= found[2, 2] <= 60
    assert np.isfinite(found).sum() == 3


def test_threads_do_not_matter(make_run, all_threads):
    _, frames, _ = burning(circle, 0.15, True)
    run = run_of(make_run, frames)
    results = []
    for threads in (1, 2, 4):
        core.set_threads(threads)
        results.append(flux.arrival_time(run))
    np.testing.assert_array_equal(results[0], results[1])
    np.testing.assert_array_equal(results[0], results[2])
