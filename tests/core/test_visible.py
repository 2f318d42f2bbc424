"""What a camera path sees: nothing that is visible may be left out."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import lod
from firetwin_core.geo import HeightField
from hypothesis import given, settings
from hypothesis import strategies as st

SQUARE = (np.pi / 2, np.pi / 2)
DOWN = np.eye(3)  # a camera without rotation looks down
NORTH = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)  # -z of the camera is +y of the world


def seen(position, camera=((0, 0, 0),), rotation=NORTH, radius=0.0, fov=SQUARE, **options):
    return lod.seen(
        np.atleast_2d(position), radius, camera, rotation, fov, **{"margin": 0.0} | options
    ).tolist()


@pytest.mark.parametrize(
    ("place", "visible"),
    [
        ((0, 10, 0), True),
        ((0, -10, 0), False),
        ((9.99, 10, 0), True),
        ((10.01, 10, 0), False),
        ((0, 10, -9.99), True),
        ((0, 10, 10.01), False),
        ((0, 0.05, 0), False),  # nearer than 0.1 m
        ((0, 1e7, 0), True),
    ],
)
def test_limits_of_the_pyramid(place, visible):
    assert seen(place) == [[0, 0] if visible else [-1, -1]]
    turned = (np.array(place) @ NORTH) @ DOWN.T  # the same seen by a camera that looks down
    assert seen(turned, rotation=DOWN) == seen(place)


def test_radius_margin_near_and_far():
    assert seen((10.01, 10, 0), radius=0.01) == [[0, 0]]
    assert seen((10.01, 10, 0), margin=0.01) == [[0, 0]]
    assert seen((0, 10, 0), far=9.0) == [[-1, -1]]
    assert seen((0, 10, 0), far=9.0, radius=1.0) == [[0, 0]]
    assert seen((0, 10, 0), near=10.5) == [[-1, -1]]


def test_a_camera_on_or_in_a_ball_sees_it():
    assert seen((0, 0, 0), near=0.0) == [[0, 0]]
    assert seen((0, 0, 0), radius=0.2) == [[0, 0]]
    assert seen((0, -1, 0), radius=1.2) == [[0, 0]]


def test_first_and_last_view():
    camera = [(x, 0, 0) for x in (-50, -5, 0, 5, 50, 3, np.nan)]
    assert seen((0, 10, 0), camera=camera) == [[1, 5]]


def test_what_is_not_a_number():
    assert seen((np.nan, 10, 0)) == [[-1, -1]]
    assert seen((0, 10, 0), radius=np.nan) == [[-1, -1]]
    assert seen((0, 10, 0), camera=[(np.nan, 0, 0)]) == [[-1, -1]]
    assert seen((0, 10, 0), rotation=np.full((3, 3), np.nan)) == [[-1, -1]]
    assert seen((0, 10, 0), fov=(np.nan, 1)) == [[-1, -1]]
    assert seen(np.empty((0, 3))) == []
    assert seen((0, 10, 0), camera=np.empty((0, 3))) == [[-1, -1]]


@pytest.mark.parametrize(
    "options", [{"fov": (0, 1)}, {"fov": (1, 4)}, {"radius": -1}, {"margin": -1}, {"near": np.nan}]
)
def test_impossible_views(options):
    with pytest.raises(ValueError, match=next(iter(options))):
        seen((0, 10, 0), **options)


def random_rotation(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_every_ball_with_a_point_on_the_picture_is_kept(seed):
    """Points of balls are projected the plain way; if one is on the picture, its ball is seen."""
    rng = np.random.default_rng(seed)
    centre, radius = rng.uniform(-100, 100, (200, 3)), rng.uniform(0, 30, 200)
    rotation, fov = random_rotation(rng), rng.uniform(0.2, 2.5, 2)
    inside = rng.normal(size=(200, 3))
    point = (
        centre + inside / np.linalg.norm(inside, axis=1)[:, None] * (radius * rng.uniform(0, 1, 200))[:, None]
    )
    x, y, z = (point @ rotation).T
    on_picture = (-z > 0.1) & (np.abs(x) < -z * np.tan(fov[0] / 2)) & (np.abs(y) < -z * np.tan(fov[1] / 2))
    found = lod.seen(centre, radius, [(0, 0, 0)], rotation, fov, margin=0.0)[:, 0] >= 0
    assert (found | ~on_picture).all()
    assert found.sum() < 200


def wall(height=50.0):
    """Flat ground with a wall along x between y = 100 and 120."""
    y = np.arange(-200, 401, 10.0)
    h = np.where((y >= 100) & (y <= 120), height, 0.0)
    return HeightField(np.arange(-300, 301, 10.0), y, np.repeat(h[:, None], 61, axis=1))


@pytest.mark.parametrize(
    ("place", "radius", "visible"),
    [
        ((0, 90, 5), 5, True),
        ((0, 200, 5), 5, False),
        ((0, 200, 5), 100, True),
        ((0, 200, 100), 5, True),
        ((0, 200, 78), 5, False),
        ((0, 110, 55), 5.0, True),
        ((0, 390, 5), 5, False),
    ],
)
def test_a_wall_hides_what_is_behind_it(place, radius, visible):
    assert (seen(place, camera=[(0, 0, 10)], radius=radius, ground=wall())[0][0] == 0) == visible
    assert seen(place, camera=[(0, 0, 10)], radius=radius)[0][0] == 0


def test_what_hides_nothing():
    behind = (0, 200, 5)
    assert seen(behind, camera=[(0, 0, -1)], radius=1, ground=wall()) == [[0, 0]]  # in the ground
    holes = HeightField([-300, 300], [-200, 400], [[np.nan, 99], [99, 99]])
    assert seen(behind, camera=[(0, 0, 10)], radius=1, ground=holes) == [[0, 0]]
    outside = HeightField([1000, 1300], [-200, 400], np.full((2, 2), 99.0))
    assert seen(behind, camera=[(0, 0, 10)], radius=1, ground=outside) == [[0, 0]]


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_no_ball_in_sight_is_called_hidden(seed):
    """If a finely sampled straight line to some point of a ball clears the ground, it is seen."""
    rng = np.random.default_rng(seed)
    axis = np.linspace(0, 1000, 26)
    ground = HeightField(axis, axis, rng.uniform(0, 120, (26, 26)))
    camera = np.array([500.0, 5.0, 0.0])
    camera[2] = ground.at([camera[:2]])[0] + rng.uniform(1, 60)
    centre = np.column_stack([rng.uniform(20, 980, 40), rng.uniform(60, 980, 40), np.zeros(40)])
    radius = rng.uniform(0, 30, 40)
    centre[:, 2] = ground.at(centre[:, :2]) + rng.uniform(-5, 10, 40)
    found = lod.seen(centre, radius, [camera], NORTH, (3.0, 3.0), margin=0.0, ground=ground)[:, 0] >= 0
    t = np.linspace(0, 1, 2000)[1:, None]
    for i in range(40):
        for direction in (*np.eye(3), *-np.eye(3), np.zeros(3)):
            point = centre[i] + radius[i] * direction
            line = camera + t * (point - camera)
            clear = (line[:, 2] > ground.at(line[:, :2])).all()
            assert found[i] or not clear


def test_ridges_do_hide():
    axis = np.linspace(0, 10_000, 145)
    x, y = np.meshgrid(axis, axis)
    height = 100 * (1 + np.sin(y / 300))
    ground = HeightField(axis, axis, height)
    places = np.column_stack([x.ravel(), y.ravel(), height.ravel()])
    camera = [(5000, 10, 130)]
    near = lod.seen(places, 10.0, camera, NORTH, SQUARE, ground=ground)[:, 0] >= 0
    every = lod.seen(places, 10.0, camera, NORTH, SQUARE)[:, 0] >= 0
    assert near.sum() < 0.35 * every.sum()
    assert every.mean() > 0.5


def test_threads_do_not_matter(all_threads):
    rng = np.random.default_rng(2)
    ground = HeightField(np.arange(50) * 20.0, np.arange(50) * 20.0, rng.uniform(0, 99, (50, 50)))
    places, cameras = rng.uniform(0, 980, (2000, 3)), rng.uniform(100, 900, (20, 3))
    results = []
    for threads in (1, 4):
        core.set_threads(threads)
        results.append(lod.seen(places, 3.0, cameras, NORTH, (1.0, 0.6), ground=ground))
    np.testing.assert_array_equal(*results)
