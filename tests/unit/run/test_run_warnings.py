"""Extreme runs: gaps of heat flux, a single cell, cells as wide as a county, and a flux beyond any flame."""

from itertools import pairwise

import numpy as np
import pytest
import whole_run
from firetwin.errors import InputError
from firetwin.run import burning, info, readers, released, run_warnings
from firetwin.run import opening as runs
from firetwin.shot.fire import long_burning, smoke_scale
from firetwin.shot.fire.fire import Fire


@pytest.fixture
def make(tmp_path):
    """Write a run of some cells, with W/m2 in some of them from the second time on."""

    def write(cells, flux, **options):
        folder = whole_run.write(tmp_path / "run", cells=cells, arrival=False, **options)
        fluxes = np.zeros_like(np.load(folder / "heat_flux.npy"))
        for place, value in flux:
            fluxes[1:][(slice(None), *place)] = value
        np.save(folder / "heat_flux.npy", fluxes)
        return runs.open(folder)

    return write


def test_gaps_of_heat_flux_are_counted_and_named(make):
    run = make(16, [((8, slice(2, 6)), 5e4), ((3, slice(4, 14)), np.nan)])
    (text,) = run_warnings.of_fire(run)
    assert text.startswith("heat_flux has no value 20 times, first at 2020-07-01T20:30:00Z, 38.89")
    assert text.endswith("there it counts as no fire")
    assert text in info.gather(run, "UTC")["warnings"]


def test_a_flux_beyond_the_sun_is_refused_with_its_time_and_cell(make):
    run = make(16, [((8, slice(2, 6)), 5e4), ((3, 4), 1e38)])
    words = r"heat_flux: has 1e\+38 W/m2 at time 2, 2020-07-01T20:30:00Z, in row 4, column 5"
    for read in (run_warnings.of_fire, lambda each: info.gather(each, "UTC")):
        with pytest.raises(InputError, match=words):
            read(run)


def test_a_run_without_gaps_has_no_warning(make):
    assert run_warnings.of_fire(make(16, [((8, 8), 5e4)])) == []


@pytest.mark.parametrize("step", [1_000.0, 9_000.0])
def test_a_step_that_no_cliff_has_is_named(make, step):
    run = make(16, [((8, 8), 5e4)], height=lambda east, north: np.where(east > 0.0, step, 0.0))
    found = run_warnings.of_fire(run)
    assert len(found) == (step > run_warnings._CLIFF)
    if found:
        assert found[0].startswith("elevation has a step of 9,000 m between two cells at 38.89")
        assert found[0] in info.gather(run, "UTC")["warnings"]


@pytest.mark.parametrize("height", [1e6, -2e4, np.inf])
def test_heights_that_the_earth_does_not_have_are_refused(make, height):
    run = make(16, [], height=lambda east, north: np.where(east > 200.0, height, 100.0))
    with pytest.raises(InputError, match=r"elevation: has an elevation of .* m in row 1, column 16, and"):
        readers.open(run.path)


@pytest.mark.parametrize("cells", [1, 2])
def test_a_run_of_few_cells_releases_the_heat_that_its_smoke_is_of(make, cells):
    run = make(cells, [((0, 0), 5e4)], cell=100.0)
    heat = 5e4 * 100.0**2 * 2700.0  # J; 30 minutes, and half of the 30 minutes before
    assert released.energy(run) == pytest.approx(heat, rel=0.01)
    assert info.gather(run, "UTC")["energy"] == pytest.approx(heat, rel=0.01)
    fire = Fire(run, 0.0, 3600.0)
    power = np.array([fire.sources(time).power.sum() for time in np.linspace(0.0, 3600.0, 241)])
    assert np.sum(0.5 * (power[1:] + power[:-1])) * 15.0 == pytest.approx(released.energy(run), rel=0.005)
    assert fire.smoke_made(0.0, 3600.0) > 0.0
    warned = [text for text in run_warnings.of_fire(run) if "single cell" in text]
    assert len(warned) == (cells == 1)


def test_smoke_of_parts_of_a_shot_adds_up(make):
    run = make(16, [((8, slice(2, 6)), 5e4)])
    fire = Fire(run, 1800.0, 3000.0, before=1800.0)
    edges = np.linspace(600.0, 3000.0, 66)
    parts = [fire.smoke_made(*ends) for ends in pairwise(edges)]
    assert sum(parts) == pytest.approx(fire.smoke_made(600.0, 3000.0), rel=1e-9)
    short = Fire(run, 1800.0, 1800.002, before=600.0)
    rate = short.sources(1800.001).smoke.sum()
    assert short.smoke_made(1800.0, 1800.002) == pytest.approx(0.002 * rate)


@pytest.mark.parametrize(("fuel_cell", "coarse"), [(30.0, False), (4800.0, False), (10_000.0, True)])
def test_cells_that_resolve_no_plume_are_named(fuel_cell, coarse):
    scale = smoke_scale.choose(20.0 * fuel_cell, fuel_cell)
    assert len(smoke_scale.warnings(scale, fuel_cell)) == coarse


def test_ground_stays_in_flames_where_flux_is_beyond_any_front(make):
    """A cell of 1e7 W/m2 was at 319 K after its fuel had burned out, in the thermal picture."""
    run = make(16, [((8, 8), 1e7), ((4, 4), 1e5)])
    lasts = long_burning.duration(run)
    assert lasts[8, 8] == pytest.approx(3600.0)
    assert np.count_nonzero(lasts) == 1
    residence = Fire(run, 0.0, 3600.0).residence
    assert residence[8, 8] == pytest.approx(3600.0)
    assert residence[4, 4] < 200.0


def test_no_ordinary_fire_burns_longer_than_its_fuel(make):
    assert long_burning.duration(make(16, [((8, 8), 2.9e5)])) is None


def test_no_cell_shines_more_than_the_hottest_front(make):
    """Light of 1e7 W/m2 on its smoke made a picture at noon as dark as by night."""
    run = make(4, [((1, 1), 1e7), ((2, 2), 1e5)])
    fire = Fire(run, 0.0, 3600.0)
    sources = fire.sources(1800.0)
    lit, all_light = fire.luminous(sources), sources.luminous()
    area = fire.cell_area.reshape(4, 4)
    assert lit.power[sources.cell == 5].sum() == pytest.approx(burning.CROWN_FIRE_FLUX * area[1, 1])
    ordinary = sources.cell == 10
    assert np.array_equal(lit.power[ordinary], all_light.power[ordinary])
    assert sources.power[sources.cell == 5].sum() == pytest.approx(1e7 * area[1, 1])
