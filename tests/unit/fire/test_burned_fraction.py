"""Runs with burned fractions: areas, scores, maps and fuel use these fractions."""

import numpy as np
import pytest
from firetwin.run import areas, burned_fraction, info, maps, released
from firetwin.run import opening as runs
from firetwin.run.arrival_grid import ArrivalGrid
from firetwin.run.models.arrival import from_share, held
from firetwin.run.models.grid import Grid
from firetwin.run.score.overlap import Overlap
from firetwin.shot.fire import fuel
from firetwin_core import constants
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.contour import QuadContourSet
from small_run import FX, FY, NT, small_fields

AXES = "fuel_latitude", "fuel_longitude"


def shares(seed=3):
    """Fractions of a fire that grows: 1 in the south, partial next to it, 0 in the north."""
    rng = np.random.default_rng(seed)
    share = np.zeros((NT, FY, FX), np.float32)
    for k in range(NT):
        share[k, : k + 2] = 1.0
        share[k, k + 2] = rng.random(FX)
    return share


def when(share):
    """Arrival times (s) of its cells' middles, of a run with times 0, 60 and 120."""
    first = (share >= 0.5).argmax(0).astype(np.float32) * 60
    return np.where((share >= 0.5).any(0), first, np.nan).astype(np.float32)


@pytest.fixture
def run(make_run):
    return runs.open(make_run(burned_fraction=shares(), fuel_arrival_time=when(shares())))


def test_areas_are_sums_of_shares(run):
    cell = areas.cell_areas(*(getattr(run, axis) for axis in AXES))
    own = [(share.astype(float) * cell).sum() for share in shares()]
    moments = [120.0, 30.0, 0.0, 60.0, -1.0, 999.0]
    expected = [own[2], (own[0] + own[1]) / 2, own[0], own[1], 0.0, own[2]]
    assert info.burned(run, moments) == pytest.approx(expected, rel=1e-6)
    facts = info.gather(run, "UTC")
    assert facts["burned"]["from"] == "burned_fraction"
    assert "burned fraction of each cell" in info.page(facts)
    load = (np.asarray(run.surface_fuel, float) + run.canopy_fuel) * shares()[-1]
    assert released.of_fuel(run) == pytest.approx(
        (load * cell).sum() * constants.HEAT_OF_COMBUSTION, rel=1e-6
    )


@pytest.mark.parametrize("time", [0.0, 45.0, 120.0, 500.0])
def test_a_moment_between_two_times(run, time):
    share, at = shares(), np.clip(time / 60, 0, 2)
    low = min(int(at), 1)
    expected = (1 - (at - low)) * share[low] + (at - low) * share[low + 1]
    np.testing.assert_allclose(burned_fraction.at(run, time), expected, atol=1e-6)


def test_scores_on_cells_count_shares(run):
    grid = ArrivalGrid.from_run(run)
    seen = np.zeros((FY, FX), bool)
    seen[:4] = True
    found = Overlap.of_cells(grid.burned(120.0), seen, grid.areas)
    share = shares()[-1].astype(float)
    assert found.both == pytest.approx((share * grid.areas)[seen].sum(), rel=1e-6)
    assert found.run_only == pytest.approx((share * grid.areas)[~seen].sum(), rel=1e-6)
    assert found.both + found.seen_only == pytest.approx(grid.areas[seen].sum(), rel=1e-6)
    total = found.both + found.run_only + found.seen_only + found.neither
    assert total == pytest.approx(grid.domain, rel=1e-6)


def test_rows_from_the_north_are_scored_where_they_are(make_run):
    fields = small_fields()
    share = np.zeros((NT, FY, FX), np.float32)
    share[:, 0] = 1.0  # the northernmost
    run = runs.open(make_run(fuel_latitude=fields["fuel_latitude"][::-1].copy(), burned_fraction=share))
    burned = ArrivalGrid.from_run(run).burned(0.0)
    assert burned[-1].all()
    assert not burned[:-1].any()


def test_fuel_burns_by_its_share(run):
    """Also of cells whose middle the front never reaches: as much burns as burned."""
    every = fuel.gather(run, None, -np.inf, np.inf, np.inf)
    load = np.asarray(run.surface_fuel, float) + run.canopy_fuel
    assert every.surface.sum() + every.canopy.sum() == pytest.approx((load * shares()[-1]).sum(), rel=1e-6)
    part = (shares()[-1] > 0) & np.isnan(when(shares()))
    assert part.any()
    assert np.isfinite(every.arrival).all()


def test_the_map_hatches_what_the_run_began_with(run):
    (axes, *_) = maps.intensity_map(run, "UTC").axes
    assert any(isinstance(each, QuadContourSet) for each in axes.collections)


@given(st.integers(0, 2**32 - 1), st.floats(-40.0, 40.0), st.floats(0.3, 1.0))
def test_on_a_turned_grid_as_much_area_burns(seed, turn, size):
    """A share stays one, what no cell nearby burned stays unburned, and the sum is the model's."""
    y, x = np.mgrid[:30, :40] * 100.0
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    grid = Grid(39 + (s * x + c * y) / 111_019.0, -120 + (c * x - s * y) / 86_628.0)
    where = np.random.default_rng(seed).uniform(1000, 2000, 2)
    share = np.clip((500 * size - np.hypot(y - where[0], x - where[1])) / 100 + 0.5, 0, 1)
    placed = grid.placed
    found = placed.put_share(share)
    assert found.min() >= 0.0
    assert found.max() <= 1.0
    cell = areas.cell_areas(placed.latitude, placed.longitude)
    assert (found * cell).sum() == pytest.approx((share * 1e4).sum(), rel=2e-3)


@given(st.integers(0, 2**32 - 1))
def test_arrival_is_held_to_when_half_of_a_cell_burned(seed):
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(1, 100, 6))
    share = np.sort(rng.random((6, 5, 4)), axis=0) * rng.random((5, 4))
    own = rng.uniform(-50, 500, (5, 4))
    own[0, 0] = np.nan
    times_held = held(own, times, lambda i: share[i])
    for k, time in enumerate(times):
        np.testing.assert_array_equal(times_held <= time, share[k] > 0.5)
    by_share = from_share(times, lambda i: share[i], own.shape)
    assert ((times_held == own) | (times_held == by_share) | np.isnan(times_held)).all()
    here = np.searchsorted(times, own) == np.searchsorted(times, by_share)
    np.testing.assert_array_equal(times_held[here & np.isfinite(by_share)], own[here & np.isfinite(by_share)])
