"""Smoke mass: emission factor times burned fuel, by kind and phase."""

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.shot.fire import emissions, heat_release
from firetwin.shot.fire.fire import Fire
from firetwin_core import constants
from small_run import FX, FY, NT, NX, NY, RUN_TOML

GRASS, SHRUB, LITTER, CROWN = (emissions.KINDS[kind] for kind in range(4))


def fire_of(make_run, surface, canopy=0.0):
    """A front over uniform fuel, and its fire over all of the run."""
    y, x = np.mgrid[:FY, :FX]
    flux = np.zeros((NT, NY, NX), np.float32)
    flux[:, 1:3, 1:3] = [[[2.0e4]], [[5.0e4]], [[1.0e4]]]
    run = runs.open(
        make_run(
            toml=RUN_TOML.replace("interval_s = 60.0", "interval_s = 150.0"),
            fuel_arrival_time=(12.0 * np.hypot(y - 3, x - 3)).astype(np.float32),
            surface_fuel=np.full((FY, FX), surface, np.float32),
            canopy_fuel=np.full((FY, FX), canopy, np.float32),
            heat_flux=flux,
        )
    )
    return Fire(run, 0.0, float(run.times[-1]), 600.0)


def test_the_kind_of_fuel_is_that_of_its_loads():
    found = emissions.kind([0.3, 0.9, 2.0, 0.3], [0.0, 0.0, 1.5, 0.2])
    assert found.tolist() == [emissions.GRASS, emissions.SHRUB, emissions.LITTER, emissions.LITTER]


def test_the_number_of_a_fuel_model_says_more_than_loads():
    numbers = [2.0, 147.0, 8.0, 11.0, np.nan, 98.0]
    found = emissions.kind(np.full(6, 2.0), np.full(6, 1.0), numbers)
    litter = emissions.LITTER
    assert found.tolist() == [emissions.GRASS, emissions.SHRUB, litter, litter, litter, litter]


@pytest.mark.parametrize(("load", "kind"), [(0.3, GRASS), (1.5, SHRUB)])
def test_smoke_is_emission_factor_times_fuel_burned(make_run, load, kind):
    """Open fuels have one factor for both phases: the total heat of the run determines the mass."""
    fire = fire_of(make_run, load)
    burned = (
        sum(fire.sources(time).power.sum() for time in np.arange(1.0, 300.0)) / constants.HEAT_OF_COMBUSTION
    )
    smoke = sum(fire.sources(time).smoke.sum() for time in np.arange(1.0, 300.0))
    assert burned > 100.0
    assert smoke == pytest.approx(kind.smoke[0] * burned, rel=0.01)


def test_smoke_of_timber_is_that_of_litter_and_crowns_in_both_phases(make_run):
    """Added up piece by piece from the loads and how they burn out, against what sources give."""
    fire = fire_of(make_run, 2.0, 1.0)
    emitted, fuel = fire.sources(140.0), fire.fuel
    lit = np.flatnonzero((fuel.begin < 140.0) & np.isin(fuel.cell, emitted.cell))
    age, crossing = 140.0 - fuel.begin[lit], fuel.crossing[lit]
    lost, flames = heat_release.consumed(age, crossing, fuel.slow[lit], LITTER.residence)
    crowns, _ = heat_release.consumed(age, crossing, CROWN.burn_out[0])
    smoke = fuel.surface[lit] * (flames * LITTER.smoke[0] + (lost - flames) * LITTER.smoke[1])
    smoke += fuel.canopy[lit] * crowns * CROWN.smoke[0]
    heat_of = fuel.surface[lit] * (flames * LITTER.heat[0] + (lost - flames) * LITTER.heat[1])
    heat_of += fuel.canopy[lit] * crowns * CROWN.heat[0]
    assert 0.1 < (fuel.surface[lit] * flames).sum() / (fuel.surface[lit] * lost).sum() < 0.9
    cells = np.unique(emitted.cell)
    expected = [
        emitted.power[emitted.cell == cell].sum()
        * smoke[fuel.cell[lit] == cell].sum()
        / heat_of[fuel.cell[lit] == cell].sum()
        for cell in cells
    ]
    assert [emitted.smoke[emitted.cell == cell].sum() for cell in cells] == pytest.approx(expected, rel=1e-9)


def test_merging_sources_keeps_their_smoke(make_run):
    found = fire_of(make_run, 2.0, 1.0).sources(60.0)
    for most in (1, 5, 400):
        assert heat_release.lights(found, 300.0, most).smoke.sum() == pytest.approx(
            found.smoke.sum(), rel=1e-9
        )


def test_grass_smoke_is_paler_thinner_and_less_than_that_of_timber(make_run, tmp_path):
    grass = fire_of(make_run, 0.3).smoke
    (tmp_path / "run").rename(tmp_path / "grass")
    timber = fire_of(make_run, 2.0, 1.0).smoke
    assert grass.shares[emissions.GRASS] == 1.0
    assert timber.shares[[emissions.LITTER, emissions.CROWN]].sum() == pytest.approx(1.0)
    assert grass.dark < 0.2 < 0.9 < timber.dark
    assert grass.per_heat < 0.5 * timber.per_heat
    assert grass.opacity < 0.2 * timber.opacity


def test_only_a_strong_column_of_timber_hides_more_than_its_mass():
    shares = [0.0, 0.0, 0.64, 0.36]
    strong, weak = (emissions.mix(shares, 1.0 / 1.463e-9, power) for power in (1.0e11, 5.0e8))
    assert strong.opacity == pytest.approx(1.0, abs=0.05)  # as looks were chosen
    assert weak.opacity / weak.dilution == 0.3 < 0.5 * strong.opacity / strong.dilution


def test_smouldering_gives_more_smoke_and_less_heat():
    for kind in emissions.KINDS:
        assert kind.smoke[1] >= kind.smoke[0]
        assert kind.heat[1] <= kind.heat[0] == constants.HEAT_OF_COMBUSTION
    assert LITTER.heat[1] == pytest.approx(15.68e6, rel=1e-3)


def test_heat_without_fuel_smokes_too(make_run):
    found = fire_of(make_run, 0.0).sources(60.0)
    assert found.smoke.sum() == pytest.approx(0.02 * found.power.sum() / 17.433e6)
