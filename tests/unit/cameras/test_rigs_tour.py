"""The tour: it stops where it should, looks there, keeps above the ground and flies without jumps."""

from dataclasses import replace

import numpy as np
import pytest
import sample_evening
from firetwin.errors import InputError
from firetwin.shot import run_checks
from firetwin.shot.cameras import flight, path, targets
from firetwin.shot.cameras.rigs.tour import Stop, Tour, shares
from firetwin.shot.settings import Camera, scene_file
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis
from hypothesis import strategies as st
from hypothesis_profiles import examples
from sample_evening import *  # noqa: F403

STOPS = (Stop("Pollock Pines"), Stop("ignition", height=900.0), Stop("head", distance=3000.0))


@pytest.fixture(scope="module")
def whole(run):
    """The evening, whose terrain and fire all shots share."""
    return sample_evening.shot_of(run, Camera("round", Tour(stops=STOPS)))


def shot_of(whole, frames=48, **tour):
    settings = replace(
        whole.settings,
        time=replace(whole.settings.time, frames=frames),
        cameras=(Camera("round", Tour(**({"stops": STOPS} | tour))),),
    )
    return whole.with_settings(settings)


def at(latitude, longitude, **more):
    return Stop(latitude=latitude, longitude=longitude, **more)


@given(
    st.integers(1, 400),
    st.lists(st.tuples(st.floats(0, 50), st.floats(0.01, 50)), min_size=1, max_size=8),
)
@hypothesis(deadline=None, max_examples=examples(200))
def test_the_frames_are_divided_among_the_stops(frames, times):
    share = shares([Stop(stay=stay, travel=travel) for stay, travel in times], frames)
    assert share.shape == (frames, len(times))
    assert share.sum(axis=1) == pytest.approx(1.0)
    assert ((share > 0.0).sum(axis=1) <= 2).all()
    there = share == 1.0
    assert there[:, : min(frames, len(times))].any(axis=0).all(), "each stop has a frame"
    order = np.argmax(share, axis=1)
    assert (np.diff(order) >= 0).all()
    assert there[0, 0]
    assert there[-1, min(frames, len(times)) - 1]


def test_times_are_shares_of_the_film():
    """Stays of 2 and 1 s around a flight of 3 s, in 61 frames."""
    share = shares([Stop(stay=2.0, travel=3.0), Stop(stay=1.0)], 61)
    assert np.flatnonzero(share[:, 0] == 1.0).tolist() == list(range(21))
    assert np.flatnonzero(share[:, 1] == 1.0).tolist() == list(range(50, 61))
    assert share[35, 0] == pytest.approx(0.5)


def test_it_stands_at_each_stop_and_looks_there(whole):
    shot = shot_of(whole, over_ridges=False)
    (view,) = shot.paths
    share = shares(STOPS, 48)
    east, north = targets.ignition(shot.ground)
    head = targets.follow("head", shot.ground, shot.frames.times, 0.0)
    town = shot.ground.point(38.7613, -120.5863)[0]
    for j, place in enumerate([town, np.array([east, north, 0.0]), head]):
        there = share[:, j] == 1.0
        goal = np.broadcast_to(place, (48, 3))[there]
        away = np.linalg.norm(view.position[there][:, :2] - goal[:, :2], axis=1)
        assert away == pytest.approx(
            STOPS[j].distance, abs=400.0 if j == 0 else 1.0
        )  # of the town's own place
        local = np.einsum("nij,ni->nj", view.rotation[there], view.target[there] - view.position[there])
        assert local[:, :2] == pytest.approx(0.0, abs=1e-6)
        assert (local[:, 2] < 0.0).all()
        assert view.rotation[there][:, 2, 0] == pytest.approx(0.0), "the horizon is level"
        above = view.position[there][:, 2] - shot.ground.up(*view.position[there][:, :2].T)
        assert (above > (0.5 if j == 2 else 0.999) * STOPS[j].height).all()  # smoothed above the head


def test_without_a_bearing_it_comes_from_the_stop_before(whole):
    """Three stops to the east: the camera stands west of each and looks on along its way."""
    stops = tuple(at(38.9, -120.6 + 0.05 * k) for k in range(3))
    (view,) = shot_of(whole, stops=stops).paths
    assert (view.target[:, 0] - view.position[:, 0] > 1490.0).all()
    turned = (stops[0], replace(stops[1], bearing=90.0), stops[2])
    share = shares(turned, 48)
    (view,) = shot_of(whole, stops=turned).paths
    there = share[:, 1] == 1.0
    assert (view.position - view.target)[there][:, 0] == pytest.approx(1500.0, abs=1.0)


