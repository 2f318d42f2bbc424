"""Flame depth of the front for any cell size, and cooling of the ground behind it."""

import numpy as np
import pytest
from firetwin.shot.fire import air_temperature, emissions, flame_depth
from straight_front import PACE, N, shot_of


@pytest.mark.parametrize("cell", [10.0, 30.0, 370.0])
@pytest.mark.parametrize(
    ("load", "canopy", "stands"), [(0.3, 0.0, 15.0), (2.0, 0.0, 45.0), (2.0, 1.0, 120.0)]
)
def test_flames_are_as_deep_as_the_front_is_fast_whatever_the_cells(make_run, cell, load, canopy, stands):
    shot = shot_of(make_run, cell, load, canopy)
    assert flame_depth.head(shot.front, *shot.frames.span) == pytest.approx(PACE * stands, rel=0.02)


def test_intensity_is_byrams_where_it_burns(make_run):
    shot = shot_of(make_run, 20.0, 0.3)
    burned = shot.ground.burned > 0.5
    assert np.median(shot.front.intensity[burned]) == pytest.approx(17_400.0 * 0.3 * PACE, rel=0.05)
    assert (shot.front.intensity[shot.ground.burned <= 0.0] == 0.0).all()


def test_flanks_are_thinner_than_the_head(make_run):
    shot = shot_of(make_run, 20.0, 0.3, flank=0.1)
    front, margin = shot.front, shot.bare_ground.fields.margin
    inner = slice(margin + 4, margin + N - 4)
    deep = (front.speed * front.residence)[inner, inner]
    assert deep[:4] == pytest.approx(7.5, rel=0.02)
    assert deep[-4:] == pytest.approx(0.75, rel=0.02)
    assert shot.front_scale == pytest.approx(0.15)  # patterns of grass are finer than a crown fire's


def test_a_grass_scar_cools_in_minutes_and_a_forests_in_hours():
    grass, timber = (emissions.KINDS[kind].residence for kind in (emissions.GRASS, emissions.LITTER))
    age = np.array([60.0, 300.0, 900.0, 3600.0])
    above = air_temperature.cooling(age, grass)
    assert (np.diff(above) < 0.0).all()
    assert above[0] > 30.0
    assert above[1] < 20.0
    assert above[2] < 10.0
    assert air_temperature.cooling(3600.0, timber) > 30.0
    assert air_temperature.cooling(3600.0, timber) == air_temperature.cooling(3600.0)
    assert air_temperature.cooling(1.0, grass) == air_temperature.cooling(1.0, timber)
