"""Settings that fit a run: the most active part of it, and cameras that show most of the front."""

import re
import zoneinfo
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest
import whole_run
from firetwin import auto_framing
from firetwin.auto_framing import (
    candidates,
    chase,
    coarse_smoke,
    flank,
    front,
    overview,
    visible_share,
    window,
)
from firetwin.run import readers, sun, times, zone
from firetwin.shot import run_checks
from firetwin.shot.cameras import targets
from firetwin.shot.cameras.rigs.chase import Chase
from firetwin.shot.sections import Time
from firetwin.shot.settings import Camera, Settings, scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import coarse, integrator, snapshots
from small_run import small_fields

HOURS = tuple(3600.0 * np.arange(0.0, 25.0, 6.0))


def hills(x, y):
    """Ridges 1.5 km apart and 600 m high, across the wind."""
    return 300.0 + 300.0 * np.cos(2.0 * np.pi * x / 1500.0) + 60.0 * np.cos(2.0 * np.pi * y / 900.0)


def basin(x, y):
    """A plain behind a wall 300 m high on the windward side."""
    return np.where((x < 100.0) & (x > -100.0), 300.0, 0.0)


FIRES = {
    "prescribed": {"cell": 5.0, "speed": 0.1, "canopy": 1.0},
    "grass": {"cell": 20.0, "cells": 150, "speed": 0.9},
    "hills": {"cell": 60.0, "cells": 120, "speed": 1.2, "height": hills, "canopy": 1.5},
    "basin": {"cell": 30.0, "speed": 0.2, "height": basin, "fires": ((300.0, 0.0, 0.0),), "cells": 100},
    "mega": {"cell": 1000.0, "cells": 140, "speed": 1.2, "times": HOURS},
    "calm": {"cell": 20.0, "wind": (0.0, 0.0)},
    "south": {"cell": 25.0, "at": (-42.7, 146.5), "wind": (-3.0, -3.0), "canopy": 0.8},
    "north begins": {"cell": 10.0, "at": (70.0, 25.0), "fires": ((0.0, 0.0, 3000.0),)},
    "line windless": {"cell": 25.0, "at": (-16.5, 179.999), "wind": None},
    "several": {
        "cell": 60.0,
        "cells": 150,
        "fires": ((-2500.0, -1500.0, 0.0), (2500.0, 2000.0, 900.0), (0.0, 3000.0, 1200.0)),
    },
    "ended": {"cell": 10.0, "cells": 40, "fires": ((0.0, 0.0, 0.0),), "times": (0.0, 3600.0, 86_400.0)},
    "slow output": {"cell": 300.0, "cells": 80, "times": HOURS, "arrival": False, "speed": 0.1},
}


