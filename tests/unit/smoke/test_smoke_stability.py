"""The air that smoke rises into, and the moments of a shot."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import sun
from firetwin.shot import frames
from firetwin.shot.sections import Time
from firetwin.smoke import stability
from firetwin_core import run as runs


@pytest.fixture
def run(make_run):
    return runs.open(make_run())


def at(run, time):
    return stability.at_elevation(sun.position(run, time)[1])


def test_nights_are_stable_and_afternoons_mixed(run):
    hours = np.arange(0.0, 24.0 * 3600.0, 600.0)  # from 21:45 local time on
    found = np.array([at(run, time) for time in hours])
    assert found[18] == stability.NIGHT  # 00:45
    assert found[108] == stability.DAY  # 15:45
    assert np.all((found >= stability.DAY) & (found <= stability.NIGHT))


def test_stability_changes_smoothly(run):
    seconds = np.arange(0.0, 86400.0, 60.0)
    found = np.log([at(run, time) for time in seconds])
    assert np.abs(np.diff(found)).max() < 0.12  # a minute moves plume tops by less than 4 %


def test_a_still_has_one_moment(run):
    start = datetime(2014, 9, 17, 4, 46, tzinfo=UTC)
    still = frames.resolve(Time(start=start, frames=1), run)
    assert (still.first, still.last) == (60.0, 60.0)
    film = frames.resolve(Time(start=start, frames=2), run)
    assert (film.first, film.last) == (60.0, 120.0)
