"""How drones fly over the sample's canyons, against its terrain, the geodesic and the laws of flight."""

import itertools
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from filmed import film
from firetwin.data import sample, stored
from firetwin.run import readers
from firetwin.shot.cameras import flight
from firetwin.shot.cameras.path import hidden
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot

pyproj = pytest.importorskip("pyproj")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The sample run, two of its times."""
    out = tmp_path_factory.mktemp("sample") / "run"
    sample.write(out, frames=2)
    return readers.open(out)


def flown(run, frames=40, near_radius=1500.0, minutes=20, **drone):
    """The shot of one drone over so many model minutes, and its path."""
    time = {"start": datetime(2014, 9, 17, 16, tzinfo=UTC), "frames": frames}
    time["end"] = time["start"] + timedelta(minutes=minutes)
    shot = film(run, Camera("scout", Drone(**drone)), near_radius=near_radius, apron=1000.0, **time)
    return shot, shot.paths[0]


def over_ground(shot, position):
    return position[:, 2] - shot.ground.up(position[:, 0], position[:, 1])


def dense(position, apart):
    """Places (n, 3) on the straight way from frame to frame, at most so far apart."""
    legs = [
        np.linspace(a, b, max(int(np.ceil(np.linalg.norm(b - a) / apart)), 1) + 1)
        for a, b in itertools.pairwise(position)
    ]
    return np.concatenate(legs)


def canyon(run, count):
    """Latitudes and longitudes of places along the longest river of the sample."""
    rivers = stored.load(stored.PATH).rivers
    row, column = max(rivers.values(), key=lambda cells: len(cells[0]))
    pick = np.linspace(0.1, 0.9, count) * (len(row) - 1)
    return (
        axis[cells[pick.astype(int)]]
        for axis, cells in ((np.asarray(run.fuel_latitude), row), (np.asarray(run.fuel_longitude), column))
    )


@pytest.mark.parametrize("frames", [7, 90])
@pytest.mark.parametrize("above", ["ground", "sea"])
def test_it_keeps_its_clearance_all_along_a_canyon(run, frames, above):
    """Sampled every metre; legs of 7 frames are kilometres long and cut through the canyon's walls."""
    places = list(zip(*canyon(run, 6), strict=True))
    height = 45.0 if above == "ground" else 500.0
    keys = tuple(
        CameraKey(i / 5, *map(float, place), height, "ahead", above=above) for i, place in enumerate(places)
    )
    shot, path = flown(run, frames, keys=keys, clearance=30.0)
    way = dense(path.position, 1.0)
    assert len(way) > 10_000
    assert over_ground(shot, way).min() >= 30.0
    low = replace(shot.settings.cameras[0].rig, clearance=1e-3)
    bare = low.path(shot.settings.cameras[0], shot.filming, shot.ground)
    assert over_ground(shot, dense(bare.position, 5.0)).min() < 30.0, "it is the clearance that lifts"


def test_heights_above_the_sea_are_those_of_the_datum(run):
    key = CameraKey(0.0, 38.9, -120.5, 3000.0, "ahead", above="sea")
    shot, path = flown(run, 3, keys=(key, replace(key, at=1.0, longitude=-120.4)))
    assert shot.local_frame.reverse(path.position)[2] == pytest.approx(3000.0, abs=1e-6)


def test_a_leg_is_the_geodesic_within_a_metre(run):
    """40 km over a corner of the run, at one height; the geodesic is PROJ's (GeographicLib's algorithm)."""
    ends = (38.70, -120.75), (39.02, -120.45)
    keys = tuple(CameraKey(at, *end, 4000.0, "ahead", above="sea") for at, end in enumerate(ends))
    shot, path = flown(run, 50, near_radius=0.0, keys=keys)
    latitude, longitude, height = shot.local_frame.reverse(path.position)
    earth = pyproj.Geod(ellps="WGS84")
    azimuth, _, whole = earth.inv(*ends[0][::-1], *ends[1][::-1])
    start = (np.full(len(latitude), v) for v in ends[0][::-1])
    _, _, gone = earth.inv(*start, longitude, latitude)
    there = earth.fwd(*(np.full(len(gone), v) for v in (*ends[0][::-1], azimuth)), gone)
    _, _, beside = earth.inv(there[0], there[1], longitude, latitude)
    assert beside.max() < 0.01
    assert height == pytest.approx(4000.0, abs=1e-6)
    assert gone[[0, -1]] == pytest.approx([0.0, whole], abs=1e-3)
    assert np.diff(gone) == pytest.approx(whole / 49, rel=1e-3)


def test_speed_and_course_change_smoothly(run):
    """Twice the frames halve the change of velocity from frame to frame: there is no corner at a key."""
    keys = tuple(
        CameraKey(at, 38.90 + 0.02 * dy, -120.5 + 0.03 * dx, 3500.0, "ahead", above="sea")
        for at, dx, dy in ((0.0, 0, 0), (0.3, 1, 0.4), (0.6, 1.7, 1.3), (1.0, 2, 3))
    )

    def jerk(frames):
        position = flown(run, frames, near_radius=0.0, keys=keys)[1].position
        speed = np.diff(position, axis=0) * (frames - 1)
        return np.linalg.norm(np.diff(speed, axis=0), axis=1).max()

    assert jerk(401) < 0.6 * jerk(201)


