"""The globe camera: on the great circle, at one feeling of speed, level, above the ground, well clipped."""

from dataclasses import replace

import numpy as np
import pymap3d
import pyproj
import pytest
import sample_evening
from firetwin.shot.cameras import clipping, zoom
from firetwin.shot.cameras.rigs.globe import Globe
from firetwin.shot.settings import Camera
from hypothesis import given
from hypothesis import settings as hypothesis
from hypothesis import strategies as st
from hypothesis_profiles import examples
from sample_evening import *  # noqa: F403

EARTH = pyproj.Geod(ellps="WGS84")
FRAMES = 120


@pytest.fixture(scope="module")
def whole(run):
    """The evening, whose terrain and fire all shots share."""
    return sample_evening.shot_of(run, Camera("space", Globe()))


def shot_of(whole, frames=FRAMES, **globe):
    settings = replace(
        whole.settings,
        time=replace(whole.settings.time, frames=frames),
        cameras=(Camera("space", Globe(**globe)),),
    )
    return whole.with_settings(settings)


def fixed(**more):
    """An end that does not move."""
    return {"latitude": 38.9, "longitude": -120.5} | more


def geodetic(shot, position):
    """By the core, and back by pymap3d, whose own inverse is wrong by 0.3 m at 6,400 km (PROJ's: 0.07)."""
    found = np.array(shot.local_frame.reverse(position))
    assert np.abs(np.stack(pymap3d.geodetic2enu(*found, *_origin(shot)), -1) - position).max() < 1e-6
    return found


def test_it_begins_where_it_is_told_and_ends_at_the_place(whole):
    begin = {"begin_latitude": 45.0, "begin_longitude": -150.0, "begin_height": 5.0e6}
    shot = shot_of(whole, **fixed(**begin, over_ridges=False))
    (view,) = shot.paths
    latitude, longitude, height = geodetic(shot, view.position)
    assert (latitude[0], longitude[0], height[0]) == pytest.approx((45.0, -150.0, 5.0e6), abs=1e-3)
    away, down = view.target[-1] - view.position[-1], 2000.0
    assert np.hypot(*away[:2]) == pytest.approx(4000.0, abs=1.0)
    assert view.position[-1, 2] - shot.ground.up(*view.position[-1, :2])[0] > 0.9 * down
    side = EARTH.inv(-120.5, 38.9, -150.0, 45.0)[0]
    seen = np.degrees(np.arctan2(*-away[:2]))
    assert seen == pytest.approx(side, abs=0.5), "it comes from the side where it begins"


def test_it_keeps_to_the_geodesic_to_the_millimetre(whole):
    shot = shot_of(whole, **fixed(begin_latitude=-10.0, begin_longitude=-60.0))
    (view,) = shot.paths
    latitude, longitude, height = geodetic(shot, view.position)
    azimuth, _, length = EARTH.inv(longitude[0], latitude[0], longitude[-1], latitude[-1])
    flown = EARTH.inv(np.full(FRAMES, longitude[0]), np.full(FRAMES, latitude[0]), longitude, latitude)[2]
    assert flown[-1] == pytest.approx(length, abs=1e-3)
    east, north, _ = EARTH.fwd(*(np.full(FRAMES, v) for v in (longitude[0], latitude[0], azimuth)), flown)
    assert np.max(EARTH.inv(east, north, longitude, latitude)[2]) < 1e-3
    wanted = np.stack(pymap3d.geodetic2enu(north, east, height, *_origin(shot)), -1)
    assert np.abs(wanted - view.position).max() < 2e-3
    assert view.position[0, 2] < -4.0e6, "the Earth is curved: it begins far below the horizontal plane"


def _origin(shot):
    return shot.local_frame.latitude, shot.local_frame.longitude, 0.0


