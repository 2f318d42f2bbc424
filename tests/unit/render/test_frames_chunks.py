"""Films built in chunks of frames: data of the shot that a chunk shares, and its own data."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.jobs import render
from firetwin.render.picture import Picture
from firetwin.run import opening as runs
from firetwin.shot.cameras.rigs.orbit import Orbit
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Camera, Render, Settings
from firetwin.shot.shot import Shot
from hypothesis import given
from hypothesis import strategies as st
from small_run import RUN_TOML, small_fields, write_field

ORBIT = Orbit(latitude=38.905, longitude=-120.592, radius=900.0, height=300.0, speed=20.0)


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """A shot of nine frames over two minutes with an orbit."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "run.toml").write_text(RUN_TOML)
    for name, values in small_fields().items():
        write_field(folder, name, values, "npy")
    run = runs.open(folder)

    def shot(chunk=0, frames="", **changes):
        settings = Settings(
            time=Time(
                start=datetime(2014, 9, 17, 4, 45, tzinfo=UTC),
                end=datetime(2014, 9, 17, 4, 47, tzinfo=UTC),
                frames=9,
            ),
            terrain=TerrainSettings(near_radius=1500.0, apron=0.0),
            forest=Forest(trees=False),
            render=Render(chunk=chunk),
            cameras=(Camera("a", ORBIT, frames=frames),),
        )
        return Shot(replace(settings, **changes), run)

    return shot


def _pictures(frames):
    return [Picture("a", frame, name) for frame in frames for name in ("rgb", "depth")]


@given(st.integers(0, 12), st.sets(st.integers(1, 9), min_size=1))
def test_parts_do_not_hang_on_what_is_wanted_and_hold_all_of_it(film, chunk, wanted):
    shot = film(chunk)
    parts = list(render.split_in_chunks(shot, _pictures(sorted(wanted))))
    assert [picture for _part, group in parts for picture in group] == _pictures(sorted(wanted))
    everything = {
        tuple(part.built_frames): part for part, _ in render.split_in_chunks(shot, _pictures(range(1, 10)))
    }
    for part, group in parts:
        assert tuple(part.built_frames) in everything
        assert {picture.frame - 1 for picture in group} <= set(part.built_frames.tolist())
        assert len(part.built_frames) <= (chunk or 9)


def test_a_short_film_is_built_whole_and_a_part_keeps_the_camera_s_path(film):
    shot = film(9)
    ((part, _),) = render.split_in_chunks(shot, _pictures([3]))
    assert part is shot
    part = shot.for_frames([4, 5])
    assert part.full is shot
    assert part.built_times == pytest.approx(shot.frames.times[[3, 4]])
    assert np.array_equal(part.paths[0].position, shot.paths[0].position)
    assert part.filmed(part.paths[0]).tolist() == [3, 4]


def test_frames_of_a_camera_that_films_some_are_parted_by_their_numbers(film):
    parts = list(render.split_in_chunks(film(4, "1-9:2"), _pictures([1, 3, 5, 7, 9])))
    assert [part.built_frames.tolist() for part, _ in parts] == [[0, 2], [4, 6], [8]]
