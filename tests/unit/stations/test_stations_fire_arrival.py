"""Fire arrival at points, compared with the arrival times and with the front of the run."""

import numpy as np
import pytest
from firetwin.run import front, times
from firetwin.run import opening as runs
from firetwin.stations import fire_arrival
from firetwin.stations.distance import distance_km
from small_run import small_fields


@pytest.fixture
def burning(make_run):
    """A run with arrival times: a straight front to the north-east, and a corner that stays."""
    fields = small_fields()
    y, x = np.meshgrid(fields["fuel_latitude"], fields["fuel_longitude"], indexing="ij")
    arrival = 5.0 + 4000.0 * (y - y.min()) + 2000.0 * (x - x.min())
    arrival[6:, 7:] = np.nan
    arrival[0, 0] = -30.0
    return runs.open(make_run(fuel_arrival_time=arrival)), y, x, arrival


def test_at_the_centres_of_cells_the_times_are_the_runs_own(burning):
    run, y, x, _ = burning
    arrivals = fire_arrival.sample(run, y.ravel(), x.ravel())
    own = run.fuel_arrival_time().ravel()
    assert fire_arrival.first_burned_point(run) == pytest.approx((y[0, 0], x[0, 0]))
    np.testing.assert_allclose(arrivals.time, own, rtol=1e-6)
    for bound in (arrivals.earliest, arrivals.latest):
        np.testing.assert_allclose(bound[np.isfinite(own)], own[np.isfinite(own)], atol=0.01)
    assert (
        arrivals.state
        == np.where(
            np.isnan(own),
            fire_arrival.NOT_REACHED,
            np.where(own < 0, fire_arrival.BEFORE, fire_arrival.REACHED),
        )
    ).all()


def test_between_cells_the_time_is_the_planes_and_within_its_bounds(burning):
    run, y, x, _ = burning
    rng = np.random.default_rng(1)
    latitude, longitude = rng.uniform(y[1, 0], y[5, 0], 200), rng.uniform(x[0, 1], x[0, 6], 200)
    found = fire_arrival.sample(run, latitude, longitude)
    plane = 5.0 + 4000.0 * (latitude - y.min()) + 2000.0 * (longitude - x.min())
    np.testing.assert_allclose(found.time, plane, atol=1e-4)
    assert (found.earliest <= plane).all()
    assert (found.latest >= plane).all()
    assert (found.latest - found.earliest <= 4000 * 0.0015 + 2000 * 0.002 + 1e-4).all()


def test_the_front_passes_a_place_at_its_time(burning):
    run, y, x, _ = burning
    rng = np.random.default_rng(2)
    latitude, longitude = rng.uniform(y.min(), y.max(), 500), rng.uniform(x.min(), x.max(), 500)
    arrivals, reach = fire_arrival.sample(run, latitude, longitude), front.reach(run)
    burned = reach.burned(latitude, longitude, float(run.times[-1])) == 1.0
    assert (np.isfinite(arrivals.time) == burned).all()
    whole = np.isfinite(arrivals.time) & (arrivals.latest < float(run.times[-1]))  # no cell that stays around
    for k in np.flatnonzero(whole & (arrivals.time > 6.0)):
        before, after = (
            reach.burned(latitude[k : k + 1], longitude[k : k + 1], float(arrivals.time[k]) + step)[0]
            for step in (-0.01, 0.01)
        )
        assert (before, after) == (0.0, 1.0)
    assert whole.sum() > 200


def test_where_the_front_stops_the_latest_is_the_end_of_the_run(burning):
    run, y, x, _ = burning
    found = fire_arrival.sample(run, [0.6 * y[5, 8] + 0.4 * y[6, 8]], [x[5, 8]])
    assert found.state[0] == fire_arrival.REACHED
    assert found.latest[0] == run.times[-1]


def test_outside_of_the_grid_nothing_is_said(burning):
    run, *_ = burning
    arrivals = fire_arrival.sample(run, [38.0, 38.9005, 38.9005], [-120.59, -121.0, 239.41])
    assert arrivals.state.tolist() == [
        fire_arrival.OUTSIDE,
        fire_arrival.OUTSIDE,
        fire_arrival.REACHED,
    ]  # 239.41 east is -120.59
    assert arrivals.utc(run, 0) is None
    assert arrivals.utc(run, 2)[0] == times.utc(run, float(arrivals.time[2]))


def test_times_from_fluxes_are_an_interval_less_certain(make_run):
    run = runs.open(make_run())
    own = run.fuel_arrival_time()
    row, column = (at[0] for at in np.nonzero(np.isfinite(own)))
    found = fire_arrival.sample(run, [run.fuel_latitude[row]], [run.fuel_longitude[column]])
    assert found.time[0] == pytest.approx(own[row, column])
    assert found.earliest[0] <= own[row, column] - 60.0
    assert found.latest[0] >= own[row, column] + 60.0


def test_a_run_without_fire_reaches_nothing(make_run):
    run = runs.open(make_run(heat_flux=np.zeros_like(small_fields()["heat_flux"])))
    assert fire_arrival.first_burned_point(run) is None
    found = fire_arrival.sample(run, [38.9], [-120.6])
    assert found.state.tolist() == [fire_arrival.NOT_REACHED]
    assert np.isnan(found.nearest_km[0])


def test_how_close_the_fire_comes_to_what_does_not_burn(burning):
    run, y, x, arrival = burning
    latitude, longitude = np.array([38.0, y[7, 9], y[2, 2]]), np.array([-120.59, x[7, 9], x[2, 2]])
    arrivals = fire_arrival.sample(run, latitude, longitude)
    row, column = np.nonzero(np.isfinite(arrival))
    for k in range(2):  # against all cells that burn
        far = distance_km(y[row, column], x[row, column], (latitude[k], longitude[k]))
        assert arrivals.nearest_km[k] == pytest.approx(far.min())
        at = np.flatnonzero(far <= far.min() + 1e-9)
        assert arrivals.nearest_time[k] in arrival[row[at], column[at]].astype(np.float32)
    assert (arrivals.nearest_km[2], arrivals.nearest_time[2]) == (0.0, arrivals.time[2])