def test_it_looks_ahead_below_the_horizon(run):
    keys = tuple(
        CameraKey(at, 38.9, -120.5 + 0.05 * at, 3500.0, "ahead", above="sea", tilt=20.0) for at in (0.0, 1.0)
    )
    _, path = flown(run, 9, near_radius=0.0, keys=keys)
    forward = -path.rotation[:, :, 2]
    assert np.degrees(np.arcsin(-forward[:, 2])) == pytest.approx(20.0)
    assert forward[:, 0] == pytest.approx(np.cos(np.radians(20.0)), abs=1e-3)  # east


def test_a_turn_leans_as_a_coordinated_one():
    """30 m/s round a circle of 200 m to the right: atan(v2 / (g r)) = 24.65 degrees."""
    step, angle = 0.5, np.arange(60) * 0.5 * 30.0 / 200.0
    circle = 200.0 * np.stack([-np.cos(angle), np.sin(angle), 0 * angle], axis=-1)  # clockwise from west
    lean = flight.bank(circle, step)[5:-5]
    assert np.degrees(lean) == pytest.approx(np.degrees(np.arctan(900 / (9.80665 * 200))), abs=0.1)
    level = np.repeat(np.eye(3)[None], len(lean), axis=0)
    right = flight.rolled(level, lean)[:, :, 0]
    assert (right[:, 1] < 0.0).all(), "the right wing is down"
    assert (flight.bank(circle * [1, -1, 1], step)[5:-5] < 0.0).all()


def test_who_stands_still_keeps_its_heading():
    way = np.array([[0, 0, 0], [0, 0, 0], [10, 0, 0], [20, 0, 0], [20, 0, 5], [20, 0, 9], [20, 0, 9]], float)
    assert np.degrees(flight.heading(way)) == pytest.approx(90.0)
    assert flight.heading(np.zeros((4, 3))).tolist() == [0.0] * 4
    assert flight.bank(np.zeros((4, 3)), 1.0).tolist() == [0.0] * 4


def test_vibration_hangs_on_seed_name_and_frame_alone():
    level = np.repeat(np.eye(3)[None], 4000, axis=0)
    shaken = flight.trembling(level, 0.1, 1, "a")
    assert np.array_equal(shaken[:50], flight.trembling(level[:50], 0.1, 1, "a"))
    assert not np.allclose(shaken, flight.trembling(level, 0.1, 2, "a"), atol=1e-6)
    assert not np.allclose(shaken, flight.trembling(level, 0.1, 1, "b"), atol=1e-6)
    assert np.einsum("nij,nik->njk", shaken, shaken) == pytest.approx(level, abs=1e-12)
    small = np.degrees([shaken[:, 2, 1], shaken[:, 0, 2], shaken[:, 1, 0]])  # to first order the angles
    assert small.std(axis=1) == pytest.approx(0.1, rel=0.05)
    assert np.abs(np.corrcoef(small) - np.eye(3)).max() < 0.05
    assert np.abs(np.mean(small[:, 1:] * small[:, :-1])) < 0.1 * 0.1**2


def test_a_lens_and_its_chip_give_the_view(run):
    key = CameraKey(0.0, 38.9, -120.5, 300.0, "ahead")
    shot, path = flown(run, 1, near_radius=0.0, keys=(key,), focal_length=8.8, sensor_width=13.2)
    assert path.half == pytest.approx((0.75, 0.75 * 360 / 640))
    camera = replace(shot.settings.cameras[0], resolution=(400, 400))
    square = Shot(replace(shot.settings, cameras=(camera,)), run)
    assert square.paths[0].half == pytest.approx((0.75, 0.75))
    assert square.for_camera("scout").settings.render.resolution == (400, 400)


def test_ridges_before_a_long_film_are_those_before_each_of_its_frames(run):
    """5,000 frames along 20 km, 100 m over the ground: 600 are checked; the frames between differ little."""
    keys = (CameraKey(0.0, 38.85, -120.65, 100.0, "ahead"), CameraKey(1.0, 38.97, -120.48, 100.0, "ahead"))
    shot, flown_way = flown(run, 5000, keys=keys)
    target = shot.ground.point([38.90], [-120.60], 200.0) + np.zeros((5000, 1))
    angles = hidden(shot.ground, flown_way.position, target)
    parts = [slice(begin, begin + 500) for begin in range(0, 5000, 500)]
    each = [hidden(shot.ground, flown_way.position[part], target[part]) for part in parts]
    exact = np.concatenate(each)
    assert exact.max() > 100.0
    assert np.abs(angles - exact).mean() < 0.01 * exact.max()
    assert np.abs(angles - exact).max() < 0.25 * exact.max()
