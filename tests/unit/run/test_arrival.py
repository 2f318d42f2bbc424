"""When the front passes the middle of cells, between model times: against fires whose arrival is known."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core.flux import Interpolator
from small_run import RUN_TOML

CELLS, FINE, STEP, DECAY = 24, 8, 60.0, 600.0  # cells a side, parts of a cell a side, s, s
INSTANT = RUN_TOML.replace("60.0", "60.0\nmean_s = 0")


def line(x, y):
    """Distance behind which a straight front lies that runs askew over the grid."""
    return 0.8 * x + 0.6 * y


def circle(x, y):
    return np.hypot(x - 3.3, y - 5.1)


def arrival(shape, speed, parts):
    """True arrival (s) at the middle of each of `parts` x `parts` pieces of the cells."""
    middle = (np.arange(CELLS * parts) + 0.5) / parts
    return shape(*np.meshgrid(middle, middle)) / speed * STEP + 0.3 * STEP


def burning(shape, speed, averaged, frames=None, decay=DECAY):
    """Fluxes (nt, cells, cells) of a front (cells per step) that burns out."""
    fine = arrival(shape, speed, FINE)
    frames_of_flux = []
    for time in np.arange(frames or int(30 / speed) + 4) * STEP:
        age = np.maximum(time - fine, 0)
        if averaged:
            frame = (np.exp(-np.maximum(age - STEP, 0) / decay) - np.exp(-age / decay)) * decay / STEP
        else:
            frame = np.where(time >= fine, np.exp(-age / decay), 0)
        frames_of_flux.append(frame.reshape(CELLS, FINE, CELLS, FINE).mean(axis=(1, 3)) * 5e4)
    return np.array(frames_of_flux, np.float32)


def run_of(make_run, frames, toml=RUN_TOML, parts=1, load=0.0):
    """A run of these fluxes whose fuel cells, of a load, are `parts` x `parts` pieces of the cells."""
    ny, nx = frames.shape[1:]
    fuel = np.zeros((ny * parts, nx * parts), np.float32) + np.float32(load)
    axes = {
        f"{prefix}{name}": first + step * ((np.arange(n * k) + 0.5) / k - 0.5)
        for prefix, k in (("", 1), ("fuel_", parts))
        for name, first, step, n in (("latitude", 38.9, 0.003, ny), ("longitude", -120.6, 0.004, nx))
    }
    return runs.open(
        make_run(
            elevation=np.zeros((ny, nx), np.float32),
            surface_fuel=fuel,
            canopy_fuel=np.zeros_like(fuel),
            heat_flux=frames,
            temperature=None,
            wind_east=None,
            wind_north=None,
            toml=toml,
            **axes,
        )
    )


@pytest.mark.parametrize("averaged", [True, False])
@pytest.mark.parametrize("speed", [0.15, 0.6, 2.0, 5.0])
@pytest.mark.parametrize("shape", [line, circle])
def test_the_front_is_where_it_is(make_run, shape, speed, averaged):
    """Within a fifth of a cell in the mean, and a twentieth of the front's way in an interval more."""
    frames = burning(shape, speed, averaged)
    run = run_of(make_run, frames, RUN_TOML if averaged else INSTANT)
    truth = arrival(shape, speed, 1)
    off = (run.arrival_time() - truth) * speed / STEP  # cells
    known = truth > STEP  # what burned from the first frame has no beginning
    assert np.isfinite(off[known]).mean() > 0.95
    off = off[known & np.isfinite(off)]
    assert np.abs(off).mean() < 0.2 + 0.05 * speed
    assert abs(off.mean()) < 0.17 + 0.05 * speed


@pytest.mark.parametrize("speed", [0.15, 0.6, 3.0])
@pytest.mark.parametrize("shape", [line, circle])
def test_the_front_is_a_line_as_fine_as_the_fuel_until_the_run_ends(make_run, shape, speed):
    """A front that still moves at the last frame, on fuel cells a fourth of the cells."""
    frames = burning(shape, speed, True, frames=max(int(12 / speed), 4))
    end = (len(frames) - 1) * STEP
    run = run_of(make_run, frames, parts=4)
    arrivals, truth = run.fuel_arrival_time(), arrival(shape, speed, 4)
    assert np.nanmax(arrivals) <= end
    for time in (end - STEP / 2, end):
        off = np.where((arrivals <= time) != (truth <= time), np.abs(truth - time) * speed / STEP, 0)
        assert off.max() < 1.0 + 0.3 * speed  # cells
        front = CELLS * 4 * 1.2
        assert np.count_nonzero(off) / front / 4 < 0.25 + 0.1 * speed
        assert (arrivals <= time).sum() == pytest.approx((truth <= time).sum(), rel=0.08 + 0.05 * speed)


