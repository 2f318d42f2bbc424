"""The synthetic ensemble: travel times by closed form, members by number, and the run of a member."""

import numpy as np
import pytest
from firetwin import argument_types, cli
from firetwin.data import members, sample, stored
from firetwin.errors import UsageError
from firetwin.forecasts.ensemble import ensemble, synthetic


@pytest.fixture(scope="module")
def spread() -> members.Spread:
    return members.Spread.of(stored.load())


def test_travel_times_in_a_uniform_rate():
    """Distance over rate: exact along 16 directions, and at most 2.8 % late between them."""
    start = np.full((41, 41), np.inf)
    start[20, 20] = 100.0
    times = members.travel(np.full_like(start, 0.5), start) - 100.0
    y, x = np.mgrid[-20:21, -20:21]
    exact = np.hypot(x, y) * members.CELL_SIZE / 0.5
    along = (x == 0) | (y == 0) | (abs(x) == abs(y)) | (abs(x) == 2 * abs(y)) | (2 * abs(x) == abs(y))
    np.testing.assert_allclose(times[along], exact[along], rtol=1e-12)
    ratio = times[~along] / exact[~along]
    assert ratio.min() > 1.0
    assert ratio.max() < 1.028


def test_fire_goes_around_cells_without_fuel():
    rate = np.ones((9, 9))
    rate[:8, 4:6] = 0.0  # 16 neighbours jump over a single cell
    start = np.full_like(rate, np.inf)
    start[0, 0] = 0.0
    times = members.travel(rate, start)
    assert np.isinf(times[:8, 4:6]).all()
    assert times[0, 8] > times[8, 8] > times[8, 0]


def test_member_zero_is_the_sample_and_others_depend_on_their_number(spread):
    first = members.arrival(spread, 0)
    np.testing.assert_array_equal(np.isfinite(first), np.isfinite(spread.arrival))
    one, two = members.arrival(spread, 1), members.arrival(spread, 2)
    np.testing.assert_array_equal(one, members.arrival(spread, 1))
    assert (np.isfinite(one) != np.isfinite(two)).sum() > 100
    before = spread.arrival <= 0
    np.testing.assert_array_equal(one[before], first[before])  # one initial perimeter


def test_one_fire_has_one_area(spread):
    """Member 0 and the sample, whose cells are a quarter as wide, have one burned area at each time."""
    fine, first = stored.load().arrival, members.arrival(spread, 0)
    for hour in (0.0, 6.0, 18.0, 24.0, stored.MINUTES / 60.0):
        burned = (fine <= 3600.0 * hour).sum() * members.FUEL_CELL_SIZE**2
        assert (first <= 3600.0 * hour).sum() * members.CELL_SIZE**2 == pytest.approx(burned, rel=0.01)


def test_the_model_reproduces_the_fire_that_it_is_fitted_to(spread):
    burned = np.where(spread.arrival <= 0, 0.0, np.inf)
    times = members.travel(spread.rate, burned)
    mine, burned = times <= stored.MINUTES * 60.0, np.isfinite(spread.arrival)
    assert mine.sum() == pytest.approx(burned.sum(), rel=0.1)
    assert (mine & burned).sum() / (mine | burned).sum() > 0.7


def test_the_fine_grid_interpolates():
    """A plane stays a plane, and cells that never burn stay so."""
    y, x = np.mgrid[: members.CELLS, : members.CELLS]
    plane = (100.0 * x + 30.0 * y).astype(np.float32)
    plane[-5:] = np.inf
    fine = members.fine(plane)
    row, column = (np.mgrid[: 4 * members.CELLS, : 4 * members.CELLS] + 0.5) / 4 - 0.5
    inner = (slice(4, -28), slice(4, -4))
    np.testing.assert_allclose(fine[inner], (100.0 * column + 30.0 * row)[inner], atol=1e-6)
    assert np.isnan(fine[-20:]).all()


def test_an_ensemble_and_the_run_of_a_member(tmp_path):
    synthetic.write(tmp_path / "ensemble", 2)
    forecast = ensemble.open(tmp_path / "ensemble")
    assert forecast.manifest.synthetic
    assert [member.name for member in forecast.members] == ["00", "01"]
    sample.write(tmp_path / "run", 2, member=argument_types.member(forecast.members[1].name))
    assert "member 01" in (tmp_path / "run" / "run.toml").read_text(encoding="utf-8")
    run = np.load(tmp_path / "run" / "fuel_arrival_time.npy")
    coarse = np.isfinite(run).reshape(members.CELLS, 4, members.CELLS, 4).any((1, 3))
    np.testing.assert_array_equal(coarse, np.isfinite(forecast.arrival(1)))
    assert cli.main(["sample", str(tmp_path / "typical"), "--member", "0", "--frames", "2"]) == 0
    assert argument_types.member("00") == 0
    with pytest.raises(UsageError, match="1 is not a number of members from 2 to 200"):
        synthetic.write(tmp_path / "one", 1)
