"""Section [time]: start, end, frames and speed of a film, any three of which give the fourth."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.shot.sections import Time
from firetwin.shot.settings import Settings, scene_file
from firetwin.shot.shot import Shot
from hypothesis import given
from hypothesis import strategies as st
from small_run import RUN_TOML, small_fields, write_field

START = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
END = START + timedelta(seconds=60)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    (folder / "run.toml").write_text(RUN_TOML)
    for name, values in small_fields().items():
        write_field(folder, name, values, "npy")
    return runs.open(folder)


@given(st.integers(2, 100), st.floats(0.1, 1000.0), st.integers(1, 60))
def test_speed_gives_the_end_or_the_start(frames, speed, fps):
    span = timedelta(seconds=speed * (frames - 1) / fps)
    given_start = Time(start=START, frames=frames, speed=speed, fps=fps)
    assert given_start.resolved() == Time(start=START, end=START + span, frames=frames, fps=fps)
    given_end = Time(end=END, frames=frames, speed=speed, fps=fps)
    assert given_end.resolved() == Time(start=END - span, end=END, frames=frames, fps=fps)
    assert given_start.validate() is None
    assert given_end.validate() is None


def test_a_still_has_no_end():
    assert Time(start=START, frames=1, speed=15.0).resolved() == Time(start=START, frames=1)


def test_start_end_and_speed_give_the_number_of_frames(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(f"[time]\nstart = {START.isoformat()}\nend = {END.isoformat()}\nspeed = 10.0\nfps = 12\n")
    time = scene_file.read(file).time
    assert time.frames == 73
    assert time.validate() is None


def test_contradictions_and_a_speed_alone_are_refused():
    assert Time(START, END, frames=73, speed=10.0, fps=12).validate() is None
    where, words = Time(START, END, frames=48, speed=10.0, fps=12).validate()
    assert where == ("speed",)
    assert "48 frames show 60 s at 15.32 times real time" in words
    assert "set time.frames = 73" in words
    assert "needs time.start or time.end" in Time(speed=10.0).validate()[1]
    assert "9999" in Time(end=END, frames=100_000, fps=1, speed=1e6).validate()[1]


def test_a_shot_has_the_times_of_the_speed(run):
    shot = Shot(Settings(time=Time(start=START, frames=5, speed=15.0, fps=12)), run)
    assert np.diff(shot.frames.times) == pytest.approx([1.25] * 4)
    assert shot.speed == pytest.approx(15.0)
    assert shot.settings.time.speed is None
    assert shot.describe_film() == "5 frames at 12 frames per second show 5 s of the fire, 15 times real time"
    same = Time(start=START, end=START + timedelta(seconds=5), frames=5, fps=12, shutter=0.0)
    same = replace(same, zone=shot.settings.time.zone)
    assert shot.settings.time == same
    assert (
        Shot(Settings(time=Time(start=START, frames=5, speed=31.0, fps=12)), run).settings.time.shutter == 2.0
    )
    still = Shot(replace(shot.settings, time=Time(start=START, frames=1)), run)
    assert still.describe_film() == "1 frame, a still"
