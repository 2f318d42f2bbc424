"""Known runs: inputs of a frame of a growing run."""

import tomllib

import numpy as np
import pytest
import whole_run
from firetwin.errors import UsageError
from firetwin.growing import follow, known_run
from firetwin.run import content, readers
from firetwin.shot.settings import scene_file

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
