"""Resolution of a flow for a fire of some size: cells, steps and the cell budget."""

import numpy as np
import pytest
from fires import axes, round_fire
from firetwin.run import opening as runs
from firetwin.shot.fire import smoke_scale
from firetwin.shot.fire.smoke_scale import FINER, REFERENCE, Scale
from hypothesis import given
from hypothesis import strategies as st

EXTENTS = st.floats(100.0, 5.0e5)
BUDGETS = st.floats(0.5, 30.0)


def finest(each):
    return each.cell / FINER**each.nested


def test_the_king_fire_has_the_cells_that_all_was_chosen_for():
    assert smoke_scale.choose(19_300.0, 74.0) == Scale(REFERENCE, nested=True)


def test_a_burn_of_300_m_has_cells_of_5_m():
    assert smoke_scale.choose(300.0, 3.0).cell == pytest.approx(5.0)


@given(EXTENTS, st.floats(1.0, 3.0), BUDGETS)
def test_larger_fires_are_never_finer(extent, times, budget):
    assert finest(smoke_scale.choose(extent * times, 10.0, budget)) >= finest(
        smoke_scale.choose(extent, 10.0, budget)
    )


@given(EXTENTS, st.floats(1.0, 5.0), BUDGETS)
def test_a_larger_budget_is_never_coarser(extent, times, budget):
    assert finest(smoke_scale.choose(extent, 10.0, budget * times)) <= finest(
        smoke_scale.choose(extent, 10.0, budget)
    )


@given(EXTENTS, st.floats(2.0, 1000.0))
def test_heat_lies_in_at_most_three_cells_a_side(extent, fuel_cell):
    assert smoke_scale.choose(extent, fuel_cell).cell >= 0.999 * fuel_cell / 3.0


@given(st.floats(5.0, 1600.0))
def test_speeds_go_with_the_cube_root_of_lengths(cell):
    each = Scale(cell)
    assert each.length(1.0) / each.time(1.0) == pytest.approx(each.ratio ** (1 / 3))
    assert each.time(10.0) == pytest.approx(each.step)


@pytest.mark.parametrize("speed", [0.2, 1.0])
def test_the_extent_is_that_of_what_burns_in_the_shot(make_run, speed):
    latitude, longitude = axes(n=120, cell=50.0)
    arrival = round_fire(latitude, longitude, speed)
    run = runs.open(make_run(**fields(latitude, longitude, arrival)))
    found = smoke_scale.extent(run, arrival, 0.0, 1000.0)
    assert found == pytest.approx(2000.0 * speed, abs=150.0)
    assert smoke_scale.extent(run, np.full_like(arrival, np.nan), 0.0, 1000.0) == pytest.approx(15_000.0)


def fields(latitude, longitude, arrival):
    flat = np.zeros(arrival.shape, np.float32)
    return {
        "latitude": latitude,
        "longitude": longitude,
        "elevation": flat,
        "fuel_latitude": latitude,
        "fuel_longitude": longitude,
        "surface_fuel": flat + 1.0,
        "canopy_fuel": flat,
        "heat_flux": np.zeros((3, *arrival.shape), np.float32),
        "fuel_arrival_time": arrival.astype(np.float32),
        "temperature": None,
        "wind_east": None,
        "wind_north": None,
    }
