"""Known runs: inputs of a frame of a growing run."""

import itertools
import tomllib
from dataclasses import fields, replace

import numpy as np
import pytest
import whole_run
from firetwin.errors import UsageError
from firetwin.growing import follow, known_run
from firetwin.run import content, readers
from firetwin.scene.forest import stand
from firetwin.shot import shot as shot_module
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import mesh_tolerance

SCENE = """\
run = "run"
[time]
{time}
frames = 4
[[cameras]]
name = "drone"
keys = [{{ latitude = 38.9, longitude = -120.6, {target} }}]
"""
FIXED = "target_latitude = 38.9, target_longitude = -120.61"


@pytest.fixture
def run(tmp_path):
    whole_run.write(tmp_path / "run", cells=16, times=(0.0, 600.0, 1200.0, 1800.0))
    return readers.open(tmp_path / "run")


def test_a_known_run_has_the_first_times_and_repeats_the_last(run, tmp_path):
    known_run.write(run, 2, 1500.0, tmp_path / "known", "film 1")
    shown = readers.open(tmp_path / "known")
    assert list(shown.times) == [0.0, 600.0, 1500.0]
    for index, same in ((0, 0), (1, 1), (2, 1)):
        np.testing.assert_array_equal(shown.heat_flux(index), run.heat_flux(same))
    arrival, all_times = shown.fuel_arrival_time(), run.fuel_arrival_time()
    np.testing.assert_array_equal(arrival, np.where(all_times <= 600.0, all_times, np.nan))
    assert 0 < np.isfinite(arrival).sum() < np.isfinite(all_times).sum()
    np.testing.assert_array_equal(shown.surface_fuel, run.surface_fuel)
    assert (content.identity(tmp_path / "known"), content.identity(tmp_path / "run")) == ("film 1", "")


def test_a_known_run_that_reaches_the_end_repeats_nothing(run, tmp_path):
    known_run.write(run, 3, 1200.0, tmp_path / "known", "film 1")
    assert list(readers.open(tmp_path / "known").times) == [0.0, 600.0, 1200.0]


def test_times_of_a_known_run_count_from_any_start(run, tmp_path):
    path = tmp_path / "run" / "run.toml"
    text = path.read_text()
    begin = text.index("times_s")
    path.write_text(
        text[:begin] + "times_s = [5e6, 5000600.0, 5001200.0, 5001800.0]\n" + text[text.index("vertical") :]
    )
    arrival = np.load(tmp_path / "run" / "fuel_arrival_time.npy").astype(np.float64)
    np.save(tmp_path / "run" / "fuel_arrival_time.npy", arrival + 5e6)
    shifted = readers.open(tmp_path / "run")
    known_run.write(shifted, 2, float(shifted.times[1]) + 60.0, tmp_path / "known", "film 1")
    shown = readers.open(tmp_path / "known")
    np.testing.assert_allclose(shown.times, [shifted.times[0], shifted.times[1], shifted.times[1] + 60.0])
    late = shifted.fuel_arrival_time()
    np.testing.assert_allclose(shown.fuel_arrival_time(), np.where(late <= shifted.times[1], late, np.nan))


def test_a_frame_needs_the_next_time():
    times = np.array([0.0, 600.0, 1200.0])
    needed = [
        known_run.next_time(times, moment, ended=False) for moment in (0.0, 599.0, 600.0, 1200.0, 1300.0)
    ]
    assert needed == [2, 2, 3, 0, 0]
    assert known_run.next_time(times, 1200.0, ended=True) == 3
    assert known_run.next_time(times, 1201.0, ended=True) == 0


def test_a_revision_stays_readable_after_watch_removed_it(tmp_path, monkeypatch):
    folder = tmp_path / "DIR"
    revision = follow.watched.revision_folder(folder, 1, 3)
    whole_run.write(revision, cells=8, times=(0.0, 600.0, 1200.0))
    monkeypatch.setattr(follow.watched, "newest", lambda _: revision)
    kept = follow._keep(folder, tmp_path / "revisions")
    before = readers.open(kept).heat_flux(2).copy()
    follow.shutil.rmtree(revision)
    np.testing.assert_array_equal(readers.open(kept).heat_flux(2), before)
    assert follow._keep(folder, tmp_path / "revisions") == kept


@pytest.fixture
def shared_aprons():
    """Compute aprons, as the product shares them between times."""


@pytest.fixture
def known(run, tmp_path):
    """Shots of one film with the first 2 and 3 times of a run."""
    shots = []
    for count in (2, 3):
        place = tmp_path / str(count) / "run"
        known_run.write(run, count, 1800.0, place, "film 1")
        scene = SCENE.format(time="end = 2020-07-01T20:20:00Z", target=FIXED).replace(
            '"run"', f'"{place.as_posix()}"'
        )
        (tmp_path / "scene.toml").write_text(scene)
        shots.append(ShotSource(scene=str(tmp_path / "scene.toml")).shot())
    return shots


def test_trees_and_ground_do_not_depend_on_later_times(known):
    before, after = (stand.grow(shot) for shot in known)
    assert len(before.position)
    for each in fields(before):
        np.testing.assert_array_equal(getattr(before, each.name), getattr(after, each.name))
    meshes = [mesh_tolerance.wanted(shot) for shot in known]
    np.testing.assert_array_equal(meshes[0].tolerance, meshes[1].tolerance)
    np.testing.assert_array_equal(meshes[0].fine, meshes[1].fine)


def test_a_film_computes_its_land_once_and_each_time_has_its_fire(known, monkeypatch):
    grounds = [shot.bare_ground for shot in known]
    assert grounds[0].fields is grounds[1].fields
    monkeypatch.setattr(content, "identity", lambda _: "")
    expected = Shot(known[1].settings, known[1].run).bare_ground
    assert expected.fields is not grounds[1].fields
    for name in ("arrival", "burn_time", "burned"):
        np.testing.assert_array_equal(getattr(grounds[1], name), getattr(expected, name))
        assert (getattr(grounds[0], name) != getattr(grounds[1], name)).any()


def test_what_a_film_keeps_is_computed_again_for_other_settings(known):
    numbers = itertools.count()
    other = known[0].with_settings(replace(known[0].settings, seed=7))
    found = [shot_module.cached_in_film("test", each, lambda: next(numbers)) for each in (*known, other)]
    assert found == [0, 0, 1]


def test_the_description_comes_back():
    table = {
        "name": 'a "b"',
        "times_s": [0.0, 1e6],
        "synthetic": True,
        "units": {"elevation": "m"},
        "no_data": -9,
    }
    assert tomllib.loads(known_run.format_toml(table)) == table
    assert tomllib.loads(known_run.format_toml({"source": {"files": ["a", "b"], "n": {"x": 1}}})) == {
        "source": {"files": ["a", "b"], "n": {"x": 1}}
    }


@pytest.mark.parametrize(
    ("time", "target", "reason"),
    [
        ("start = 2020-07-01T20:00:00Z", FIXED, "time.end"),
        ("end = 2020-07-01T20:20:00Z", 'target = "head"', "follows the fire"),
    ],
)
def test_a_scene_that_depends_on_later_times_is_refused(tmp_path, time, target, reason):
    (tmp_path / "scene.toml").write_text(SCENE.format(time=time, target=target))
    with pytest.raises(UsageError, match=reason):
        follow._check(scene_file.read(tmp_path / "scene.toml"))


def test_a_scene_with_fixed_cameras_is_followed(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE.format(time="end = 2020-07-01T20:20:00Z", target=FIXED))
    follow._check(scene_file.read(tmp_path / "scene.toml"))
