"""Times far from their start, as those since 1970, make the same pictures as times from 0 on."""

import shutil
from dataclasses import fields
from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.scene.fire import flames
from firetwin.shot.cameras.rigs.orbit import Orbit
from firetwin.shot.fire.fire import Fire
from firetwin.shot.sections import FireSettings as FireSettings
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Camera, Settings
from firetwin.shot.shot import Shot
from small_run import FX, FY, RUN_TOML, write_field

ZERO = 1_410_929_100  # s from 1970 to 2014-09-17T04:45:00Z
TIMES = np.array([0.125, 60.0, 120.5])
ORBIT = Orbit(latitude=38.905, longitude=-120.592, radius=900.0, height=300.0, speed=20.0)
MILLISECOND = 1e-3


def timed(start, zero):
    times = f"start = {start}\ntimes_s = {(zero + TIMES).tolist()}\n"
    return times + RUN_TOML.split("interval_s = 60.0\n")[1]


@pytest.fixture(params=["npy", "text"])
def both(make_run, request):
    """The same run, with its own arrival times in seconds since it began and since 1970."""
    arrival = np.linspace(0.0, 119.0, FY * FX).reshape(FY, FX) + 0.3
    arrival[0, :3] = -9999.0, np.nan, -250.125
    folder = make_run(request.param, timed("2014-09-17T04:45:00Z", 0), fuel_arrival_time=arrival)
    since_1970 = shutil.copytree(folder, folder.parent / "since_1970")
    (since_1970 / "run.toml").write_text(timed("1970-01-01T00:00:00Z", ZERO))
    later = np.where(arrival == -9999.0, arrival, arrival + ZERO)
    write_field(since_1970, "fuel_arrival_time", later, request.param)
    return runs.open(folder), runs.open(since_1970)


def test_they_are_counted_from_a_later_start(both):
    near, far = both
    assert far.start == near.start == "2014-09-17T04:45:00Z"
    np.testing.assert_array_equal(far.times, near.times)
    found, expected = far.fuel_arrival_time(), near.fuel_arrival_time()
    np.testing.assert_allclose(found, expected, atol=1e-5)
    assert np.isnan(found[0, :2]).all()
    np.testing.assert_allclose(far.fuel_rows("fuel_arrival_time", 2, 5), expected[2:5], atol=1e-5)


def test_what_pictures_are_made_of_is_the_same_to_the_millisecond(both):
    settings = Settings(
        time=Time(
            start=datetime(2014, 9, 17, 4, 45, 1, tzinfo=UTC),
            end=datetime(2014, 9, 17, 4, 46, 59, tzinfo=UTC),
            frames=5,
        ),
        terrain=TerrainSettings(near_radius=0.0, apron=0.0),
        forest=Forest(trees=False, grass=False),
        fire=FireSettings(torches=False),
        cameras=(Camera("a", ORBIT),),
    )
    near, far = (Shot(settings, run) for run in both)
    assert np.float32(far.frames.first) == pytest.approx(np.float32(near.frames.first), abs=MILLISECOND)
    assert np.float32(far.frames.last) == pytest.approx(np.float32(near.frames.last), abs=MILLISECOND)
    points = [flames.front_flames(shot) for shot in (near, far)]
    assert len(points[0].arrival_time) > 100
    for field in fields(flames.Points):
        one, other = (getattr(each, field.name).astype(np.float32) for each in points)
        np.testing.assert_allclose(other, one, rtol=1e-4, atol=MILLISECOND, err_msg=field.name)
    one, other = (Fire(run, 1.0, 119.0).sources(77.7) for run in both)
    np.testing.assert_allclose(other.power, one.power, rtol=1e-4)
    np.testing.assert_array_equal(other.fuel_cell, one.fuel_cell)


def test_times_near_their_start_stay_as_they_are(make_run):
    run = runs.open(make_run(toml=timed("2014-09-17T04:45:00Z", 900_000)))
    assert run.start == "2014-09-17T04:45:00Z"
    np.testing.assert_array_equal(run.times, 900_000 + TIMES)


@pytest.mark.parametrize(
    "times", [[4e11, 5e11, 6e11], [1e300, 2e300, 3e300], [-(2.0**21), 2.0**74 + 2.0**22, 2.0**74 + 2.0**23]]
)
def test_times_that_no_date_or_double_tells_from_a_later_start_stay_as_they_are(make_run, times):
    toml = timed("2014-09-17T04:45:00Z", 0).replace(str(TIMES.tolist()), str(times))
    run = runs.open(make_run(toml=toml))
    assert run.start == "2014-09-17T04:45:00Z"
    np.testing.assert_array_equal(run.times, times)
