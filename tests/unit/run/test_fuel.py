"""Fuel that burns in a shot, from the rows in which something burns."""

from dataclasses import fields

import numpy as np
import pytest
from firetwin.run import blocks, burning
from firetwin.run import opening as runs
from firetwin.shot.fire import fuel as fuels
from firetwin_core import InputError
from small_run import FX, FY, small_fields

GRID = ("surface_fuel", "canopy_fuel", "fuel_elevation")


def front(pace=40.0):
    """Arrival times of a front that starts in a corner, with cells that it never reaches."""
    y, x = np.mgrid[:FY, :FX]
    arrival = (pace * np.hypot(y, 1.7 * x)).astype(np.float32)
    arrival[2:4, 5] = np.nan
    return arrival


@pytest.mark.parametrize(
    "window", [(0.0, 120.0, 0.0), (100.0, 200.0, 50.0), (1e5, 2e5, 0.0), (-9e5, -8e5, 0)]
)
def test_fuel_does_not_depend_on_how_many_rows_are_read_at_once(make_run, monkeypatch, window):
    run = runs.open(make_run(fuel_arrival_time=front()))
    whole = fuels.gather(run, None, *window)
    monkeypatch.setattr(blocks, "CELLS", 1)
    by_rows = fuels.gather(run, None, *window)
    known = fuels.gather(run, run.fuel_arrival_time(), *window)
    for field in fields(fuels.Fuel):
        assert np.array_equal(getattr(by_rows, field.name), getattr(whole, field.name)), field.name
        assert np.array_equal(getattr(known, field.name), getattr(whole, field.name)), field.name


def test_all_that_has_fuel_and_is_reached_burns_once(make_run):
    given = small_fields()
    surface = given["surface_fuel"].copy()
    canopy = given["canopy_fuel"].copy()
    surface[1], canopy[1], surface[2, 2] = 0.0, 0.0, np.nan
    run = runs.open(make_run(fuel_arrival_time=front(), surface_fuel=surface, canopy_fuel=canopy))
    found = fuels.gather(run, None, -np.inf, np.inf, 0.0)
    weight = np.nan_to_num(surface.astype(float)) + canopy
    burns = np.isfinite(front()) & (weight > 0.0)
    assert found.surface.sum() + found.canopy.sum() == pytest.approx(weight[burns].sum(), rel=1e-12)


@pytest.mark.parametrize("pace", [40.0, 4000.0])  # s a cell: cells are crossed in a minute, and in an hour
@pytest.mark.parametrize("load", [0.0, 3.0])  # kg/m2 on the surface: the canopy alone, and slow timber
def test_what_still_burns_is_found_however_long_ago_it_began(make_run, monkeypatch, pace, load):
    """A window has what all of the fuel, gathered without one, says that burns in it."""
    monkeypatch.setattr(fuels, "DETAIL", 1.0)  # so that each cell is a piece
    surface = np.full((FY, FX), load, np.float32)
    run = runs.open(make_run(fuel_arrival_time=front(pace), surface_fuel=surface))
    every = fuels.gather(run, None, -np.inf, np.inf, np.inf)
    assert len(every.cell) == FY * FX - 2
    for before in (0.0, 1e3, 4e4):
        for first in np.linspace(-pace, every.over.max() + 1.1 * before, 41):
            found = fuels.gather(run, None, first, first + 60.0, before)
            recent = (every.over > first) | (every.arrival >= first - before)
            expected = every.take((every.begin < first + 60.0) & recent)
            for field in fields(fuels.Fuel):
                assert np.array_equal(getattr(found, field.name), getattr(expected, field.name)), field.name


@pytest.mark.parametrize("form", ["npy", "text"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_rows_are_those_of_the_whole_grid(make_run, form, order):
    surface = small_fields()["surface_fuel"]
    surface[3, 4] = -9999.0  # no_data
    replaced = {"surface_fuel": np.asarray(surface, order=order), "fuel_arrival_time": front()}
    run = runs.open(make_run(form, **replaced))
    for name in GRID:
        whole = getattr(run, name)
        for first, last in ((0, FY), (2, 5), (FY, FY), (0, 1), (FY - 1, FY)):
            assert np.array_equal(run.fuel_rows(name, first, last), whole[first:last], equal_nan=True)
    assert np.isnan(run.fuel_rows("surface_fuel", 3, 4)[0, 4])
    assert np.array_equal(run.fuel_rows("fuel_arrival_time", 1, 4), front()[1:4], equal_nan=True)


def test_rows_and_fields_that_are_not_there(make_run):
    run = runs.open(make_run())
    for rows in ((-1, 2), (3, 2), (0, FY + 1)):
        with pytest.raises(IndexError, match="8 rows"):
            run.fuel_rows("surface_fuel", *rows)
    with pytest.raises(ValueError, match="choose surface_fuel"):
        run.fuel_rows("elevation", 0, 1)
    with pytest.raises(InputError, match="fuel_arrival_time"):
        run.fuel_rows("fuel_arrival_time", 0, 1)


def test_a_file_cut_off_after_it_was_opened_is_an_error(make_run):
    folder = make_run()
    run = runs.open(folder)
    path = folder / "surface_fuel.npy"
    path.write_bytes(path.read_bytes()[:200])
    for ask in (lambda: run.surface_fuel, lambda: run.fuel_rows("surface_fuel", 0, FY), lambda: run.warnings):
        with pytest.raises(InputError, match="surface_fuel"):
            ask()


def test_a_front_crosses_a_cell_in_its_size_over_its_speed():
    y, x = np.mgrid[:6, :7]
    found = burning.crossing(300.0 * y - 400.0 * x, y.ravel(), x.ravel())
    assert found == pytest.approx(np.full(42, 500.0))


def test_a_fast_front_crosses_small_cells_in_seconds_and_coarse_ones_in_a_minute():
    assert [burning.least_crossing(cell) for cell in (1.0, 20.0, 74.0, 370.0)] == pytest.approx(
        [2.0, 6.67, 60.0, 60.0], abs=0.01
    )
    time = np.arange(6.0)[None] * 10.0  # 20 m at 2 m/s
    found = burning.crossing(time, np.zeros(6, int), np.arange(6), burning.least_crossing(20.0))
    assert found == pytest.approx(np.full(6, 10.0))


def test_a_jump_to_another_fire_is_no_slow_front():
    time = np.array([[0.0, 70.0, 150.0, 9000.0, 9100.0]])
    row, column = np.divmod(np.arange(5), 5)
    assert burning.crossing(time, row, column).tolist() == [70.0, 70.0, 80.0, 100.0, 100.0]
