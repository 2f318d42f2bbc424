"""Numbers of fuel models: as a run's field, and what kind of fuel each is."""

import numpy as np
import pytest
from firetwin.run import fuel_category as categories
from firetwin.run import info
from firetwin.run import opening as runs
from firetwin.run.models import fuels
from firetwin.shot.sections import TerrainSettings
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin_core import Error, InputError
from small_run import FX, FY


def number(*values):
    """A fuel grid that is filled with these numbers in turn."""
    return np.resize(np.array(values, np.float32), (FY, FX))


def test_a_run_has_the_field_or_not(make_run):
    kept = number(1, 10, 204, -9999)  # the last is no_data
    run = runs.open(make_run(fuel_category=kept))
    assert run.has("fuel_category")
    found = run.fuel_rows("fuel_category", 2, 5)
    np.testing.assert_array_equal(found, np.where(kept == -9999, np.nan, kept)[2:5])
    assert not any("fuel_category" in text for text in run.warnings)


def test_a_run_without_it_says_so(make_run):
    without = runs.open(make_run())
    assert not without.has("fuel_category")
    assert categories.shares(without) is None
    with pytest.raises(Error, match="no fuel_category"):
        without.fuel_rows("fuel_category", 0, 1)


def test_another_shape_is_refused_when_the_run_is_opened(make_run):
    with pytest.raises(InputError, match="fuel_category"):
        runs.open(make_run(fuel_category=number(1)[:, 1:]))


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        (categories.GRASS, [1, 3, 101, 109, 122]),
        (categories.SHRUB, [4, 6, 141, 149]),
        (categories.LITTER, [8, 10, 161, 165, 181, 189]),
        (categories.SLASH, [11, 13, 201, 204]),
        (categories.UNBURNABLE, [14, 91, 98, 99]),
        (categories.UNKNOWN, [0, 15, 90, 110, 205, 300, -5, np.nan, np.inf]),
    ],
)
def test_kinds(kind, numbers):
    assert set(categories.kinds(np.array(numbers, float))) == {kind}


def test_every_model_with_a_load_burns():
    numbers = np.arange(256)
    burns = fuels.loads(numbers) > 0
    kinds = categories.kinds(numbers)
    assert (burns == ~np.isin(kinds, [categories.UNKNOWN, categories.UNBURNABLE])).all()


def test_shares_are_of_cells_and_said(make_run):
    run = runs.open(make_run(fuel_category=number(1, 1, 1, 4)))
    shares = categories.shares(run)
    assert shares["grass"] == pytest.approx(0.75)
    assert shares["shrub"] == pytest.approx(0.25)
    assert "grass 75 %, shrub 25 %" in info.page(info.gather(run, "UTC"))


def test_litter_is_under_trees_where_a_model_brings_no_canopy(make_run):
    bare = np.zeros((FY, FX), np.float32)
    run = runs.open(make_run(fuel_category=number(1, 8), canopy_fuel=bare))
    found = categories.canopy(run)
    assert set(found[number(1, 8) == 8]) == {np.float32(categories.IMPLIED)}
    assert not found[number(1, 8) == 1].any()


def test_litter_without_canopy_is_a_clearing_where_other_litter_has_some(make_run):
    some = np.zeros((FY, FX), np.float32)
    some[0] = 1.5
    run = runs.open(make_run(fuel_category=number(8), canopy_fuel=some))
    np.testing.assert_array_equal(categories.canopy(run), some)


def test_water_is_where_the_category_says_so_also_where_heights_are_rough(make_run):
    lake = number(2)
    lake[2:5, 3:6] = 98
    run = runs.open(make_run(fuel_category=lake))
    ground = Shot(Settings(terrain=TerrainSettings(apron=0.0)), run).ground
    np.testing.assert_array_equal(ground.water > 0.5, lake == 98)