def test_the_height_falls_at_one_feeling_of_speed(whole):
    """Equal factors a frame while it flies, and no jump of the factor between two frames."""
    shot = shot_of(whole, frames=240, **fixed(over_ridges=False, begin_longitude=-125.0))
    (view,) = shot.paths
    height = geodetic(shot, view.position)[2]
    above = np.log(height - height[-1] + 2000.0)
    speed = np.diff(above)
    assert (speed <= 1e-9).all(), "never up"
    assert np.abs(np.diff(speed)).max() < 0.08 * np.abs(speed).max()
    even = speed[80:140]
    assert np.ptp(even) < 0.05 * np.abs(even).mean()
    assert speed[:20].max() == speed[-40:].min() == 0.0, "it holds at the beginning, and stays at the end"


def test_the_view_keeps_to_the_place_without_a_jump(whole):
    for bearing in (None, 100.0, 270.0):
        shot = shot_of(whole, frames=240, **fixed(bearing=bearing))
        (view,) = shot.paths
        frame = shot.local_frame
        latitude, longitude, height = geodetic(shot, view.position)
        upper = frame.forward(latitude, longitude, height + 1000.0) - view.position
        up = upper / np.linalg.norm(upper, axis=1, keepdims=True)
        begins = view.target[0] - view.position[0]
        ahead = begins / np.linalg.norm(begins)
        assert -view.rotation[0, :, 2] == pytest.approx(ahead, abs=2e-3)
        limb = np.arcsin(6.371e6 / (6.371e6 + height[0])) - np.arccos(-ahead @ up[0])
        assert 0.0 < limb < np.arctan(view.half[1]), "the limb is in the picture"
        away = view.target[-1] - view.position[-1]
        assert -view.rotation[-1, :, 2] == pytest.approx(away / np.linalg.norm(away), abs=1e-7)
        roll = np.einsum("ni,ni->n", view.rotation[:, :, 0], up)
        assert np.abs(roll).max() < 1e-7, "the horizon is level"
        steps = np.einsum("nij,nij->n", view.rotation[1:], view.rotation[:-1])
        turned = np.degrees(np.arccos(np.clip((steps - 1.0) / 2.0, -1, 1)))
        assert turned.max() < 6.0
        assert np.abs(np.diff(turned)).max() < 0.6
        local = np.einsum("nij,ni->nj", view.rotation, view.target - view.position)
        late = shot.settings.cameras[0].rig.parts(240) > 0.8
        assert np.abs(local[late, :2] / local[late, 2:]).max() < 0.05, "the place stays in the middle"


begins = st.fixed_dictionaries(
    {
        "begin_latitude": st.floats(-60, 85),
        "begin_longitude": st.floats(-180, 0),
        "begin_height": st.floats(100.0, 4e7),
        "height": st.floats(10.0, 1e5),
        "distance": st.floats(1.0, 2e4),
        "bearing": st.none() | st.floats(0, 360),
        "focal_length": st.floats(10, 200),
    }
)


@given(begins)
@hypothesis(deadline=None, max_examples=examples(40))
def test_any_flight_is_above_the_ground_and_well_clipped(whole, settings):
    shot = shot_of(whole, frames=24, **fixed(**settings))
    (view,) = shot.paths
    ground = shot.ground
    latitude, longitude, height = geodetic(shot, view.position)
    there = np.hypot(*view.position[:, :2].T) < 25_000.0
    rise = height[there] - ground.height(*ground.indices(latitude[there], longitude[there]))
    assert (rise > 9.0).all()
    assert np.isfinite(view.rotation).all()
    assert np.einsum("nji,njk->nik", view.rotation, view.rotation) == pytest.approx(
        np.broadcast_to(np.eye(3), (24, 3, 3)), abs=1e-9
    )
    near, far = view.clips.T
    assert (near >= 0.5).all()
    assert (far > near).all()


