"""Positions of pixels and of the front against closed forms: a level plane, a slope, a wall, a trunk."""

import numpy as np
import plain_samples
import pytest
import whole_run
from firetwin.dataset import air, survey
from firetwin.run import readers
from firetwin.shot.light import sky
from firetwin.shot.sections import TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from hypothesis import given, settings
from hypothesis import strategies as st

CAMERA = plain_samples.looking(-20.0, height=200.0, size=(640, 480))


def pixels(mask):
    return np.nonzero(mask)


@given(st.floats(-80.0, 20.0), st.floats(20.0, 90.0), st.integers(0, 47), st.integers(0, 63))
@settings(max_examples=40)
def test_a_point_at_a_pixel_projects_to_its_centre(pitch, fov, row, column):
    camera = plain_samples.looking(pitch, fov=fov)
    at = np.array([row]), np.array([column])
    point = survey.at_range(camera, *at, np.array([750.0]))
    assert np.linalg.norm(point - camera.to_world[:3, 3]) == pytest.approx(750.0)
    u, v, _ = survey.project(camera, point)
    assert (u[0], v[0]) == pytest.approx((column + 0.5, row + 0.5))


def test_points_behind_the_camera_have_no_pixel():
    u, v, depth = survey.project(CAMERA, np.array([[0.0, -100.0, 200.0]]))
    assert np.isnan(u).all()
    assert np.isnan(v).all()
    assert depth[0] < 0.0


@pytest.mark.parametrize(("east", "north"), [(0.0, 0.0), (0.4, 0.0), (-0.2, 0.5), (0.0, -0.3)])
def test_the_area_of_a_rectangle_on_a_slope_is_its_area_in_the_map(east, north):
    place = plain_samples.flat_place(ground=lambda x, y: east * x + north * y)
    camera = plain_samples.looking(-50.0, height=600.0, size=(640, 480))
    rays = plain_samples.directions(camera)
    # z + d r_z = east d r_x + north d r_y
    depth = 600.0 / (east * rays[..., 0] + north * rays[..., 1] - rays[..., 2])
    x, y = (depth * rays[..., k] for k in (0, 1))
    row, column = pixels((abs(x - 20.0) < 120.0) & (abs(y - 500.0) < 90.0))
    area = survey.ground_area(place, camera, row, column, depth[row, column])
    assert area == pytest.approx(240.0 * 180.0, rel=0.02)


def test_flat_views_have_no_area():
    place = plain_samples.flat_place()
    camera = plain_samples.looking(-3.0, height=100.0, size=(640, 480))
    sample = plain_samples.plane(camera)
    row, column = pixels((sample.depth > 1500.0) & np.isfinite(sample.depth))
    assert survey.ground_area(place, camera, row, column, sample.depth[row, column]) is None
    assert survey.ground_area(place, camera, row[:0], column[:0], row[:0]) is None


def test_heights_are_above_the_sea_and_above_the_ground():
    place = plain_samples.flat_place(ground=lambda x, _: np.full(np.shape(x), 120.0))
    point = np.array([[0.0, 0.0, 450.0]])
    assert place.height_above_sea(point) == pytest.approx(450.0)
    assert place.height_above_ground(point) == pytest.approx(330.0)
    far = np.array([[0.0, 20_000.0, 450.0]])  # the Earth curves away by d^2 / 2 R
    assert place.height_above_sea(far)[0] == pytest.approx(450.0 + 20_000.0**2 / (2 * 6.37e6), abs=0.3)


def grey(depth, contrast):
    """Make a picture whose land is darker than its sky by a contrast."""
    return np.repeat(np.where(np.isfinite(depth), 0.6 - contrast, 0.6)[..., None], 3, axis=-1)


@pytest.mark.parametrize("pitch", [-12.0, -5.0, 4.0])
def test_the_skyline_of_a_plane_is_the_horizon(pitch):
    camera = plain_samples.looking(pitch, size=(640, 480))
    depth = plain_samples.plane(camera).depth
    (line,) = survey.skyline(depth, grey(depth, 0.1), 0.02)
    level = camera.cy + camera.fy * np.tan(np.radians(pitch))
    assert line[:, 1] == pytest.approx(level, abs=1.0)
    assert (line[0, 0], line[-1, 0]) == (0.5, 639.5)


