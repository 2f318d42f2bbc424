"""The orbit, against the circle that it has to be."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from filmed import LEVEL, film
from firetwin.run import opening as runs
from firetwin.shot.cameras.rigs.orbit import Orbit
from firetwin.shot.settings import Camera
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis
from hypothesis import strategies as st
from hypothesis_profiles import examples

ORBIT = Orbit(latitude=38.905, longitude=-120.592, radius=400.0, height=300.0, speed=5.0, bearing=90.0)


@pytest.fixture
def orbit(make_run):
    """The path of an orbit with other settings, 5 frames over two minutes of a run on level ground."""
    run = runs.open(make_run(**LEVEL))

    def path(**changes):
        start = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
        shot = film(run, Camera("round", replace(ORBIT, **changes)), apron=0.0, start=start, frames=5)
        return shot, shot.paths[0]

    return path


def test_it_begins_at_its_bearing_and_goes_on_at_its_speed(orbit):
    shot, path = orbit()
    point = shot.ground.point(38.905, -120.592)[0]
    away = path.position - point
    assert away[0] == pytest.approx([400.0, 0.0, 300.0], abs=0.1)  # in the east
    assert np.hypot(away[:, 0], away[:, 1]) == pytest.approx(400.0)
    way = np.unwrap(np.arctan2(away[:, 0], away[:, 1])) * 400.0  # clockwise from north
    assert way - way[0] == pytest.approx(5.0 * (shot.frames.times - shot.frames.times[0]))


def test_it_looks_at_the_point_with_a_level_horizon(orbit):
    shot, path = orbit(target_height=40.0)
    point = shot.ground.point(38.905, -120.592)[0] + [0.0, 0.0, 40.0]
    local = np.einsum("nij,ni->nj", path.rotation, point - path.position)
    assert local[:, :2] == pytest.approx(0.0, abs=1e-6)
    assert (local[:, 2] < 0.0).all()
    assert path.rotation[:, 2, 0] == pytest.approx(0.0)


def test_without_a_place_it_circles_the_middle_of_the_run(orbit):
    shot, path = orbit(latitude=None, longitude=None)
    assert path.target[0][:2] == pytest.approx([0.0, 0.0], abs=1.0)
    assert shot.camera("round").rig.coordinates() == []


@given(st.floats(-50, 50), st.floats(10, 5000), st.floats(1, 3000), st.floats(-720, 720), st.floats(0, 500))
@hypothesis(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=examples(25)
)
def test_it_keeps_its_distance_and_its_clearance(orbit, speed, radius, height, bearing, clearance):
    changes = {"speed": speed, "radius": radius, "height": height, "bearing": bearing}
    shot, path = orbit(**changes, clearance=clearance)
    away = path.position - shot.ground.point(38.905, -120.592)[0]
    assert np.hypot(away[:, 0], away[:, 1]) == pytest.approx(radius)
    above = path.position[:, 2] - shot.ground.up(path.position[:, 0], path.position[:, 1])
    assert (above >= clearance - 0.01).all()