def test_clip_planes_enclose_what_is_seen(whole):
    """Every place of the ground and of the air over it that no Earth is in front of; and little more."""
    shot = shot_of(whole, **fixed())
    (view,) = shot.paths
    frame, fields = shot.local_frame, shot.ground.fields
    rng = np.random.default_rng(3)
    latitude, longitude = rng.uniform(-89, 89, 20_000), rng.uniform(-180, 180, 20_000)
    world = frame.forward(latitude, longitude, np.zeros(20_000))
    up = frame.forward(latitude, longitude, np.full(20_000, 1.0)) - world
    mine = frame.forward_grid(fields.latitude[::9], fields.longitude[::9], fields.elevation[::9, ::9])
    air = frame.forward_grid(
        fields.latitude[::9], fields.longitude[::9], np.full(fields.elevation[::9, ::9].shape, 20_000.0)
    )
    for place, (near, far) in zip(view.position[::10], view.clips[::10], strict=True):
        seen = np.einsum("ni,ni->n", place - world, up) > 0.0
        away = np.linalg.norm(world[seen] - place, axis=1)
        scene = np.linalg.norm(np.concatenate([mine.reshape(-1, 3), air.reshape(-1, 3)]) - place, axis=1)
        assert far > max(away.max(initial=0.0), scene.max())
        ground = np.linalg.norm(mine.reshape(-1, 3) - place, axis=1).min()
        assert near < min(away.min(initial=np.inf), ground)
        if clipping.heights(frame, place[None])[0] > 25_000.0:
            assert near < scene.min()
            assert far / near < 5000.0


def test_clip_planes_do_not_jump(whole):
    (view,) = shot_of(whole, frames=240, **fixed()).paths
    assert np.abs(np.diff(np.log(view.clips), axis=0)).max() < 0.5


def test_chunks_of_a_film_fly_the_same_way(whole):
    """Frames that are built alone have the positions, views and clip planes of the complete film."""
    shot = shot_of(whole)
    part = shot.for_frames([40, 41, 42])
    for name in ("position", "rotation", "clips"):
        assert np.array_equal(getattr(part.paths[0], name), getattr(shot.paths[0], name))
    assert part.beyond


def test_only_this_kind_of_camera_sees_the_earth_beyond(whole):
    assert shot_of(whole).beyond
    settings = replace(whole.settings, cameras=(Camera("drone"),))
    assert not whole.with_settings(settings).beyond


@given(st.floats(0, 1e7), st.floats(1, 1e8), st.floats(1, 1e8))
@hypothesis(deadline=None, max_examples=examples(200))
def test_a_zoom_begins_and_ends_where_it_should(distance, begin, end):
    part = np.linspace(0.0, 1.0, 101)
    share, width = zoom.flight(*(np.full(101, v) for v in (distance, begin, end)), part)
    assert share[0] == 0.0
    assert share[-1] == 1.0
    assert width[[0, -1]] == pytest.approx([begin, end])
    assert share[-2] == pytest.approx(1.0, abs=0.7)
    assert (np.diff(share) >= -1e-12).all()
    felt = np.hypot(
        np.diff(np.log(width)), 1.42**2 * np.diff(share) * distance / np.sqrt(width[1:] * width[:-1])
    )
    assert np.ptp(felt) < 0.05 * felt.mean() + 1e-6, "one speed on the screen"


def test_eased_progress_has_no_jump():
    part = np.linspace(0.0, 1.0, 10_001)
    done = zoom.eased(part)
    speed = np.diff(done) * 1e4
    assert (done[0], done[-1]) == pytest.approx((0.0, 1.0))
    assert speed.max() == pytest.approx(1.25, abs=1e-3)
    assert np.abs(np.diff(speed)).max() < 2e-3


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"place": "head", "latitude": 38.9, "longitude": -120.5}, "leave one out"),
        ({"latitude": 38.9}, "without a longitude"),
        ({"place": "Atlantis"}, "Atlantis"),
        ({"begin_latitude": -38.9, "begin_longitude": 59.5}, "nearly opposite"),
    ],
)
def test_what_cannot_be_flown_is_refused(whole, settings, words):
    rig = Globe(**settings)
    where, reason = rig.validate() or rig.validate_against(whole.run, whole.frames)
    assert words in reason
    assert hasattr(rig, where[0])