def test_cells_at_the_edge_of_a_fire_that_stopped_burn_in_part(make_run):
    """The front stops 0.7 of a cell short of the end of those that it has touched last."""
    x = np.broadcast_to((np.arange(CELLS * FINE) + 0.5) / FINE, (CELLS * FINE,) * 2)
    fine = np.where(x < 12.3, x * STEP * 4, np.inf)
    frames = []
    for time in np.arange(160) * STEP:
        age = np.maximum(time - fine, 0)
        frame = (np.exp(-np.maximum(age - STEP, 0) / DECAY) - np.exp(-age / DECAY)) * DECAY / STEP
        frames.append(frame.reshape(CELLS, FINE, CELLS, FINE).mean(axis=(1, 3)) * 5e4)
    run = run_of(make_run, np.array(frames, np.float32), parts=4)
    burned = np.isfinite(run.fuel_arrival_time()).sum(axis=1) / 4
    assert burned == pytest.approx(np.full(CELLS * 4, 12.3), abs=0.3)


@pytest.mark.parametrize("speed", [0.6, 1.5])
def test_the_front_goes_on_evenly_until_the_last_moment(make_run, speed):
    """In each part of the last interval it gains as much ground as is true, and none at once at its end."""
    frames = burning(line, speed, True, frames=int(20 / speed), decay=STEP)
    end = (len(frames) - 1) * STEP
    arrivals = run_of(make_run, frames, parts=4).fuel_arrival_time()
    truth = arrival(line, speed, 4)
    front = np.count_nonzero(np.diff(truth <= end, axis=0)) / 4 / 0.6 * 0.8  # cells
    for time in end - STEP * np.array([0.0, 1e-6, 0.3, 0.6, 1.0]):
        ahead = ((arrivals <= time).sum() - (truth <= time).sum()) / 16 / front
        assert abs(ahead) < 0.3, time  # cells
    assert not (arrivals > end - 1e-3).any()


