"""Distance up to which flames are drawn as a volume, and the map of their length."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.shot.cameras.path import Path
from firetwin.shot.fire import flame_map, flame_size
from firetwin.shot.settings import Settings
from firetwin_core import constants
from straight_front import PACE, shot_of


def camera(width, half=0.64, perspective=True):
    nowhere = np.zeros((1, 3))
    return Path(None, nowhere, np.eye(3)[None], nowhere, (half, half), perspective, width=width)


def test_reach_is_where_long_flames_are_two_pixels_high(make_run):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    length = flame_size.flame_length(constants.HEAT_OF_COMBUSTION / 1000.0 * 3.0 * PACE, "thomas")
    assert flame_map.typical_length(shot) == pytest.approx(length, rel=0.02)
    found = flame_map.reach(shot, camera(640))
    assert found == pytest.approx(length / (2.0 * 2.0 * 0.64 / 640), rel=0.02)
    assert flame_map.reach(shot, camera(1920)) == pytest.approx(min(3.0 * found, 12_000.0))
    assert flame_map.reach(shot, camera(1920, perspective=False)) == 0.0


def test_weight_falls_to_zero_beyond_the_reach():
    assert flame_map.weight([0.0, 800.0, 1000.0, 1200.0], 1000.0) == pytest.approx([1.0, 1.0, 0.5, 0.0])
    assert flame_map.weight(5.0, 0.0) == 0.0


def test_nothing_is_reached_without_flames(make_run):
    shot = shot_of(make_run, 20.0, 0.3)
    assert flame_map.reach(shot, camera(640)) > 0.0
    shot.settings = replace(shot.settings, fire=replace(Settings().fire, flames=False))
    assert flame_map.reach(shot, camera(640)) == 0.0


def over_front(shot, time, eye=(0.0, 0.0, 3.0), limit=300.0):
    return flame_map.squares(shot, np.array(eye), time, limit)


@pytest.mark.parametrize(
    ("load", "canopy", "low", "high"), [(0.1, 0.0, 0.5, 3.0), (0.3, 0.0, 1.0, 5.2), (2.0, 1.0, 12.0, 50.0)]
)
def test_flames_are_as_high_as_their_fuel_makes_them(make_run, load, canopy, low, high):
    shot = shot_of(make_run, 20.0, load, canopy)
    (square, *_) = [each for each in over_front(shot, 300.0) if each.spacing == 1.0]
    tall = np.percentile(square.length[square.length > 0.0], 98)
    assert low < tall < high


def test_flames_stand_where_the_front_has_just_passed(make_run):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    time = 300.0
    (square, *_) = [each for each in over_front(shot, time) if each.spacing == 1.0]
    east = square.corner[0] + square.spacing * np.arange(len(square.length))
    front = -230.0 + PACE * (time - 1.0)  # cell centres begin 230 m west of the middle
    mean = square.length.mean(axis=0)
    assert mean[east > front + 8.0].max(initial=0.0) == 0.0
    assert mean[(east < front - 3.0) & (east > front - 20.0)].mean() > 5.0
    assert mean[east < front - 2.0 * 120.0 * PACE].max(initial=0.0) < 1.0


@pytest.mark.parametrize(("load", "canopy", "remains"), [(0.5, 0.0, False), (2.0, 1.0, True)])
def test_grass_leaves_no_flames_behind_its_front(make_run, load, canopy, remains):
    time, shot = 300.0, shot_of(make_run, 20.0, load, canopy)
    (square, *_) = [each for each in over_front(shot, time) if each.spacing == 1.0]
    east = square.corner[0] + np.arange(len(square.length))
    front = -230.0 + PACE * (time - 1.0)
    assert square.length[:, east < front - 5.0 - 20.0 * PACE].any() == remains


def test_distant_fronts_are_lines(make_run):
    shot = shot_of(make_run, 20.0, 2.0, canopy=1.0)
    (square, *_) = [
        each for each in over_front(shot, 300.0, (1500.0, 0.0, 3.0), 4000.0) if each.spacing == 16.0
    ]
    burning = square.length.max(axis=1)
    rows = np.flatnonzero(burning)[2:-2]
    assert len(rows) > 5
    assert (burning[rows] > 4.0).all()


def test_squares_agree_and_do_not_depend_on_the_camera(make_run):
    shot = shot_of(make_run, 20.0, 2.0)
    near, other = over_front(shot, 300.0), over_front(shot, 300.0, eye=(37.0, -11.0, 3.0))
    for a, b in zip(near, other, strict=True):
        shift = np.rint((np.array(b.corner) - a.corner) / a.spacing).astype(int)
        rows, columns = (slice(max(k, 0), len(a.length) + min(k, 0)) for k in shift[::-1])
        back = [slice(max(-k, 0), len(a.length) + min(-k, 0)) for k in shift[::-1]]
        both = (a.length[rows, columns] > 0.0) & (b.length[back[0], back[1]] > 0.0)
        assert np.allclose(a.length[rows, columns][both], b.length[back[0], back[1]][both], atol=0.02)


def test_flames_change_little_in_a_moment(make_run):
    shot = shot_of(make_run, 20.0, 2.0)
    a, b = (over_front(shot, time)[1].length for time in (450.0, 450.04))
    assert a.max() > 1.0
    assert np.abs(a - b).max() < 0.7
    assert np.array_equal(a, over_front(shot, 450.0)[1].length)


def test_a_lens_leaves_out_flames_behind_the_camera(make_run):
    shot = shot_of(make_run, 20.0, 2.0)
    ahead = np.column_stack([(0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)])  # looks east
    lens = flame_map.ViewCone(ahead, (0.5, 0.3))
    eye, time = np.array([200.0, 0.0, 3.0]), 300.0
    assert any(square.length.any() for square in flame_map.squares(shot, eye, time, 400.0))
    assert not any(square.length.any() for square in flame_map.squares(shot, eye, time, 400.0, lens))