places = st.builds(
    at,
    st.floats(38.75, 39.05),
    st.floats(-120.75, -120.35),
    stay=st.floats(0, 5),
    travel=st.floats(2, 5),
    distance=st.floats(100, 5000),
    height=st.floats(10, 2000),
    bearing=st.none() | st.floats(0, 360),
)


@given(st.lists(places, min_size=1, max_size=4), st.floats(0, 300), st.booleans(), st.booleans())
@hypothesis(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=examples(20)
)
def test_it_never_comes_below_its_clearance_and_passes_every_stop(whole, stops, clearance, over, head):
    stops = (*stops, Stop("head")) if head else tuple(stops)
    shot = shot_of(whole, frames=240, stops=stops, clearance=clearance, over_ridges=over)
    (view,) = shot.paths
    assert flight.short(shot.ground, view.position, np.full(240, clearance)).max() <= 0.01
    share = shares(stops, 240)
    for j, stop in enumerate(stops):
        there = np.flatnonzero(share[:, j] == 1.0)
        away = np.linalg.norm((view.position - view.target)[there][:, :2], axis=1)
        assert away == pytest.approx(stop.distance, abs=0.01)
        if not stop.place:
            goal = shot.ground.point(stop.latitude, stop.longitude)[0]
            assert view.target[there] == pytest.approx(np.repeat(goal[None], len(there), 0), abs=0.01)
    speed = np.diff(view.position, axis=0)
    jump = np.linalg.norm(np.diff(speed, axis=0), axis=1).max(initial=0.0)
    assert jump <= 0.35 * np.linalg.norm(speed, axis=1).max() + 0.01


def test_it_rises_until_no_ridge_hides_a_place(whole):
    """From low in a canyon; the flight between needs no view."""
    stops = (at(38.95, -120.55, height=20.0, distance=4000.0, bearing=120.0), at(38.99, -120.5))
    shot = shot_of(whole, stops=stops, over_ridges=False)
    (low,), (high,) = shot.paths, shot_of(whole, stops=stops, over_ridges=True).paths
    assert low.hidden[0] > 10.0
    assert path.hidden(shot.ground, high.position, high.target)[0] == pytest.approx(0.0, abs=1e-6)
    assert low.hidden[shares(stops, 48).max(axis=1) < 1.0].max() == 0.0


def test_it_works_with_fewer_frames_than_stops(whole):
    for frames in (1, 2):
        (view,) = shot_of(whole, frames=frames).paths
        assert np.isfinite(view.position).all()


SCENE = (
    '[time]\nframes = {frames}\n[[cameras]]\nkind = "tour"\nname = "round"\n{more}[[cameras.stops]]\n{stop}\n'
)


@pytest.mark.parametrize(
    ("stop", "frames", "line", "words"),
    [
        ('place = "Polock Pines"', 4, 7, 'an unknown place; did you mean "Pollock Pines"?'),
        ('place = "Atlantis"', 4, 7, "an unknown place; it knows head, ignition, "),
        ('place = "head"\n[[cameras.stops]]\nplace = "head"', 1, 6, "has 2 stops in 1 frames"),
        ("latitude = 12.0\nlongitude = 3.0", 4, 7, "km from the middle of the run"),
    ],
)
def test_a_stop_that_the_run_has_not_is_told(run, tmp_path, stop, frames, line, words):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(stop=stop, frames=frames, more=""))
    with pytest.raises(InputError) as caught:
        run_checks.check(scene_file.read(scene), run)
    assert words in str(caught.value)
    assert caught.value.line == line


@pytest.mark.parametrize(
    ("stop", "words"),
    [
        ('place = "head"\nlatitude = 38.9', "has a stop with a place and a position"),
        ("latitude = 38.9", "has a stop without a place"),
    ],
)
def test_a_stop_has_a_name_or_a_position(tmp_path, stop, words):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(stop=stop, frames=4, more=""))
    with pytest.raises(InputError, match=words):
        scene_file.read(scene)


def test_names_come_from_a_file_and_far_ones_are_told(run, tmp_path):
    (tmp_path / "places.csv").write_text("name,latitude,longitude\nTower,38.9,-120.6\nFar,10.0,10.0\n")
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(stop='place = "tower"', frames=4, more='places = "places.csv"\n'))
    settings = scene_file.read(scene)
    run_checks.check(settings, run)
    assert settings.cameras[0].rig.input_files() == [tmp_path / "places.csv"]
    scene.write_text(SCENE.format(stop='place = "far"', frames=4, more='places = "places.csv"\n'))
    with pytest.raises(InputError, match="km from the middle of the run"):
        run_checks.check(scene_file.read(scene), run)