def test_light_fuel_burns_beside_heavy_fuel(make_run):
    """At the rim of the fire a cell of light fuel releases little heat, but it burned."""
    load = np.repeat(np.where(np.arange(CELLS) // 2 % 2, 4.0, 0.5), CELLS).reshape(CELLS, CELLS)
    x = np.arange(CELLS)
    lit = np.where(x < 12, x * STEP * 4, np.inf)
    age = np.maximum((np.arange(160) * STEP)[:, None] - lit, 0)
    heat = (np.exp(-np.maximum(age - STEP, 0) / DECAY) - np.exp(-age / DECAY)) * DECAY / STEP * 5e4
    frames = (heat[:, None, :] * load[None, :, :]).astype(np.float32)
    found = run_of(make_run, frames, load=np.repeat(np.repeat(load, 4, 0), 4, 1), parts=4).fuel_arrival_time()
    assert np.isfinite(found).sum(axis=1) / 4 == pytest.approx(np.full(CELLS * 4, 12.0), abs=0.5)


def test_ground_without_fuel_does_not_burn_where_fuel_is_known(make_run):
    load = np.ones((CELLS * 4, CELLS * 4), np.float32)
    load[:, 41] = 0.0
    share = load.reshape(CELLS, 4, CELLS, 4).mean(axis=(1, 3))
    frames = burning(line, 0.6, True) * share
    found = run_of(make_run, frames, load=load, parts=4).fuel_arrival_time()
    assert np.isnan(found[:, 41]).all()
    assert np.isfinite(found[:, [39, 40, 42, 43]]).mean() > 0.95


def test_fuel_that_is_not_known_everywhere_says_nothing(make_run):
    load = np.ones((CELLS * 4, CELLS * 4), np.float32)
    load[:, 40:44] = 0.0  # all of cells that give heat
    found = run_of(make_run, burning(line, 0.6, True), load=load, parts=4).fuel_arrival_time()
    assert np.isfinite(found[:, 40:44]).mean() > 0.9


@pytest.mark.parametrize("trace", [1e-38, 1e-3, 0.3])
def test_traces_where_nothing_burns_are_no_fire(make_run, trace):
    frames = burning(circle, 0.6, True)[:30]
    plain = run_of(make_run, frames, parts=2)
    found, flux = plain.fuel_arrival_time(), Interpolator(plain)
    lit = [flux.at(time) > 0 for time in (90.0, 600.0, 1234.5)]
    np.save(f"{plain.path}/heat_flux.npy", np.maximum(frames, np.float32(trace)))
    traced = runs.open(plain.path)
    assert traced.fuel_arrival_time() == pytest.approx(found, abs=0.02 * STEP, nan_ok=True)
    flux = Interpolator(traced)
    for time, before in zip((90.0, 600.0, 1234.5), lit, strict=True):
        assert not (flux.at(time) > 0)[~before].any()
        assert before.sum() < before.size


def test_times_as_large_as_those_since_1970(make_run):
    frames = burning(circle, 0.6, True)
    zero = 1_410_912_000.0
    times = (zero + STEP * np.arange(len(frames))).tolist()
    toml = RUN_TOML.replace("interval_s = 60.0", f"times_s = {times}\nmean_s = 60.0")
    near = run_of(make_run, frames, RUN_TOML.replace("60.0", "60.0\nmean_s = 60.0"))
    found, flux = near.arrival_time(), Interpolator(near).at(333.3)
    with open(f"{near.path}/run.toml", "w") as file:
        file.write(toml)
    far = runs.open(near.path)
    assert far.times.tolist() == near.times.tolist()
    assert far.arrival_time() == pytest.approx(found, abs=1e-5, nan_ok=True)
    assert Interpolator(far).at(333.3) == pytest.approx(flux, rel=1e-5)


def test_what_burns_from_the_beginning_has_burned_the_longer_the_farther_behind_the_front(make_run):
    frames = burning(line, 0.3, True)[20:]
    found = run_of(make_run, frames).arrival_time()
    inside = frames[0] >= 1
    assert (found[inside] <= 0).all()
    assert found[0, 0] == np.nanmin(found) < -3 * STEP
    assert (found[~inside & np.isfinite(found)] > -STEP).all()


def test_the_runs_own_times_are_the_arrival_time(make_run):
    frames = burning(line, 0.6, True)
    own = arrival(line, 0.6, 2)
    run = run_of(make_run, frames, parts=2)
    np.save(f"{run.path}/fuel_arrival_time.npy", own.astype(np.float32))
    run = runs.open(run.path)
    np.testing.assert_array_equal(run.fuel_arrival_time(), own.astype(np.float32))
    assert run.arrival_time()[1:-1, 1:-1] == pytest.approx(arrival(line, 0.6, 1)[1:-1, 1:-1], abs=0.01)
    middle, lit = arrival(line, 0.6, 1), Interpolator(run).at(700.0) > 0
    assert lit[middle < 700.0].all()
    assert not lit[middle > 700.0 + STEP / 0.6 * 0.7 + STEP / 2].any()  # 0.7: half a cell's width askew


def grown(values, times=None, averaged=False):
    """Arrival of one cell with these fluxes."""
    frames = np.array(values, np.float32)[:, None, None]

    def make(make_run):
        toml = RUN_TOML if times is None else RUN_TOML.replace("interval_s = 60.0", f"times_s = {times}")
        toml = toml if averaged else toml.replace("vertical", "mean_s = 0\nvertical")
        return float(run_of(make_run, frames, toml).arrival_time()[0, 0])

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
    assert run_of(make_run, frames, toml).arrival_time()[0, 0] == pytest.approx(expected)


def test_what_has_no_arrival_between_times(make_run):
    frames = np.zeros((3, 4, 5), np.float32)
    frames[:, 0, 0] = 7  # burns from the beginning
    frames[1, 1, 1], frames[2, 1, 1] = 1, np.nan
    frames[0, 2, 2], frames[1:, 2, 2] = np.nan, 5
    found = runs.open(make_run(heat_flux=frames)).arrival_time()
    assert found[0, 0] == 0
    assert 0 <= found[1, 1] <= 60
    assert 0 <= found[2, 2] <= 60
    assert np.isfinite(found).sum() == 3


def test_threads_do_not_matter(make_run, all_threads):
    folder = run_of(make_run, burning(circle, 0.15, True), parts=3).path
    results = []
    for threads in (1, 2, 4):
        core.set_threads(threads)
        run = runs.open(folder)
        results.append((run.fuel_arrival_time(), run.heat_released(), np.array(run.flux_range())))
    for other in results[1:]:
        for first, second in zip(results[0], other, strict=True):
            np.testing.assert_array_equal(first, second)


def test_heat_released_is_the_integral_of_the_flux(make_run):
    frames = burning(circle, 0.6, True)
    run = run_of(make_run, frames)
    whole = frames.astype(float)
    expected = STEP * (whole.sum(axis=0) - 0.5 * (whole[0] + whole[-1]))
    np.testing.assert_allclose(run.heat_released(), expected, rtol=1e-12)
