"""Visits of places: which samples share a scene, and what the shot of a sample takes from its draw."""

import dataclasses

import numpy as np
import pytest
import small_plan
from firetwin.dataset import places
from firetwin.dataset.draws import Drawer
from firetwin.run import sun
from firetwin.shot.cameras import rotation


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    small_plan.write_run(folder / "a")
    return small_plan.plan(folder=folder, moments=2, count=40)


@pytest.fixture(scope="module")
def drawn(plan):
    drawer = Drawer(plan)
    return [drawer.draw(index) for index in range(1, plan.count + 1)]


def test_samples_of_one_run_and_moment_share_a_visit(drawn):
    visits = places.visits(drawn)
    assert sorted(each.index for visit in visits for each in visit.draws) == list(range(1, len(drawn) + 1))
    for visit in visits:
        assert len({(each.run, each.moment) for each in visit.draws}) == 1
        assert len(visit.draws) <= places.MEMBERS
    assert len(visits) < len(drawn) / 3


def test_visits_do_not_depend_on_the_order_of_the_draws(drawn):
    assert places.visits(drawn[::-1]) == places.visits(drawn)


@pytest.mark.parametrize("count", [1, 12, 13, 30])
def test_a_large_visit_is_divided_evenly(drawn, count):
    alike = [dataclasses.replace(drawn[0], index=number) for number in range(1, count + 1)]
    sizes = [len(visit.draws) for visit in places.visits(alike)]
    assert sum(sizes) == count
    assert max(sizes) <= places.MEMBERS
    assert max(sizes) - min(sizes) <= 1


def test_the_shot_of_a_sample_has_its_camera_air_and_time(plan, drawn):
    visit = next(each for each in places.visits(drawn) if each.has_fire and len(each.draws) > 1)
    shared = places.shot_of_visit(plan, visit)
    for draw in visit.draws[:2]:
        shot = places.shot_of_sample(shared, draw)
        (view,) = shot.paths
        assert view.camera.name == draw.name
        np.testing.assert_allclose(view.position[0], draw.camera.position)
        angles = rotation.angles(shot.local_frame, view.position[0], view.rotation[0])
        assert angles[1] == pytest.approx(draw.camera.tilt, abs=1e-6)
        across = 2.0 * np.degrees(np.arctan(view.half[0]))
        assert across == pytest.approx(draw.camera.field_of_view)
        assert shot.frames.times == pytest.approx([draw.time], abs=1e-5)
        assert shot.fire is shared.fire
        assert shot.ground is shared.ground
    assert len({places.shot_of_sample(shared, each).settings.light.haze for each in visit.draws}) > 1


def test_the_sun_is_fixed_inside_the_block_alone(plan, drawn):
    run = Drawer(plan).scene("a").run
    before = sun.position(run, 0.0)
    with sun.fixed(120.0, -3.0):
        assert sun.position(run, 0.0) == (120.0, -3.0)
        assert sun.moon(run, 0.0) == sun.NO_MOON
        with sun.fixed(10.0, 5.0):
            assert sun.position(run, 900.0) == (10.0, 5.0)
        assert sun.position(run, 900.0) == (120.0, -3.0)
    assert sun.position(run, 0.0) == before