@pytest.fixture(autouse=True, scope="module")
def few_candidates():
    """Solve the coarse flow on wider cells, and try fewer cameras, in a fraction of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(coarse, "COLUMNS", (600, 1200))
        patch.setattr(coarse, "_VOXELS", (1.0, 1.0))
        patch.setattr(coarse, "_SPIN_UP", 0.3)
        patch.setattr(coarse, "LEAD", 100.0)
        patch.setattr(flank, "_PLACES", 2)
        patch.setattr(chase, "_HEIGHTS", chase._HEIGHTS[::2])
        patch.setattr(chase, "_SIDES", chase._SIDES[::2])
        patch.setattr(overview, "_BEARINGS", overview._BEARINGS[::2])
        yield


@pytest.fixture(scope="module")
def fit_of(tmp_path_factory):
    """Settings fitted to one of FIRES, and its run."""
    known, runs = {}, {}

    def found(name):
        if name not in known:
            folder = whole_run.write(tmp_path_factory.mktemp("fitted") / "run", **FIRES[name])
            known[name] = auto_framing.fit_folder(
                folder, folder.parent / "scene.toml", folder.parent / "cache"
            )
            runs[name] = readers.open(folder)
        return known[name], runs[name]

    return found


@pytest.mark.parametrize("name", FIRES)
def test_each_camera_shows_at_least_half_of_the_front_it_films(fit_of, name):
    found, run = fit_of(name)
    run_checks.check(found.settings, run)
    assert list(found.shares) == ["overview", "chase", "flank", "satellite"]
    assert min(found.shares.values()) >= candidates.LEAST, found.lines


@pytest.mark.parametrize("name", ["prescribed", "hills", "mega", "several"])
def test_what_is_said_to_show_is_what_the_shot_sees(fit_of, name):
    """Over its own ground, with detail near cameras, by the views that everything else is skipped by."""
    found, run = fit_of(name)
    for camera in ("overview", "satellite"):
        shot = Shot(found.settings, run).for_camera(camera)
        points = front.find_front(shot).point
        seen = shot.visibility.visible_mask(points, 1.0, pixel=np.inf)
        assert seen.mean() >= max(found.shares[camera] - 0.02, candidates.LEAST)


@pytest.mark.parametrize("name", FIRES)
def test_the_overview_has_the_whole_front_in_its_picture_and_the_horizon_over_it(fit_of, name):
    found, run = fit_of(name)
    shot = Shot(found.settings, run)
    moving, view = front.find_front(shot), shot.for_camera("overview").paths[0]
    local = (moving.point - view.position[0]) @ view.rotation[0]
    x, y = (local[:, axis] / -local[:, 2] / view.half[axis] for axis in (0, 1))
    assert (local[:, 2] < 0.0).all()
    assert np.mean((np.abs(x) < 0.95) & (np.abs(y) < 0.97)) > 0.95
    assert -0.6 < np.median(y) < 0.1, "below the middle, under its smoke"
    horizon = np.tan(np.arcsin(-view.rotation[0][2, 2] * -1.0)) / view.half[1]
    assert horizon > 0.1
    assert view.position[0, 2] > shot.ground.up(*view.position[0, :2])[0]


def test_the_overview_stands_to_windward_with_the_sun_behind_it(fit_of):
    fit, run = fit_of("grass")  # wind from the west, and the sun in the south-west
    shot = Shot(fit.settings, run)
    way = candidates.bearing(shot.for_camera("overview").paths[0]) % 360.0
    assert 200.0 < way < 320.0
    assert "windward" in fit.cameras["overview"]
    fit, run = fit_of("calm")  # there smoke on these wide cells decides, so the preference alone is tested
    moving = front.find_front(Shot(fit.settings, run))
    way = max(overview._BEARINGS, key=lambda bearing: candidates.liking(moving, bearing))
    azimuth, height = sun.position(run, 0.0)
    assert height > 0.0
    assert np.cos(np.radians(way - azimuth)) > 0.5


def test_a_wall_before_the_fire_moves_the_camera(fit_of):
    """From the west, from where the wind comes and the camera would be low, a wall hides the fire."""
    walled, run = fit_of("basin")
    moving = front.find_front(Shot(walled.settings, run))
    low = overview._camera(moving, moving.point, 270.0, 13.0)
    assert visible_share.Visible(moving).seen(candidates.path(moving, low)).share < candidates.LEAST
    assert walled.shares["overview"] >= candidates.LEAST


def test_coarse_smoke_drifts_with_the_wind(fit_of):
    """Columns over ground to leeward and to windward of the fire."""
    found, run = fit_of("grass")  # wind from the west
    moving = front.find_front(Shot(found.settings, run))
    middle = np.array([*0.5 * (moving.low + moving.high), 10.0])
    lee, luv = (middle + side * moving.size * np.array([0.8, 0.0, 0.0]) for side in (1.0, -1.0))
    high = np.array([0.0, 0.0, 2.0 * moving.size])
    assert moving.smoke.depth(2, lee + high, lee[None])[0] > 1.0
    assert moving.smoke.depth(2, luv + high, luv[None])[0] < 0.01


def test_coarse_smoke_and_its_nest_have_the_heat_and_smoke_of_the_fire(fit_of, monkeypatch):
    """The heat once stayed at the tenth of the first seconds, and the nest had none: smoke did not rise."""
    found, run = fit_of("grass")
    shot, given, save = Shot(found.settings, run), [], snapshots.save

    def note(path, solver, drift):
        given.append((solver.mass()["emitted"], solver.heat()["given"]))
        save(path, solver, drift)

    monkeypatch.setattr(coarse_smoke.snapshots, "save", note)
    coarse_smoke.CoarseSmoke(shot, [0])
    fire = shot.fire.sources(shot.frames.first)
    lead = shot.scale.time(coarse.LEAD)
    (_, _), (smoke, heat) = given
    assert smoke == pytest.approx(lead * fire.smoke.sum(), rel=0.3)
    assert heat == pytest.approx(integrator.CONVECTED * lead * fire.power.sum(), rel=0.3)


def tried(share=1.0, clear=1.0, veil=0.0, liking=0.0):
    return candidates.Tried(visible_share.VisibleShare(share, clear, veil, -0.2, 0.5), liking, None)


def test_a_clear_view_is_preferred_to_one_with_the_sun_behind_it():
    smoky, clear = tried(clear=0.01, liking=1.0), tried(clear=0.6, liking=-1.0)
    assert candidates.best([smoky, clear]) is clear
    veiled = tried(clear=0.9, veil=0.95, liking=1.0)
    assert candidates.best([veiled, tried(clear=0.6)]) is not veiled
    liked = tried(clear=0.7, liking=0.3)
    assert candidates.best([liked, tried(clear=0.95)]) is liked, "both are clear enough"
    occluded = tried(share=0.2, liking=1.0)
    assert candidates.best([occluded, smoky]) is smoky


def test_a_camera_in_smoke_goes_farther():
    asked = []

    def at(distance):
        asked.append(distance)
        return [tried(clear=0.8, veil=0.0 if distance > 150.0 else 0.6)]

    assert candidates.nearest_enough(100.0, at).seen.veil == 0.0
    assert asked == [100.0, 200.0]


@pytest.fixture
def county(tmp_path):
    """Write a shot of a run of 10 km cells, with the window that suits it."""
    times = tuple(3600.0 * np.arange(25.0))
    options = {"cell": 10_000.0, "cells": 10, "speed": 1.0, "lasts": 3600.0, "arrival": False}
    run = readers.open(whole_run.write(tmp_path / "run", times=times, **options))
    return Shot(Settings(path=tmp_path / "scene.toml", time=window.choose(run, Time())[0]), run)


def test_in_smoke_on_vast_cells_cameras_still_stand_over_the_ground(county, monkeypatch):
    """Smoke made the flank camera go 123 km away, where `render` refused it."""
    monkeypatch.setattr(flank, "_PLACES", 1)
    share = visible_share.VisibleShare(0.9, 0.05, 1.0, -0.2, 0.5)
    monkeypatch.setattr(visible_share.Visible, "seen", lambda *given: share)
    moving = front.find_front(county)
    placed = [each.place(moving, visible_share.Visible(moving)).camera for each in (overview, flank)]
    run_checks.check(replace(county.settings, cameras=tuple(placed)), county.run)
    for camera in placed:
        assert candidates.is_over_ground(moving, candidates.path(moving, camera))


def test_a_camera_that_has_no_ground_below_it_anywhere_is_left_out(county, monkeypatch):
    moving = front.find_front(county)
    monkeypatch.setattr(candidates, "is_over_ground", lambda *given: False)
    for kind in (chase, flank):
        assert kind.place(moving, visible_share.Visible(moving)) is None


def test_a_scene_of_vast_cells_has_no_smoke(county):
    found = auto_framing.fit(county.run, county.settings)
    assert not found.settings.smoke.enabled
    assert found.window.endswith("no smoke, as the fuel cells resolve no plume")
    assert "enabled = false" in found.text
    run_checks.check(found.settings, county.run)


def test_a_film_of_vast_cells_lasts_until_the_front_has_moved(county):
    assert county.frames.last - county.frames.first == pytest.approx(3600.0, abs=1.0)


def test_smoke_on_all_sides_is_said_plainly():
    assert "from every side" in candidates.shows(tried(clear=0.1).seen, "the front")
    assert "from every side" not in candidates.shows(tried(clear=0.7).seen, "the front")


def test_a_head_that_smoke_hides_is_left_for_a_flank(fit_of, monkeypatch):
    fit, run = fit_of("grass")
    moving = front.find_front(Shot(fit.settings, run))
    share = visible_share.VisibleShare(0.9, 0.05, 0.0, -0.2, 0.5)
    monkeypatch.setattr(visible_share.Visible, "seen", lambda *given: share)
    assert chase.place(moving, visible_share.Visible(moving)).words.startswith("goes along with the head")
    flanks = tried(clear=0.7)._replace(camera=fit.settings.cameras[2])
    monkeypatch.setattr(flank, "tried", lambda *given: [flanks])
    placed = chase.place(moving, visible_share.Visible(moving))
    assert "smoke hides the head" in placed.words
    assert placed.camera.name == "chase"
    assert placed.camera.rig == fit.settings.cameras[2].rig


def test_a_chase_of_a_small_fire_stays_as_low_as_it_says(fit_of):
    found, run = fit_of("prescribed")  # flat ground
    moving = front.find_front(Shot(found.settings, run))
    camera = Camera("chase", rig=Chase(distance=80.0, height=24.0, target_height=9.6, clearance=12.0))
    view = candidates.path(moving, camera)
    assert view.position[:, 2] == pytest.approx(24.0, abs=1.0)


def test_the_satellite_has_the_fire_in_its_middle(fit_of):
    for name in ("grass", "several", "south"):
        found, run = fit_of(name)
        shot = Shot(found.settings, run)
        moving, view = front.find_front(shot), shot.for_camera("satellite").paths[0]
        off = np.abs(view.position[0, :2] - 0.5 * (moving.low + moving.high))
        assert (off < 0.02 * moving.size).all()
        assert (moving.high - moving.low < view.half).all(), "half of the picture at most"


def test_cameras_are_as_large_as_the_fire(fit_of):
    small, large = fit_of("prescribed")[0], fit_of("mega")[0]
    distance = {
        each: [
            np.linalg.norm(
                (view := candidates.path(front.find_front(Shot(fit.settings, run)), camera)).position
                - view.target,
                axis=1,
            ).mean()
            for camera in fit.settings.cameras[:3]
        ]
        for each, (fit, run) in (("small", fit_of("prescribed")), ("large", fit_of("mega")))
    }
    assert distance["small"][0] < 700.0
    assert distance["large"][0] > 30_000.0
    assert (np.array(distance["large"]) > 2.5 * np.array(distance["small"])).all()
    assert small.settings.cameras[3].rig.swath < 1500.0
    assert large.settings.cameras[3].rig.swath > 50_000.0


@pytest.mark.parametrize("name", FIRES)
def test_no_window_of_the_run_is_more_active(fit_of, name):
    found, run = fit_of(name)
    time = found.settings.time
    first, last = float(run.times[0]), float(run.times[-1])
    begin, end = ((moment - _start(run)).total_seconds() for moment in (time.start, time.end))
    assert first <= begin < end <= last
    arrival = run.fuel_arrival_time()
    arrival = arrival[(arrival >= first) & (arrival <= last)]
    held = np.count_nonzero((arrival >= begin) & (arrival <= end))
    length = end - begin
    others = np.arange(first, last - length, 60.0)
    counts = [np.count_nonzero((arrival >= other) & (arrival <= other + length)) for other in others]
    assert held >= max(counts, default=0)


def _start(run):
    from firetwin.run import times

    return times.utc(run, 0.0)


def test_cameras_are_placed_for_a_window_that_is_asked_for(fit_of):
    fit, run = fit_of("grass")
    start, end = _start(run) + timedelta(minutes=10), _start(run) + timedelta(minutes=15)
    path, folder = fit.settings.path, Path(run.path)
    early = auto_framing.fit_folder(folder, path, fit.settings.cache, Time(start, end))
    assert (early.settings.time.start, early.settings.time.end) == (start, end)
    assert early.settings.time.frames == fit.settings.time.frames
    assert "as asked; 48 frames, 76.6 times" in early.window
    _, words = window.choose(run, Time(start, end, frames=25, fps=24.0))
    assert words.endswith("as asked; 25 frames, 300 times real time")
    assert early.settings.cameras != fit.settings.cameras
    assert min(early.shares.values()) >= candidates.LEAST


def test_a_run_of_one_moment_is_a_still(make_run):
    whole = small_fields()
    folder = make_run(**{name: values[2:] for name, values in whole.items() if values.ndim == 3})
    found = auto_framing.fit_folder(folder, folder.parent / "scene.toml", folder.parent / "cache")
    assert found.settings.time.frames == 1
    run_checks.check(found.settings, readers.open(folder))
    assert "one moment" in found.window


def test_a_window_is_where_the_fuel_burns_not_where_the_area_grows():
    arrival = np.array([10.0] * 50 + [5000.0] * 10)
    fuel = np.array([0.1] * 50 + [5.0] * 10)

    def most_active(arrival, fuel):
        begins, reached = window.activity(arrival, fuel, 0.0, 7200.0, 600.0)
        return begins[window.best(reached)]

    begin = most_active(arrival, fuel)
    assert begin <= 5000.0 <= begin + 600.0
    assert most_active(arrival, np.ones(60)) == 0.0
    at_once = most_active(np.full(5, 1000.0), np.ones(5))
    assert at_once == 960.0, "the last window with the fire, which burns from its first minute"


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (0.8, "by daylight: .*; by night, 2020-.* has 1[.].* times the fuel"),
        (0.2, r"the most active 20 s: .*; by night: daylight with the most fire \(.* %\) begins at 2020-"),
        (0.0, "the most active 20 s: .*; by night, and nothing burns by daylight"),
    ],
)
def test_of_nearly_equally_active_windows_one_by_daylight_is_filmed(fit_of, monkeypatch, share, words):
    """The fire grows: the sun sets when a share of its largest activity is reached."""
    _, run = fit_of("grass")
    row, column, fuel = window._burned(run, run.fuel_arrival_time())
    came, last = run.fuel_arrival_time()[row, column], float(run.times[-1])
    begins, reached = window.activity(came, fuel, float(run.times[0]), last, 19.6)
    sunset = begins[np.flatnonzero(reached >= share * reached.max())[0]] if share else -1e6
    monkeypatch.setattr(window.sun, "position", lambda run, time: (180.0, sunset + 20.0 - time))
    chosen, text = window.choose(run, Time())
    assert re.search(words, text), text
    assert (times.seconds(run, chosen.start) <= sunset + 20.0) == (share > window.NEARLY)


def test_a_film_is_at_most_15_times_real_time_and_slower_of_a_small_fire(fit_of):
    film = (window.FRAMES - 1) / window.FPS
    assert window.length(29_000.0, 1e5) == pytest.approx(15.0 * film)
    assert window.length(1500.0, 1e5) == pytest.approx(15.0 * 0.1 ** (2 / 3) * film)
    assert window.length(10.0, 1e5) == pytest.approx(film)
    assert window.length(29_000.0, 20.0) == 20.0
    found, run = fit_of("mega")
    assert Shot(found.settings, run).speed == pytest.approx(15.0)
    assert "the most active 59 s" in found.window
    assert found.window.endswith("48 frames, 15 times real time")


def test_the_head_moves_evenly_with_the_wind_in_a_short_film(fit_of):
    found, run = fit_of("grass")
    shot = Shot(found.settings, run)
    track = targets.follow("head", shot.bare_ground, shot.frames.times, 0.0)[:, :2]
    steps = np.diff(track, axis=0) / shot.frames.step
    assert np.abs(steps - steps[0]).max() < 1e-6
    assert 0.3 < steps[0, 0] < 2.0, "0.9 m/s at its fastest, to the east"
    assert abs(steps[0, 1]) < 0.3 * steps[0, 0]


@pytest.mark.parametrize("name", FIRES)
def test_the_file_reads_back_as_the_settings(fit_of, name):
    found, _ = fit_of(name)
    path = found.settings.path
    path.write_text(found.text, encoding="utf-8")
    assert scene_file.read(path) == found.settings


def test_the_file_is_short_and_every_key_in_it_is_explained(fit_of):
    fit, _ = fit_of("grass")
    lines = fit.text.splitlines()
    assert len(lines) < 90
    assert max(map(len, lines)) <= 130
    explained = {line.split(" = ")[0] for line in lines if " = " in line and "  # " in line}
    assert {line.split(" = ")[0] for line in lines if " = " in line and line[0] != "#"} == explained
    assert {"start", "end", "frames", "fps", "method", "samples", "resolution"} <= explained
    assert "apron" not in explained, "nobody has to know"
    for camera, words in fit.cameras.items():
        above = fit.text.split(f'name = "{camera}"')[0].split("[[cameras]]")[-2].split("\n\n")[-1]
        assert " ".join(above.replace("# ", "").split()).lower() == f"{words}.".lower()


def test_a_run_that_burns_nothing_is_seen_whole(make_run):
    folder = make_run(fuel_arrival_time=np.full((8, 10), np.nan, np.float32))
    found = auto_framing.fit_folder(folder, folder.parent / "scene.toml", folder.parent / "cache")
    run = readers.open(folder)
    run_checks.check(found.settings, run)
    assert list(found.cameras) == ["overview", "satellite"]
    view = Shot(found.settings, run).for_camera("overview").paths[0]
    corners = Shot(found.settings, run).ground.point(run.latitude[[0, -1]], run.longitude[[0, -1]])
    local = (corners - view.position[0]) @ view.rotation[0]
    assert (np.abs(local[:, 0] / -local[:, 2]) < view.half[0]).all()


def test_a_fire_that_is_over_is_seen_from_afar_alone(tmp_path):
    folder = whole_run.write(tmp_path / "run", **FIRES["grass"])
    for name, change in (("fuel_arrival_time", lambda values: values - 1e5), ("heat_flux", np.zeros_like)):
        np.save(folder / f"{name}.npy", change(np.load(folder / f"{name}.npy")))
    found = auto_framing.fit_folder(folder, tmp_path / "scene.toml", tmp_path / "cache")
    assert list(found.cameras) == ["overview", "satellite"]
    assert "nothing burns" in found.window


@pytest.mark.parametrize(
    ("longitude", "name", "hours"),
    [(9.0, "Etc/GMT-1", 1), (-120.0, "Etc/GMT+8", -8), (0.0, "Etc/GMT", 0), (179.9, "Etc/GMT-12", 12)],
)
def test_a_fire_is_told_in_the_time_of_its_place(tmp_path, longitude, name, hours):
    run = readers.open(whole_run.write(tmp_path / "run", cells=8, at=(42.0, longitude)))
    assert zone.time_zone(run) == name
    assert zoneinfo.ZoneInfo(name).utcoffset(None).total_seconds() == 3600.0 * hours


def test_a_known_fire_is_told_in_its_own_zone(make_run):
    assert zone.time_zone(readers.open(make_run())) == "America/Los_Angeles"