def test_a_skyline_is_divided_where_a_trunk_reaches_the_upper_edge():
    depth = plain_samples.plane(plain_samples.looking(-2.0)).depth.copy()
    depth[:, 30:33] = 8.0
    lines = survey.skyline(depth, grey(depth, 0.1), 0.02)
    assert [(line[0, 0], line[-1, 0]) for line in lines] == [(0.5, 29.5), (33.5, 63.5)]
    for alone in (np.full((48, 64), np.inf), np.full((48, 64), 10.0)):
        assert survey.skyline(alone, grey(alone, 0.1), 0.02) == []


def test_haze_that_hides_the_land_hides_the_skyline():
    depth = plain_samples.plane(plain_samples.looking(-2.0)).depth
    assert survey.skyline(depth, grey(depth, 0.01), 0.02) == []
    half = grey(depth, 0.01)
    half[:, :32] = grey(depth, 0.1)[:, :32]
    (line,) = survey.skyline(depth, half, 0.02)
    assert line[0, 0] == 0.5
    assert line[-1, 0] == pytest.approx(32.0, abs=5.0)


def seen_front(place, camera, smoky=None):
    """Return the front in a picture, without smoke by default."""
    none = np.zeros((camera.height, camera.width), bool)
    return survey.front_in_picture(place, camera, none if smoky is None else smoky)


def ring(place):
    """Make a square front of 400 m around x = 0, y = 700 m, as degrees."""
    x, y = np.array([-200.0, 200.0, 200.0, -200.0, -200.0]), np.array([500.0, 500.0, 900.0, 900.0, 500.0])
    return (plain_samples.degrees(place, x, y),)


def test_a_front_on_a_plane_is_where_its_corners_project():
    place = plain_samples.flat_place()
    place = plain_samples.flat_place(front=ring(place))
    (line,) = seen_front(place, CAMERA)
    corners = np.array([[-200.0, 500.0, 0.0], [200.0, 500.0, 0.0], [200.0, 900.0, 0.0], [-200.0, 900.0, 0.0]])
    u, v, _ = survey.project(CAMERA, corners)
    for corner in np.column_stack([u, v]):
        assert np.linalg.norm(line - corner, axis=1).min() < 1.0
    assert line[0] == pytest.approx(line[-1], abs=1e-6)
    assert len(line) <= 8


def test_terrain_hides_a_front():
    place = plain_samples.flat_place()
    # a wall of 150 m at y = 300 hides what is behind it from a camera at 200 m, up to y = 1200
    wall = plain_samples.flat_place(
        front=ring(place), ground=lambda _, y: np.where(abs(y - 300.0) < 20.0, 150.0, 0.0)
    )
    assert seen_front(wall, CAMERA) == []
    low = plain_samples.flat_place(
        front=ring(place), ground=lambda _, y: np.where(abs(y - 300.0) < 20.0, 60.0, 0.0)
    )
    assert len(seen_front(low, CAMERA)) == 1


def test_smoke_cuts_a_front():
    place = plain_samples.flat_place()
    place = plain_samples.flat_place(front=ring(place))
    smoky = np.zeros((480, 640), bool)
    smoky[:, 320:] = True
    across = np.concatenate(seen_front(place, CAMERA, smoky))[:, 0]
    assert across.max() == pytest.approx(320.0, abs=10.0)
    assert across.min() < 250.0
    assert seen_front(place, CAMERA, np.ones_like(smoky)) == []


def test_haze_cuts_a_front():
    """The visibility is 2 km: 2 % of light passes 2 km at the height of the camera."""
    haze = 3.912 / 2000.0 / (sky.HAZE * (1.0 + sky.LOW_HAZE))
    low = plain_samples.looking(-5.0, height=2.0)
    place = plain_samples.flat_place(front=ring(plain_samples.flat_place()))
    none = np.zeros((low.height, low.width), bool)
    assert air.clearness(haze, np.zeros(3), np.array([[0.0, 2000.0, 0.0]]))[0] == pytest.approx(
        0.02, rel=1e-3
    )
    assert len(survey.front_in_picture(place, low, none, haze, clearness=0.1)) == 1  # up to 900 m
    assert survey.front_in_picture(place, low, none, 5.0 * haze, clearness=0.1) == []


