"""The air that smoke rises into, and the moments of a shot."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin import project as projects
from firetwin import times
from firetwin.scene import air
from firetwin_core import run as runs


@pytest.fixture
def run(make_run):
    return runs.open(make_run())


def test_nights_are_stable_and_afternoons_mixed(run):
    hours = np.arange(0.0, 24.0 * 3600.0, 600.0)  # from 21:45 local time on
    found = np.array([air.stability(run, time) for time in hours])
    assert found[18] == air.NIGHT  # 00:45
    assert found[108] == air.DAY  # 15:45
    assert np.all((found >= air.DAY) & (found <= air.NIGHT))


def test_stability_changes_smoothly(run):
    seconds = np.arange(0.0, 86400.0, 60.0)
    found = np.log([air.stability(run, time) for time in seconds])
    assert np.abs(np.diff(found)).max() < 0.12  # a minute moves plume tops by less than 4 %


def test_a_still_has_one_moment(run):
    start = datetime(2014, 9, 17, 4, 46, tzinfo=UTC)
    still = projects.Project(time=projects.Time(start=start, frames=1))
    assert times.window(still, run) == (60.0, 60.0)
    film = replace(still, time=projects.Time(start=start, frames=2))
    assert times.window(film, run) == (60.0, 120.0)
