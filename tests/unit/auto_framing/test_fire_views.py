"""Views of each kind of fire: cameras on unburned ground, flames in the picture, and nothing before them."""

import functools
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import whole_run
from firetwin import cli
from firetwin.auto_framing import fire_views
from firetwin.auto_framing.fire_views import line_of_sight, local_fire, places, placing, search
from firetwin.run import readers, sun
from firetwin.scene.forest import stand
from firetwin.shot import run_checks
from firetwin.shot.fire import flame_map
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import coarse

EXAMPLES = Path(__file__).parents[3] / "examples" / "views"
DAY_AND_NIGHT = {"start": "2020-07-02T01:00:00Z", "times": tuple(1800.0 * np.arange(9))}  # 18:00 to 22:00
FIRES = {
    "grass": {"cell": 40.0, "cells": 100, "speed": 0.25, "surface": 0.4, **DAY_AND_NIGHT},
    "forest": {"cell": 80.0, "cells": 100, "speed": 0.7, "canopy": 0.4, "surface": 1.0, **DAY_AND_NIGHT},
}


@pytest.fixture(autouse=True, scope="module")
def few_places():
    """Try few places and cameras, grow plants near them, and solve smoke on wider cells: seconds in all."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(places, "_PLACES", 3)
        patch.setattr(placing, "_TRIED", 6)
        patch.setattr(placing, "_TRIED_IN", 20)
        patch.setattr(local_fire, "_WIDEST", 500.0)
        patch.setattr(local_fire, "_PIXELS", 356)
        patch.setattr(local_fire, "_PLANTS", (36.0, 700, 1_000_000))
        patch.setattr(search, "find_clip", functools.partial(search.find_clip, judged=1))
        patch.setattr(coarse, "COLUMNS", (600, 1200))
        patch.setattr(coarse, "_SPIN_UP", 0.3)
        patch.setattr(coarse, "LEAD", 100.0)
        yield


@pytest.fixture(scope="module")
def views_of(tmp_path_factory):
    """Views of one of FIRES by file name, and its run."""
    known = {}

    def find(name):
        if name not in known:
            folder = whole_run.write(tmp_path_factory.mktemp("views") / "run", **FIRES[name])
            views = fire_views.find_views(folder, folder.parent / "views", folder.parent / "cache")
            known[name] = {view.name: view for view in views}, readers.open(folder), folder.parent
        return known[name]

    return find


def _shots(views_of, name):
    """Shots of all views with fire, and the kind of fire of each."""
    views, run, folder = views_of(name)
    for view in views.values():
        if view.text:
            settings = scene_file.parse(view.text, folder / "views" / view.name)
            run_checks.check(settings, run)
            yield Shot(settings, run), view.name


@pytest.mark.parametrize("name", FIRES)
def test_a_run_has_views_of_the_fire_that_it_has_alone(views_of, name):
    views, _, _ = views_of(name)
    written = {key.split(".")[0].split("_")[1] for key, view in views.items() if view.text}
    assert written == ({"grass"} if name == "grass" else {"torching", "surface", "crown"})
    assert all("left out" in view.words for view in views.values() if not view.text)
    assert len(views) == 8


@pytest.mark.parametrize("name", FIRES)
def test_clips_are_in_real_time_by_the_light_that_their_names_say(views_of, name):
    for shot, file in _shots(views_of, name):
        assert shot.frames.step == pytest.approx(1.0 / 24.0)
        assert shot.frames.count == 96
        height = sun.position(shot.run, shot.frames.first)[1]
        assert height < -8.0 if "night" in file else height > 7.0


@pytest.mark.parametrize("name", FIRES)
def test_no_camera_is_where_it_burns_before_the_end_of_the_clip(views_of, name):
    for shot, _ in _shots(views_of, name):
        ground = shot.bare_ground
        for view in shot.paths:
            away = float(np.linalg.norm(view.position[0] - view.target[0]))
            turn = np.linspace(0.0, 2.0 * np.pi, 16)
            ring = view.position[0, :2] + min(0.2 * away, 30.0) * np.stack(
                [np.sin(turn), np.cos(turn)], axis=-1
            )
            arrival = ground.arrival_at(*ground.indices(*ground.geodetic(*ring.T)))
            assert (arrival > shot.frames.last).all()


@pytest.mark.parametrize("name", FIRES)
def test_flames_fill_a_third_to_a_half_of_the_picture_at_the_first_frame(views_of, name):
    """Unless the lens is at its limit."""
    for shot, file in _shots(views_of, name):
        ground = shot.bare_ground
        for view in shot.paths if "torching" not in file else ():
            line = np.linspace(-8.0, 8.0, 65) * (6.0 if "crown" in file else 1.0)
            place = view.target[0, :2] + np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
            height = flame_map.lengths(
                shot, place, *ground.indices(*ground.geodetic(*place.T)), shot.frames.first
            )
            away = float(np.linalg.norm(view.position[0] - view.target[0]))
            filled = np.percentile(height[height > 0.0], 90.0) / (2.0 * view.half[1] * away)
            limited = view.camera.rig.focal_length in placing._LENSES
            assert 0.3 < filled < 0.6 or limited  # the height is that of flames over a wider area


@pytest.mark.parametrize("name", FIRES)
def test_cameras_have_their_distances_and_look_up_from_eye_height_nearby(views_of, name):
    for shot, _ in _shots(views_of, name):
        for view in shot.paths:
            text = view.camera.name.split("_")[1]
            asked = float(text.removesuffix("km")) * 1e3 if "km" in text else float(text.removesuffix("m"))
            foot = view.target[0] - [0.0, 0.0, view.camera.rig.keys[0].target_height]
            assert np.linalg.norm(view.position[0] - foot) == pytest.approx(asked, rel=0.1, abs=1.0)
            above = view.position[0, 2] - shot.ground.up(*view.position[0, :2])[0]
            assert above == pytest.approx(view.camera.rig.keys[0].height, abs=0.3)
            assert asked > 40.0 or above < 2.0


def test_a_torching_crown_is_a_tree_that_the_camera_sees(views_of):
    for shot, file in _shots(views_of, "forest"):
        if "torching" in file:
            alone = shot.for_camera(shot.paths[0].camera.name).for_frames([1])
            away = np.hypot(*(stand.grow(alone).position[:, :2] - alone.paths[0].target[0, :2]).T)
            assert away.min() < 0.2


def test_cameras_are_not_in_the_lee(views_of):
    for shot, _ in _shots(views_of, "grass"):
        for view in shot.paths:
            side = (view.position[0] - view.target[0])[:2]
            assert side @ shot.wind <= 0.4 * np.hypot(*side) * np.hypot(*shot.wind)


def _trees(place, height, radius):
    place = np.atleast_2d(place)
    one = np.ones(len(place))
    return line_of_sight.Plants(place, height * one, radius * one, 0.1 * one, one, 0.1 * one, one, one)


@pytest.fixture(scope="module")
def ridge(tmp_path_factory):
    """Ground with a ridge of 80 m from south to north."""
    folder = tmp_path_factory.mktemp("ridge") / "run"
    whole_run.write(folder, cell=20.0, cells=40, height=lambda x, y: 80.0 * np.exp(-((x / 60.0) ** 2)))
    return places.survey(readers.open(folder), folder, folder.parent / "cache", (None, None)).ground


def _above(ground, *points):
    """Scene points (n, 3) at heights above the ground, m."""
    points = np.array(points, np.float64)
    return points + np.outer(ground.up(*points[:, :2].T), [0.0, 0.0, 1.0])


def test_a_tree_hides_what_is_behind_its_crown_and_not_what_is_over_or_beside_it(ridge):
    eye, *points = _above(
        ridge, (300, 0, 10), (300, 100, 5), (300, 100, 60), (330, 100, 5), (300, 30, 5), (300, 55, 0.1)
    )
    seen = line_of_sight.between_plants(eye, np.array(points), ridge, _trees([300.0, 50.0], 20.0, 4.0))
    assert seen.tolist() == [False, True, True, True, False]


def test_plants_away_from_the_lines_of_sight_hide_nothing(ridge, monkeypatch):
    """All trees of random woods are compared with those in a box along the lines."""
    rng = np.random.default_rng(1)
    low, high = [200.0, -100.0, 3.0], [400.0, 100.0, 9.0]
    woods = [_trees(rng.uniform(low[:2], high[:2], (60, 2)), 20.0, 3.0) for _ in range(20)]
    eyes = [_above(ridge, *rng.uniform(low, high, (2, 3))) for _ in woods]

    def seen():
        return [
            line_of_sight.between_plants(eye, point + 0.1 * np.arange(9.0)[:, None], ridge, wood)
            for wood, (eye, point) in zip(woods, eyes, strict=True)
        ]

    some = seen()
    monkeypatch.setattr(line_of_sight.Plants, "before", lambda self, *_: self)
    np.testing.assert_array_equal(some, seen())
    assert 0.1 < np.mean(some) < 0.9


def test_trees_that_are_cleared_around_a_camera_hide_nothing(ridge):
    eye, point = _above(ridge, (300, 0, 5), (300, 100, 5))
    near = replace(_trees([300.0, 20.0], 20.0, 4.0), near=np.array([stand.CLEARING]))
    assert line_of_sight.between_plants(eye, point[None], ridge, near)[0]
    assert not line_of_sight.between_plants(eye, point[None], ridge, replace(near, near=np.zeros(1)))[0]


def test_a_hill_hides_flames(ridge):
    low, high, flame = _above(ridge, (-200, 0, 2), (-200, 0, 200), (200, 0, 2))
    assert not line_of_sight.over_terrain(low, flame[None], ridge)[0]
    assert line_of_sight.over_terrain(high, flame[None], ridge)[0]


def test_new_writes_the_views_and_replaces_none(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    views = [
        fire_views.FireView("fire_grass.toml", "run = 1\n", "grass"),
        fire_views.FireView("fire_crown.toml", "", "no"),
    ]
    monkeypatch.setattr(fire_views, "find_views", lambda *_: iter(views))
    assert cli.main(["new", "run", "--views"]) == 0
    assert (tmp_path / "views" / "fire_grass.toml").read_text() == "run = 1\n"
    assert not (tmp_path / "views" / "fire_crown.toml").exists()
    assert capsys.readouterr().out.splitlines() == [str(Path("views/fire_grass.toml"))]
    (tmp_path / "views" / "fire_grass.toml").write_text("mine\n")
    assert cli.main(["new", "run", "--views"]) == 1
    assert "--overwrite" in capsys.readouterr().err
    assert (tmp_path / "views" / "fire_grass.toml").read_text() == "mine\n"
    assert cli.main(["new", "run", "--views", "views", "--overwrite"]) == 0


def test_the_examples_are_four_kinds_by_day_and_night():
    files = sorted(EXAMPLES.glob("fire_*.toml"))
    assert [file.name for file in files] == sorted(fire_views.names())
    for file in files:
        settings = scene_file.parse(file.read_text(), file)
        assert tomllib.loads(file.read_text())["run"] == "../out/sample"
        assert settings.time.resolved().end is not None
        assert all(camera.rig.validate() is None for camera in settings.cameras)


def test_the_near_view_is_of_the_tallest_kind_by_day_that_a_camera_sees(monkeypatch, tmp_path):
    tried = []

    def find_clip(survey, kind, light, judged):
        tried.append((kind.name, light.words, *kind.distances))
        return None

    run = readers.open(whole_run.write(tmp_path / "run", cells=8))
    monkeypatch.setattr(fire_views.places, "survey", lambda *_: None)
    monkeypatch.setattr(fire_views.search, "find_clip", find_clip)
    assert fire_views.find_near_view(run, tmp_path) is None
    by_day = [("crown", 400.0), ("torching", 150.0), ("surface", 60.0), ("grass", 20.0)]
    assert tried == [(name, light, away) for light in ("by day", "by night") for name, away in by_day]
