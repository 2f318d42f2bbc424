"""Frustum and occlusion culling of bounding spheres: nothing that is visible may be left out."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import lod
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

NORTH = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)  # -z of the camera is +y of the world
SQUARE = (1.0, 1.0)


def seen(place, radius=0.0, camera=((0, 0, 0),), rotation=NORTH, half=SQUARE, views=None, **asked):
    return lod.visible_mask(
        np.atleast_2d(place), radius, lod.ViewSet(camera, rotation, half, **(views or {})), **asked
    ).tolist()


def test_radius_margin_and_max_distance():
    assert seen((10.01, 10, 0), radius=0.01) == [True]
    assert seen((10.01, 10, 0), margin=0.01) == [True]
    assert seen((0, 10, 0), max_distance=9.0) == [False]
    assert seen((0, 10, 0), max_distance=9.0, radius=1.0) == [True]
    assert seen((0, -1, 0), radius=1.2) == [True]


def test_a_ball_without_numbers_is_never_seen_and_no_view_sees_nothing():
    assert seen([(np.nan, 10, 0), (0, 10, 0)]) == [False, True]
    assert seen([(0, 10, 0)] * 2, radius=[np.nan, 1]) == [False, True]
    assert seen((0, 10, np.inf)) == [False]
    assert seen(np.empty((0, 3))) == []
    assert seen((0, 10, 0), camera=np.empty((0, 3)), rotation=np.empty((0, 3, 3)), half=np.empty((0, 2))) == [
        False
    ]
    assert lod.distance([(0, 0, 0)], lod.ViewSet(np.empty((0, 3)), NORTH, SQUARE)).tolist() == [np.inf]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("half", (0, 1)),
        ("half", (1, np.inf)),
        ("half", (np.nan, 1)),
        ("camera", [(np.nan, 0, 0)]),
        ("rotation", 2.0 * NORTH),
        ("rotation", np.full((3, 3), np.nan)),
    ],
)
def test_impossible_views(name, value):
    with pytest.raises(ValueError, match=name):
        seen((0, 10, 0), **{name: value})


@pytest.mark.parametrize(
    ("name", "value"), [("sun", (0, 0, 2)), ("sun", (0, 0, np.nan)), ("lowest_terrain", np.nan)]
)
def test_impossible_light(name, value):
    with pytest.raises(ValueError, match=name):
        seen((0, 10, 0), views={name: value})


@pytest.mark.parametrize(
    "asked", [{"radius": -1}, {"margin": -1}, {"max_distance": np.nan}, {"margin": np.nan}]
)
def test_impossible_questions(asked):
    with pytest.raises(ValueError, match=next(iter(asked))):
        seen((0, 10, 0), **asked)


@pytest.mark.parametrize(
    "nodes", [np.zeros((1, 2, 3)), np.zeros((2, 2, 3)), np.full((2, 2, 3), np.nan), np.zeros((2, 2))]
)
def test_impossible_ground(nodes):
    with pytest.raises(ValueError, match="position"):
        lod.Occluder(nodes)


def flight(rng, frames, turns, length, parallel=False):
    """Cameras (frames, 3), rotations and halves of a winding flight that looks all over."""
    t = np.linspace(0.0, 1.0, frames)
    camera = length * np.stack([t, np.sin(5 * t), 0.1 * np.cos(9 * t)], axis=-1)
    angle = rng.uniform(0, 6) + 2 * np.pi * turns * t
    back = -np.stack([np.cos(angle), np.sin(angle), -0.4 - 0.3 * np.sin(3 * angle)], axis=-1)
    back /= np.linalg.norm(back, axis=1, keepdims=True)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    rotation = np.stack([right, np.cross(back, right), back], axis=-1)
    return camera, rotation, np.array([3000.0, 1500.0] if parallel else [0.6, 0.35])


def in_a_frame(place, camera, rotation, half, parallel, max_distance=np.inf):
    """Find points in the picture of any frame, each projected into every frame."""
    visible = np.zeros(len(place), bool)
    for eye, axes in zip(camera, rotation, strict=True):
        x, y, z = ((place - eye) @ axes).T
        scale = 1.0 if parallel else -z
        inside = (-z > 0) & (np.abs(x) < scale * half[0]) & (np.abs(y) < scale * half[1])
        visible |= inside & (parallel | (np.linalg.norm(place - eye, axis=1) < max_distance))
    return visible


paths = st.tuples(
    st.sampled_from([1, 2, 5, 64, 65, 300]), st.floats(0, 4), st.floats(0, 30_000), st.booleans()
)


@settings(deadline=None, max_examples=examples(60))
@given(st.integers(0, 2**32 - 1), paths)
def test_every_ball_with_a_point_in_a_picture_is_seen(seed, path):
    rng = np.random.default_rng(seed)
    frames, turns, length, parallel = path
    camera, rotation, half = flight(rng, frames, turns, length, parallel)
    centre = rng.uniform(-20_000, 40_000, (1500, 3)) * [1, 1, 0.1]
    radius = rng.uniform(0, 300, 1500)
    off = rng.normal(size=(1500, 3))
    point = centre + off * (radius * rng.uniform(0, 1, 1500) / np.linalg.norm(off, axis=1))[:, None]
    views = lod.ViewSet(camera, rotation, half, orthographic=parallel)
    for reach in (np.inf, 9000.0):
        found = lod.visible_mask(centre, radius, views, max_distance=reach)
        assert (found | ~in_a_frame(point, camera, rotation, half, parallel, reach)).all()


@settings(deadline=None, max_examples=examples(30))
@given(st.integers(0, 2**32 - 1), paths)
def test_points_are_seen_exactly(seed, path):
    """A ball of no radius is in a picture or not: no frame of a long path is blurred into others."""
    rng = np.random.default_rng(seed)
    frames, turns, length, parallel = path
    camera, rotation, half = flight(rng, frames, turns, length, parallel)
    place = rng.uniform(-20_000, 40_000, (2000, 3)) * [1, 1, 0.1]
    found = lod.visible_mask(place, 0.0, lod.ViewSet(camera, rotation, half, orthographic=parallel))
    assert (found != in_a_frame(place, camera, rotation, half, parallel)).mean() < 1e-3  # on an edge


@settings(deadline=None, max_examples=examples(30))
@given(st.integers(0, 2**32 - 1), paths)
def test_distances_are_those_from_the_nearest_frame(seed, path):
    rng = np.random.default_rng(seed)
    camera, rotation, half = flight(rng, *path[:3])
    place = rng.uniform(-5000, 9000, (300, 3))
    true = np.linalg.norm(place[:, None] - camera[None], axis=2).min(axis=1)
    assert lod.distance(place, lod.ViewSet(camera, rotation, half)) == pytest.approx(true, rel=1e-12)
    assert np.isinf(lod.distance(place, lod.ViewSet(camera, rotation, half, orthographic=True))).all()


def surface(x, y, z):
    """(ny, nx, 3) places over axes."""
    return np.stack([*np.meshgrid(x, y), np.broadcast_to(z, (len(y), len(x)))], axis=-1)


def wall(height=50.0):
    """Flat ground with a wall along x between y = 100 and 120."""
    y = np.arange(-200, 401, 10.0)
    h = np.where((y >= 100) & (y <= 120), height, 0.0)
    return lod.Occluder(surface(np.arange(-300, 301, 10.0), y, h[:, None]))


@pytest.mark.parametrize(
    ("place", "radius", "visible"),
    [
        ((0, 90, 5), 5, True),
        ((0, 200, 5), 5, False),
        ((0, 200, 5), 100, True),
        ((0, 200, 100), 5, True),
        ((0, 200, 70), 5, False),
        ((0, 110, 55), 5.0, True),
        ((0, 390, 5), 5, False),
        ((0, 60, -30), 5, False),  # in the ground
    ],
)
def test_a_wall_hides_what_is_behind_it(place, radius, visible):
    eye = {"camera": [(0, 0, 10)], "radius": radius}
    assert seen(place, views={"occluder": wall()}, **eye) == [visible]
    assert seen(place, **eye) == [True]
    assert seen(place, views={"occluder": wall(), "above_terrain": False}, **eye) == [True]


def test_beyond_the_ground_nothing_is_hidden():
    behind = (0, 500, 5)
    assert seen(behind, radius=1, camera=[(0, 0, 10)], views={"occluder": wall()}) == [False]
    outside = lod.Occluder(surface([1000, 1300], [-200, 400], 99.0))
    assert seen(behind, radius=1, camera=[(0, 0, 10)], views={"occluder": outside}) == [True]


@pytest.mark.parametrize("radius", [0.0, 4.0, 15.0, 40.0])
@pytest.mark.parametrize("column", range(18, 23))
def test_what_lies_along_a_gorge_is_seen(column, radius):
    """The ground is as high as its lowest place below a ball, however far the rock around is above that."""
    x = 20.0 * (np.arange(41) - column)
    gorge = surface(x, np.arange(-100, 2101, 20.0), np.where(x == 0.0, 0.0, 200.0))
    place = (0.0, 1500.0, 10.0)
    eye = {"camera": [(0.0, 0.0, 10.0)], "radius": radius}
    assert seen(place, views={"occluder": lod.Occluder(gorge)}, **eye) == [True]
    beside = (120.0, 1500.0, 10.0)
    assert seen(beside, views={"occluder": lod.Occluder(gorge)}, **eye) == [False]


def hills(rng, columns=26, size=1000.0):
    """Rough ground over a grid that is neither straight nor regular."""
    axis = np.linspace(0, size, columns)
    nodes = surface(axis, axis, rng.uniform(0, 120, (columns, columns)))
    nodes[..., 0] += 0.1 * nodes[..., 1] + 8.0 * np.sin(nodes[..., 1] / 130)
    nodes[..., 1] += 6.0 * np.cos(nodes[..., 0] / 90)
    return nodes


def ray_is_free(nodes, start, ends):
    """Return True if segments from a point to others (n, 3) hit no triangle (Moeller, Trumbore)."""
    a, b = nodes[:-1, :-1].reshape(-1, 3), nodes[:-1, 1:].reshape(-1, 3)
    c, d = nodes[1:, 1:].reshape(-1, 3), nodes[1:, :-1].reshape(-1, 3)
    corner = np.concatenate([a, a])
    one, two = np.concatenate([b, c]) - corner, np.concatenate([c, d]) - corner
    free = np.ones(len(ends), bool)
    for i, way in enumerate(ends - start):
        p = np.cross(way, two)
        scale = np.einsum("ij,ij->i", one, p)
        scale = np.where(scale == 0.0, np.nan, scale)
        from_corner = start - corner
        u = np.einsum("ij,ij->i", from_corner, p) / scale
        q = np.cross(from_corner, one)
        v, t = q @ way / scale, np.einsum("ij,ij->i", two, q) / scale
        with np.errstate(invalid="ignore"):
            free[i] = not np.any((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < 1))
    return free


@settings(deadline=None, max_examples=examples(25))
@given(st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_no_ball_in_sight_is_called_hidden(seed, frames):
    """Rays to points of balls that meet no triangle of the ground: such balls are seen."""
    rng = np.random.default_rng(seed)
    nodes = hills(rng)
    camera = np.column_stack([rng.uniform(300, 700, frames), rng.uniform(80, 120, frames), np.zeros(frames)])
    for eye in camera:
        gap = np.hypot(nodes[..., 0] - eye[0], nodes[..., 1] - eye[1])
        eye[2] = nodes[..., 2][gap < 90].max() + rng.uniform(0.1, 60)
    inner = nodes[4:-1, 1:-1].reshape(-1, 3)
    centre = inner[rng.choice(len(inner), 60, replace=False)] + rng.uniform(-20, 20, (60, 3))
    radius = rng.uniform(0, 30, 60)
    views = lod.ViewSet(camera, NORTH, (20.0, 20.0), occluder=lod.Occluder(nodes))
    found = lod.visible_mask(centre, radius, views)
    for eye in camera:
        for direction in (*np.eye(3), *-np.eye(3), np.zeros(3)):
            point = centre + radius[:, None] * direction
            before = in_a_frame(point, [eye], [NORTH], (20.0, 20.0), False)
            assert (found | ~(before & ray_is_free(nodes, eye, point))).all()


def test_ridges_do_hide():
    axis = np.linspace(0, 10_000, 145)
    nodes = surface(axis, axis, 100 * (1 + np.sin(axis / 300))[:, None])
    places = nodes.reshape(-1, 3)
    eye = {"camera": [(5000, 10, 130)], "radius": 10.0}
    near = np.array(seen(places, views={"occluder": lod.Occluder(nodes)}, **eye))
    every = np.array(seen(places, **eye))
    assert near.sum() < 0.35 * every.sum()
    assert every.mean() > 0.5
    assert not (near & ~every).any()


def slope(up):
    """Unit vector to a sun in the west, `up` degrees high."""
    up = np.radians(up)
    return (-np.cos(up), 0.0, np.sin(up))


@pytest.mark.parametrize(("height", "counts"), [(60.0, True), (0.5, False), (-20.0, False)])
def test_what_shadows_the_view_counts(height, counts):
    """A sphere next to the view, whose shadow falls 3 km further east into it."""
    views = {"camera": [(0, 0, 1000)], "half": np.tan(np.radians((30, 20)))}
    blocked = (-6000.0, 6000.0, 1000.0 + 6000.0 * np.tan(np.radians(max(height, 0.0))))
    assert seen(blocked, 100.0, views={"sun": slope(height)}, shadows=True, **views) == [counts]
    assert seen(blocked, 100.0, views={"sun": slope(height)}, **views) == [False]
    away = slope(height) * np.array([-1.0, 1.0, 1.0])
    assert seen(blocked, 100.0, views={"sun": away}, shadows=True, **views) == [False]


def test_shadows_end_on_the_ground():
    views = {"camera": [(0, 0, 1000)], "half": np.tan(np.radians((30, 20))), "shadows": True}
    beside = (-6000.0, 5000.0, 3500.0)  # its shadow is at x = -4000 at height 1500, at -2500 at 0
    assert seen(beside, 100.0, views={"sun": slope(45)}, **views) == [True]
    assert seen(beside, 100.0, views={"sun": slope(45), "lowest_terrain": 1500.0}, **views) == [False]
    axis = np.linspace(-20_000, 20_000, 81)
    level = lod.Occluder(surface(axis, axis, 1500.0))
    assert seen(beside, 100.0, views={"sun": slope(45), "occluder": level}, **views) == [False]


@settings(deadline=None, max_examples=examples(40))
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 3, 40]))
def test_no_shadow_slips_through(seed, frames):
    """Spheres up the sun's rays from a point in a narrow view count; not all others do.

    The worst of 1500 seeds count 0.37, 0.68 and 0.97 of the others, for 1, 3 and 40 frames.
    """
    rng = np.random.default_rng(seed)
    half = np.tan(np.radians([0.75, 0.5]))
    camera = np.array([[300.0 * i, 0.0, 1000.0] for i in range(frames)])
    suns = rng.normal(size=3) + 0.2 * rng.normal(size=(frames, 3))
    suns[:, 2] = np.abs(suns[:, 2]) + 0.05
    suns /= np.linalg.norm(suns, axis=1, keepdims=True)
    views = lod.ViewSet(camera, NORTH, half, sun=suns, lowest_terrain=-1000.0)
    frame = rng.integers(frames, size=300)
    depth = rng.uniform(0.0, 20_000.0, 300)
    side = depth[:, None] * half * rng.uniform(-1.0, 1.0, (300, 2))
    place = camera[frame] + np.column_stack([side[:, 0], depth, side[:, 1]])
    off = rng.normal(size=(300, 3))
    off *= (rng.uniform(0.0, 400.0, 300) / np.linalg.norm(off, axis=1))[:, None]
    thrown = place + rng.uniform(0.0, 30_000.0, (300, 1)) * suns[frame] + off
    assert lod.visible_mask(thrown, 400.0, views, shadows=True).all()
    anywhere = rng.uniform((-20e3, -20e3, 0), (20e3, 20e3, 9e3), (300, 3))
    assert lod.visible_mask(anywhere, 40.0, views, shadows=True).mean() < {1: 0.5, 3: 0.8, 40: 0.99}[frames]


def test_tiles_and_threads_do_not_matter(all_threads):
    rng = np.random.default_rng(2)
    nodes = hills(rng, 50, 3000.0)
    places, radius = rng.uniform(0, 3000, (4000, 3)) * [1, 1, 0.05], rng.uniform(0, 9, 4000)
    camera, rotation, half = flight(rng, 30, 1.0, 2500.0)
    camera[:, 2] = 200.0
    views = lod.ViewSet(camera, rotation, half, sun=slope(30), occluder=lod.Occluder(nodes))
    results = []
    for threads in (1, 4):
        core.set_threads(threads)
        results.append(lod.visible_mask(places, radius, views, shadows=True))
    np.testing.assert_array_equal(*results)
    assert 0.02 < results[0].mean() < 0.98
    alone = [
        lod.visible_mask([place], r, views, shadows=True)[0] for place, r in zip(places, radius, strict=True)
    ]
    np.testing.assert_array_equal(results[0], alone)
