"""Distance up to which flames are drawn as a volume."""

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
