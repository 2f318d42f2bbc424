"""Lookout, chase, minimap and satellite: their positions and views."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
import whole_run
from filmed import film
from firetwin.errors import InputError
from firetwin.render import fingerprint
from firetwin.run import opening as runs
from firetwin.run import times
from firetwin.shot import run_checks
from firetwin.shot.cameras import path, targets
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.chase import Chase
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.cameras.rigs.lookout import Lookout, LookoutKey
from firetwin.shot.cameras.rigs.minimap import Minimap
from firetwin.shot.cameras.rigs.satellite import ORBIT, Satellite
from firetwin.shot.settings import Camera, Settings, scene_file
from firetwin_core import lod

pyproj = pytest.importorskip("pyproj")

KEYS = (
    CameraKey(0.0, 38.900, -120.599, 300.0, "ahead"),
    CameraKey(1.0, 38.908, -120.587, 300.0, "ahead"),
)
TURNING = ((-300.0, 0.0, 0.0), (100.0, 300.0, 900.0), (0.0, -300.0, 2000.0))
"""Fires whose head changes its course: m east and north, and time, s."""


@pytest.fixture
def run(make_run):
    """The small run, its front going east over all of it within two minutes."""
    arrival = np.repeat(np.linspace(0.0, 110.0, 10)[None], 8, axis=0)
    return runs.open(make_run(fuel_arrival_time=arrival.astype(np.float32)))


def shot_of(run, *cameras, frames=21):
    return film(run, *cameras, start=datetime(2014, 9, 17, 4, 45, tzinfo=UTC), frames=frames)


def lookout(*keys, **more):
    return Camera("tower", Lookout(latitude=38.904, longitude=-120.594, keys=keys, **more))


def test_a_lookout_turns_the_short_way_and_tilts_from_its_own_horizon(run):
    shot = shot_of(run, lookout(LookoutKey(0.0, 350.0, 5.0), LookoutKey(1.0, 30.0, 5.0)))
    (view,) = shot.paths
    latitude, longitude, height = shot.local_frame.reverse(view.position)
    assert (latitude, longitude) == (pytest.approx(38.904), pytest.approx(-120.594))
    aim = shot.local_frame.reverse(view.target)
    bearing = pyproj.Geod(ellps="WGS84").inv(longitude, latitude, aim[1], aim[0])[0]
    assert bearing[[0, 10, -1]] == pytest.approx([-10.0, 10.0, 30.0], abs=1e-4)
    assert (np.diff(bearing) > 0.0).all()
    sunk = 5000.0 * np.sin(np.radians(5.0)) - 5000.0**2 / (2 * 6.37e6)  # the Earth falls away below the line
    assert height - aim[2] == pytest.approx(sunk, abs=0.05)
    up = path.compass(shot.local_frame, view.position[0])[2]
    assert view.rotation[:, :, 0] @ up == pytest.approx(0.0, abs=1e-9)


def test_a_lookout_zooms_evenly_to_the_eye(run):
    shot = shot_of(run, lookout(LookoutKey(0.0), LookoutKey(1.0, zoom=4.0), focal_length=50.0))
    (view,) = shot.paths
    wide = 18.0 / 50.0
    assert view.half[0] == pytest.approx(wide / 4.0), "what decides detail is the longest lens"
    across = view.halves[:, 0]
    assert across[[0, -1]] == pytest.approx([wide, wide / 4.0])
    assert across[1:] / across[:-1] == pytest.approx(0.25 ** (1 / 20))
    aim = view.position[0] + 1000.0 * (-view.rotation[0, :, 2] + 0.5 * wide * view.rotation[0, :, 0])
    first, last = (shot.visibility.view_set(frame) for frame in (1, 21))
    assert lod.visible_mask(aim[None], 0.0, first).all()
    assert not lod.visible_mask(aim[None], 0.0, last).any()


def test_a_chase_stays_behind_the_head_and_frames_it(run):
    shot = shot_of(run, Camera("chase", Chase(distance=200.0, height=150.0, target_height=10.0)), frames=61)
    (view,) = shot.paths
    head = targets.follow("head", shot.ground, shot.frames.times, 10.0)
    assert view.target == pytest.approx(head)
    local = np.einsum("nij,ni->nj", view.rotation, head - view.position)
    assert local[:, :2] == pytest.approx(0.0, abs=1e-6)
    assert (local[:, 2] < 0.0).all()
    away = view.position - head
    assert np.hypot(away[:, 0], away[:, 1]) == pytest.approx(200.0)
    assert (away[10:-10, 0] < -150.0).all(), "the fire runs east, so behind is west"
    above = view.position[:, 2] - shot.ground.up(view.position[:, 0], view.position[:, 1])
    assert above.min() >= 50.0
    turned = shot_of(run, Camera("chase", Chase(distance=200.0, side=90.0)), frames=61).paths[0]
    assert ((turned.position - turned.target)[10:-10, 1] < -150.0).all(), "its right is south"


@pytest.mark.parametrize("seconds", [60.0, 3600.0])
@pytest.mark.parametrize("side", [0.0, 100.0, 180.0])
def test_a_chase_is_at_the_same_place_at_a_time_in_films_of_any_number_of_frames(tmp_path, seconds, side):
    def hills(east, north):
        return 60.0 * np.sin(east / 300.0) * np.cos(north / 200.0)

    run = runs.open(whole_run.write(tmp_path / "run", cells=32, fires=TURNING, height=hills, seed=1))
    chase = Camera("chase", Chase(distance=400.0, height=120.0, side=side))
    start, end = (times.utc(run, at) for at in (0.0, seconds))
    few, many = (film(run, chase, start=start, end=end, frames=frames).paths[0] for frames in (10, 100))
    assert few.position == pytest.approx(many.position[::11], abs=1.0)
    assert few.target == pytest.approx(many.target[::11], abs=1.0)


def test_a_minimap_goes_along_north_up(run):
    drone, over = Camera("scout", Drone(keys=KEYS)), Camera("map", Minimap(swath=800.0))
    shot = shot_of(run, over, drone)
    flown = shot.paths[1].position
    for one in (shot, shot.for_camera("map")):  # also where the drone is not filmed
        view = one.paths[0]
        assert view.position[:, :2] == pytest.approx(flown[:, :2], abs=1.0)
        assert np.ptp(view.position[:, 0]) > 500.0
        assert not view.perspective
        assert view.half == (400.0, 225.0)
        assert np.array_equal(view.rotation, np.repeat(np.eye(3)[None], 21, axis=0))
    alone = shot_of(run, over).paths[0]
    assert alone.position[:, :2] == pytest.approx(0.0)


def test_a_minimap_is_made_again_when_the_camera_it_follows_moves(run):
    over = Camera("map", Minimap(follows="scout"))
    moved = replace(KEYS[1], longitude=-120.588)

    def made_with(*cameras):
        return fingerprint.collect_inputs(Settings(cameras=cameras), {}, "map", "rgb")

    first = made_with(Camera("scout", Drone(keys=KEYS)), over)
    assert first == made_with(Camera("scout", Drone(keys=KEYS)), over, Camera("other", Satellite()))
    assert first != made_with(Camera("scout", Drone(keys=(KEYS[0], moved))), over)


def test_a_geostationary_satellite_is_over_the_equator_and_sees_rows_of_parallels(run):
    shot = shot_of(run, Camera("goes", Satellite(swath=4000.0, geostationary=-137.0)))
    (view,) = shot.paths
    latitude, longitude, height = shot.local_frame.reverse(view.position[:1])
    assert (latitude[0], longitude[0]) == pytest.approx((0.0, -137.0), abs=1e-6)
    assert (latitude[0], longitude[0], height[0]) == pytest.approx((0.0, -137.0, ORBIT), abs=4.0)
    assert np.linalg.norm(shot.local_frame.reverse(view.position)[2][0] + 6_378_137.0) == pytest.approx(
        42_164_160.0
    )
    middle = shot.ground.point(shot.local_frame.latitude, shot.local_frame.longitude)[0]
    assert view.meet == pytest.approx(np.linalg.norm(view.position[0] - middle))
    over = 90.0 - np.degrees(np.arccos(-view.rotation[0, :, 2] @ [0, 0, -1]))
    assert over == pytest.approx(42.0, abs=1.0)  # 48 degrees from the zenith
    axis = np.array([0.0, np.cos(np.radians(38.9)), np.sin(np.radians(38.9))])
    assert view.rotation[0, :, 0] @ axis == pytest.approx(0.0, abs=1e-4)
    assert view.rotation[0, :, 1] @ axis > 0.5
    side = middle + view.rotation[0, :, 0] * np.array([[1900.0], [2100.0]])
    assert shot.visibility.visible_mask(side, 0.0, pixel=np.inf).tolist() == [True, False]
    near, far = path.clip(view, shot.ground)
    assert near < view.meet - 5e4 < view.meet + 5e4 < far
    assert near > 1e7


@pytest.mark.parametrize(
    ("east", "words"), [(75.0, "under the horizon"), (165.0, "degrees over the horizon")]
)
def test_a_satellite_that_cannot_see_the_fire_is_an_error(run, tmp_path, east, words):
    scene = tmp_path / "scene.toml"
    scene.write_text(f'[[cameras]]\nkind = "satellite"\nname = "goes"\ngeostationary = {east}\n')
    with pytest.raises(InputError, match=words) as caught:
        run_checks.check(scene_file.read(scene), run)
    assert caught.value.line == 4


def test_what_cameras_draw_holds_all_of_the_ground(run):
    rigs = (Drone(keys=KEYS), Satellite(), Satellite(geostationary=-100.0), Minimap())
    shot = shot_of(run, *(Camera(f"c{i}", rig) for i, rig in enumerate(rigs)))
    corners = shot.local_frame.forward_grid(
        shot.ground.fields.latitude, shot.ground.fields.longitude, shot.ground.fields.elevation
    ).reshape(-1, 3)
    for view in shot.paths:
        near, far = path.clip(view, shot.ground)
        depth = (view.position[:, None] - corners) @ view.rotation[0, :, 2]
        assert depth.max() < far
        assert near == 0.5 if view.perspective else near < depth.min()