def test_the_edge_of_the_picture_cuts_a_front():
    place = plain_samples.flat_place()
    place = plain_samples.flat_place(front=ring(place))
    narrow = plain_samples.looking(-20.0, height=200.0, fov=20.0, size=(640, 480))
    lines = seen_front(place, narrow)
    assert len(lines) == 2  # its near and its far side
    assert all(len(line) == 2 for line in lines)
    for u, v in np.concatenate(lines):
        assert 0.0 <= u <= 640.0
        assert 0.0 <= v <= 480.0
    away = plain_samples.looking(20.0, height=200.0, fov=20.0, size=(640, 480))
    assert seen_front(place, away) == []


def test_a_front_in_degrees_is_a_geometry_of_geojson():
    place = plain_samples.flat_place()
    assert place.geojson() is None
    geometry = plain_samples.flat_place(front=ring(place)).geojson()
    assert geometry["type"] == "MultiLineString"
    ((first, *_),) = geometry["coordinates"]
    assert first == pytest.approx([-120.6 - 200.0 / 86_900, 38.8 + 500.0 / 111_010], abs=2e-4)


def circular(folder, cells, cell):
    """Make a shot of a fire that spreads as a circle, at 0.3 m/s from 60 s on."""
    fires = {"fires": ((0.0, 0.0, 60.0),), "wind": (0.0, 0.0), "speed": 0.3}
    run = readers.open(whole_run.write(folder / "run", cells=cells, cell=cell, **fires))
    terrain = TerrainSettings(near_radius=0.0, apron=500.0)
    return Shot(Settings(path=folder / "scene.toml", time=Time(frames=1), terrain=terrain), run)


@pytest.fixture
def circle(tmp_path):
    return circular(tmp_path, 80, 20.0)


def test_a_front_is_curved_within_large_cells(tmp_path):
    shot = circular(tmp_path, 16, 150.0)
    (line,) = survey.of_shot(shot, 1860.0).front
    middle = 0.5 * (line[1:] + line[:-1])
    ground = shot.bare_ground
    arrival = ground.arrival_at(*ground.indices(middle[:, 1], middle[:, 0]))
    assert np.abs(arrival - 1860.0).max() < 2.0


def test_the_front_of_a_run_is_its_circle_seen_from_above(circle):
    place = survey.of_shot(circle, 1860.0)
    camera = plain_samples.looking(-90.0, height=1500.0, fov=60.0, size=(640, 480))
    (line,) = seen_front(place, camera)
    radius = camera.fx * 0.3 * 1800.0 / 1500.0
    assert np.hypot(line[:, 0] - 320.0, line[:, 1] - 240.0) == pytest.approx(radius, rel=0.02)
    assert place.ignition == pytest.approx(60.0, abs=20.0 / 0.3)
    assert survey.of_shot(circle, 0.0).front == ()
    assert survey.of_shot(circle, 4000.0).front
    assert survey.of_shot(circle, 4300.0).front == ()  # the last cell burns from 3600 s for 10 minutes


def test_ground_far_ahead_of_the_front_does_not_burn(circle):
    place = survey.of_shot(circle, 1200.0)
    reach = 0.3 * (1200.0 - 60.0 + 600.0)
    away = np.array([0.0, 0.6, 0.95, 1.1, 1.4]) * reach
    assert place.burns(away, np.zeros(5)).tolist() == [True, True, True, False, False]


def test_a_simplified_front_deviates_by_a_few_metres(circle):
    place = survey.of_shot(circle, 1860.0)
    (line,) = place.geojson()["coordinates"]
    assert len(line) < 0.5 * len(place.front[0])
    longitude, latitude = np.array(line).T
    x, y, _ = place.georeference.frame.forward(latitude, longitude, np.zeros(len(line))).T
    assert np.hypot(x, y) == pytest.approx(540.0, rel=0.03)
