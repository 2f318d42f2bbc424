"""Cameras by poses: angles and places there and back, few keys for a flown way, and their path."""

from dataclasses import replace

import numpy as np
import pytest
from filmed import film
from firetwin.geometry import quaternion
from firetwin.run import opening as runs
from firetwin.shot.cameras import rotation, sparse_keys
from firetwin.shot.cameras.rigs import poses
from firetwin.shot.settings import Camera, scene_file
from firetwin.shot.shot import Shot
from firetwin_core import geo
from hypothesis import given
from hypothesis import strategies as st

FRAME = geo.LocalFrame(38.9, -120.6, 0.0)
number = st.floats(-1.0, 1.0)


@given(st.tuples(number, number, number, number), st.tuples(number, number))
def test_angles_give_the_turn_back_anywhere(q, where):
    if np.linalg.norm(q) < 1e-3:
        return
    (matrix,) = quaternion.matrices(np.array([q]))
    place = np.array([*where, 0.05]) * 40_000.0
    again = rotation.turned(FRAME, place, *rotation.angles(FRAME, place, matrix))
    assert np.abs(again - matrix).max() < 1e-8
    (found,) = quaternion.quaternions(matrix[None])
    assert abs(found @ np.array(q)) == pytest.approx(np.linalg.norm(q), rel=1e-12)


def test_angles_mean_what_they_say():
    """At the origin x is east and y north: a camera that looks east, 10 degrees down, its right side low."""
    right, up, back = rotation.turned(FRAME, np.zeros(3), 90.0, 10.0, 5.0).T
    assert -back == pytest.approx([np.cos(np.radians(10.0)), 0.0, -np.sin(np.radians(10.0))], abs=1e-9)
    assert right[2] == pytest.approx(-np.sin(np.radians(5.0)) * np.cos(np.radians(10.0)), abs=1e-9)
    assert np.cross(right, up) == pytest.approx(back, abs=1e-9)


@pytest.mark.parametrize("tilt", [90.0, -90.0, 89.999])
def test_straight_up_and_down_keep_the_bearing(tilt):
    matrix = rotation.turned(FRAME, np.zeros(3), 33.0, tilt, 0.0)
    heading, found, _ = rotation.angles(FRAME, np.zeros(3), matrix)
    assert (heading, found) == (pytest.approx(33.0, abs=1e-4), pytest.approx(tilt, abs=1e-6))


@given(st.integers(0, 10_000))
def test_few_keys_go_where_a_way_goes(seed):
    random = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, 120)[:, None]
    values = sum(random.normal(size=3) * np.sin(k * (t + random.uniform())) for k in range(4)) * 100.0
    kept = sparse_keys.fit(values, 0.05, (17,))
    shown = sparse_keys.through(kept / 119.0, values[kept], t[:, 0])
    assert np.linalg.norm(shown - values, axis=1).max() <= 0.05
    assert 17 in kept
    assert len(kept) < 60


def _shot(run, keys, frames):
    return film(run, Camera("hand", poses.Poses(24.0, 13.2, keys)), frames=frames)


def test_a_flown_way_comes_back_through_the_file(make_run, tmp_path):
    """Place to a micrometre and turn to 1e-8 where keys are, after text, WGS84 and angles."""
    random = np.random.default_rng(3)
    shot = _shot(runs.open(make_run()), (poses.PoseKey(),), 5)
    place = random.uniform(-2000.0, 2000.0, (5, 3)) + np.array([0.0, 0.0, 4000.0])
    matrix = quaternion.matrices(random.normal(size=(5, 4)))
    lens = np.array([24.0, 24.0, 50.0, 70.0, 70.0])
    keys = poses.keyed(shot.local_frame, np.linspace(0.0, 1.0, 5), place, matrix, lens)
    settings = replace(shot.settings, cameras=_shot(shot.run, keys, 5).settings.cameras)
    settings = replace(settings, path=tmp_path / "scene.toml")
    settings.path.write_text(scene_file.text(settings), encoding="utf-8")
    again = scene_file.read(settings.path)
    assert again.cameras == settings.cameras
    (view,) = Shot(again, shot.run).paths
    assert np.abs(view.position - place).max() < 1e-6
    assert np.abs(view.rotation - matrix).max() < 1e-8
    assert 0.5 * view.sensor / view.halves[:, 0] == pytest.approx(lens, rel=1e-12)


def test_poses_without_any_say_so():
    where, reason = Camera("lost", poses.Poses()).validate()
    assert where == ("keys",)
    assert 'camera "lost" has no [[cameras.keys]]' in reason
