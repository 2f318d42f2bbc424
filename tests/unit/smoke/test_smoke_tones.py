"""Tone of smoke: soot over flames, pale over smouldering and light fuel, looked up against the wind."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.shot.fire import emissions
from firetwin.shot.fire.heat_release import Sources
from firetwin.shot.terrain import noise
from firetwin.smoke import tones

CELL, SHAPE, AGES = 100.0, (20, 30), (20.0, 600.0)


def shot(*places, wind=(0.0, 0.0), kinds=None):
    """A shot with sources at cells (row, column, flaming share)."""
    row, column, flaming = np.array(places, float).reshape(-1, 3).T
    n = len(row)
    position = np.column_stack([(column + 0.5) * CELL, (row + 0.5) * CELL, np.zeros(n)])
    sources = Sources(position, np.ones(n), flaming, np.ones(n), np.arange(n), np.arange(n))
    surface, canopy = np.full((1, max(n, 1)), 3.0), np.full((1, max(n, 1)), 1.0)
    for index, kind in enumerate(kinds or ()):
        if kind == emissions.GRASS:
            surface[0, index], canopy[0, index] = 0.3, 0.0
    fields = {"surface_fuel": surface, "canopy_fuel": canopy}
    run = SimpleNamespace(
        fuel_longitude=np.arange(max(n, 1)),
        has=lambda _: False,
        fuel_rows=lambda name, first, last: fields[name][first:last],
    )
    fire = SimpleNamespace(sources=lambda _: sources, smoke=SimpleNamespace(dark=1.0))
    return SimpleNamespace(run=run, fire=fire, wind=wind)


def soot(*places, **more):
    return tones.soot_share(shot(*places, **more), 0.0, (0.0, 0.0), CELL, SHAPE)


def test_flames_are_sooty_and_smouldering_is_pale():
    found = soot((5, 5, 1.0), (5, 20, 0.0))
    assert found[5, 5] == pytest.approx(1.0)
    assert found[5, 20] == pytest.approx(0.0)
    assert found[15, 15] == pytest.approx(0.5)  # the mean away from sources


def test_flames_of_grass_are_pale():
    found = soot((5, 5, 1.0), (5, 20, 1.0), kinds=(emissions.GRASS, emissions.LITTER))
    assert found[5, 5] == pytest.approx(0.12)
    assert found[5, 20] == pytest.approx(1.0)


def test_without_sources_smoke_keeps_its_age():
    age = np.full((2, *SHAPE), 30.0, np.float32)
    assert tones.apparent_age(shot(), 0.0, age, (0.0, 0.0), CELL, AGES) is age


def test_smoke_downwind_has_the_tone_of_its_source():
    wind = (10.0 / 1.3, 0.0)  # 10 m/s aloft
    age = np.zeros((1, *SHAPE), np.float32)
    age[0, 5, 15] = 100.0  # emitted 10 cells upwind, over the flames
    age[0, 5, 16] = 10.0  # emitted a cell upwind, where fuel smoulders
    made = shot((5, 5, 1.0), (5, 15, 0.0), wind=wind)
    found = tones.apparent_age(made, 0.0, age, (0.0, 0.0), CELL, AGES)
    assert found[0, 5, 15] == pytest.approx(100.0)
    assert found[0, 5, 16] == pytest.approx(AGES[1])


def test_half_of_the_smoke_from_flames_makes_half_of_the_dark_share():
    """Ages past those of the tone stay, as the vapour of a cap evaporates by them."""
    age = np.broadcast_to(np.array([0.0, 200.0, 400.0, 1500.0], np.float32)[:, None, None], (4, *SHAPE))
    found = tones.apparent_age(shot((0, 0, 1.0), (19, 29, 0.0)), 0.0, age, (0.0, 0.0), CELL, AGES)[:, 10, 15]
    dark = 1.0 - noise.smoothstep(*AGES, age[:, 10, 15])
    assert 1.0 - noise.smoothstep(*AGES, found) == pytest.approx(0.5 * dark, abs=1e-5)
    assert found[3] == 1500.0
