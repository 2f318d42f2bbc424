"""The model's heat shared out: no watt lost or made, and nothing jumps."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.data import sample
from firetwin.run import opening as runs
from firetwin.shot.fire import heat_release
from firetwin.shot.fire.fire import Fire
from firetwin_core import flux
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples


@pytest.fixture(scope="module")
def sample_run(tmp_path_factory):
    """A few of the sample run's times, among them its strongest."""
    folder = tmp_path_factory.mktemp("sample")
    sample.write(folder, frames=12)
    return runs.open(folder)


def of_cells(sources, count):
    return np.bincount(sources.cell, sources.power, count)


def wanted(run, time):
    return np.asarray(flux.at_time(run, time), np.float64).ravel() * whole(run).cell_area


def whole(run):
    """The fire of all of a run."""
    return Fire(run, -np.inf, np.inf)


def test_every_cell_keeps_its_heat_at_every_minute(run):
    model = whole(run)
    for time in [*run.times, 100.0, 2001.5]:
        found, cells = model.sources(float(time)), wanted(run, float(time))
        assert of_cells(found, len(cells)) == pytest.approx(cells, rel=1e-9, abs=1e-3)
        assert np.all((found.flaming >= 0.0) & (found.flaming <= found.power))


def test_the_sample_keeps_its_heat(sample_run):
    model = whole(sample_run)
    lit = 0
    for time in sample_run.times:
        found, cells = model.sources(float(time)), wanted(sample_run, float(time))
        lit += len(found.power)
        assert of_cells(found, len(cells)) == pytest.approx(cells, rel=1e-6, abs=1.0)
        merged = heat_release.lights(found)
        assert merged.power.sum() == pytest.approx(cells.sum(), rel=1e-9)
        assert len(merged.power) <= 400
    assert lit > 1000


def test_a_cell_with_flux_and_no_burning_fuel_has_a_source_at_its_centre(run):
    model = whole(run)
    sources = model.sources(0.0)  # the test run has flux ahead of its fire
    alone = sources.fuel_cell < 0
    assert alone.any()
    row, column = np.divmod(sources.cell[alone], len(run.longitude))
    centre = model.frame.forward(run.latitude[row], run.longitude[column], run.elevation[row, column])
    assert sources.position[alone] == pytest.approx(centre)
    assert len(np.unique(sources.cell[alone])) == alone.sum()


def test_burning_fuel_lies_in_the_cell_whose_heat_it_gives(run):
    found = whole(run).sources(1800.0)
    fuel = found.fuel_cell >= 0
    row, column = np.divmod(found.fuel_cell[fuel], len(run.fuel_longitude))
    assert np.array_equal(found.cell[fuel], row // 5 * 24 + column // 5)


@settings(deadline=None, max_examples=examples(60))
@given(st.floats(60.0, 3600.0), st.floats(20.0, 1500.0))
def test_a_cell_consumes_all_its_fuel_and_no_more(crossing, burn_out):
    age = np.linspace(0.0, crossing + 20.0 * burn_out, 40_001)
    total, flaming = heat_release.consumed(age, crossing, burn_out)
    assert np.sum(0.5 * (total[1:] + total[:-1]) * np.diff(age)) == pytest.approx(1.0, abs=1e-3)
    assert np.all((flaming >= 0.0) & (flaming <= total + 1e-18))
    assert np.all(np.diff(total[age > crossing]) <= 0.0)


@settings(deadline=None, max_examples=examples(60))
@given(st.integers(1, 60), st.integers(1, 40), st.integers(0, 2**32 - 1))
def test_merging_lights_keeps_their_heat_and_its_centre(count, most, seed):
    random = np.random.default_rng(seed)
    position = random.uniform(-2000.0, 2000.0, (count, 3))
    power = random.exponential(1.0e8, count) * (random.random(count) < 0.8)
    none = np.full(count, -1)
    merged = heat_release.lights(
        heat_release.Sources(position, power, 0.3 * power, 1e-9 * power, none, none), 300.0, most
    )
    assert len(merged.power) <= most
    assert merged.power.sum() == pytest.approx(power.sum(), rel=1e-12)
    assert merged.flaming.sum() == pytest.approx(0.3 * power.sum(), rel=1e-9)
    if len(merged.power):
        assert merged.power @ merged.position == pytest.approx(
            power @ position, rel=1e-9, abs=1e3 * power.max()
        )


@pytest.mark.parametrize("most", [60, 200])
def test_merged_lights_change_gradually(most):
    """Ten times shorter steps make ten times smaller changes: nothing jumps."""
    random = np.random.default_rng(2)
    position = random.uniform(0.0, 9000.0, (400, 3)) * (1.0, 1.0, 0.0)
    phase, none = random.uniform(0.0, 6.28, 400), np.full(400, -1)
    places = random.uniform(0.0, 9000.0, (50, 2))

    def light(moment):
        power = 1.0e6 * (1.0 + np.sin(phase + moment)) ** 3
        merged = heat_release.lights(
            heat_release.Sources(position, power, power, 1e-9 * power, none, none), 300.0, most
        )
        gap = np.linalg.norm(places[:, None] - merged.position[None, :, :2], axis=-1)
        return (merged.power / (gap**2 + 250.0**2)).sum(axis=1)

    def change(steps):
        values = np.array([light(moment) for moment in np.linspace(0.0, 0.1, steps + 1)])
        return np.abs(np.diff(values, axis=0)).max()

    assert change(400) < 0.2 * change(40)


def test_a_shot_keeps_the_heat_of_its_moments(shot, run):
    """The shares of all burning fuel add up to the flux, from its first frame to its last."""
    fuel = False
    for time in (*shot.frames.times, 720.0, 1080.0, 1200.0):
        found, cells = shot.fire.sources(float(time)), wanted(run, float(time))
        fuel |= bool(np.any(found.fuel_cell >= 0))
        assert of_cells(found, len(cells)) == pytest.approx(cells, rel=1e-9, abs=1e-3)
        assert found.flaming.sum() + (found.power - found.flaming).sum() == pytest.approx(cells.sum())
    assert fuel


def test_no_lights_at_all(run):
    found = whole(run).sources(float(run.times[-1]) + 1.0)
    assert len(found.power) == 0
    assert len(heat_release.lights(found).power) == 0
    assert len(heat_release.lights(replace(found), count=0).power) == 0
