"""Tiles behind the Earth: against rays to points of their spheres, and in the choice of a shot."""

import numpy as np
import pytest
from firetwin.ellipsoid import ecef
from firetwin.tiles import cut, horizon
from firetwin.tiles.cut import Views
from firetwin.tiles.loader import Loader
from firetwin.tiles.place import ecef_to_frame
from firetwin_core import geo, lod
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from tilesets import GLB, Memory, tile, tileset

AXES = np.array([6378137.0, 6378137.0, 6356752.314245179])
FRAME = geo.LocalFrame(38.8, -120.5, 0.0)


def at(latitude, longitude, height):
    return ecef(*np.radians([latitude, longitude]), np.float64(height))


def blocked(eye, points):
    """Return True if the ellipsoid, a kilometre smaller, is between an eye and points (n, 3): quadratics."""
    axes = AXES - horizon.LOWEST
    start, way = eye / axes, (points - eye) / axes
    a = np.einsum("ni,ni->n", way, way)
    b = 2.0 * way @ start
    c = start @ start - 1.0
    root = b * b - 4.0 * a * c
    first = (-b - np.sqrt(np.maximum(root, 0.0))) / (2.0 * a)
    return (root > 0.0) & (first > 0.0) & (first < 1.0)


places = st.tuples(st.floats(-90, 90), st.floats(-180, 180), st.floats(10.0, 4e7))


@given(st.lists(places, min_size=1, max_size=3), st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=examples(150))
def test_of_a_hidden_sphere_no_point_is_seen(eyes, seed):
    rng = np.random.default_rng(seed)
    eyes = np.array([at(*each) for each in eyes])
    way = rng.normal(size=(200, 3))
    centre = way / np.linalg.norm(way, axis=1, keepdims=True) * AXES + rng.normal(0, 5e3, (200, 3))
    radius = 10.0 ** rng.uniform(1, 6, 200)
    hidden = horizon.hidden_mask(centre, radius, eyes)
    for k in np.flatnonzero(hidden):
        shell = rng.normal(size=(100, 3))
        shell *= radius[k] / np.linalg.norm(shell, axis=1, keepdims=True)
        inside = np.linalg.norm((centre[k] + shell) / (AXES - horizon.LOWEST), axis=1) <= 1.0
        for eye in eyes:
            assert (blocked(eye, centre[k] + shell) | inside).all()


@given(places, st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=examples(150))
def test_of_small_spheres_nearly_all_that_are_behind_are_hidden(eye, seed):
    rng = np.random.default_rng(seed)
    latitude, longitude = np.degrees(np.arcsin(rng.uniform(-1, 1, 500))), rng.uniform(-180, 180, 500)
    points = ecef(*np.radians([latitude, longitude]), rng.uniform(0, 3000, 500))
    place = at(*eye)
    behind = blocked(place, points)
    assert np.array_equal(horizon.hidden_mask(points, np.zeros(500), place[None]), behind)


def test_an_eye_below_the_ground_hides_nothing():
    far = at(-38.8, 59.5, 0.0)[None]
    assert not horizon.hidden_mask(far, np.ones(1), at(38.8, -120.5, -2000.0)[None])[0]
    assert horizon.hidden_mask(far, np.ones(1), at(38.8, -120.5, 2.0e6)[None])[0]
    assert not horizon.hidden_mask(far, np.ones(1), np.empty((0, 3)))[0]


def ball(latitude, longitude, radius=10_000.0):
    return {"sphere": [*at(latitude, longitude, 0.0).tolist(), radius]}


@pytest.mark.parametrize(
    ("height", "wanted"),
    [(2.0e6, ["here.glb", "near.glb"]), (4.0e7, ["here.glb", "near.glb", "wide.glb"])],
)
def test_the_far_side_of_the_earth_is_not_chosen(height, wanted):
    """Tiles 0, 20, 70 and 180 degrees away, seen from above: the horizon is 40 or 82 degrees away."""
    below = [
        tile(1.0, name, volume=ball(*place))
        for name, place in (
            ("here.glb", (38.8, -120.5)),
            ("near.glb", (18.8, -120.5)),
            ("wide.glb", (-31.2, -120.5)),
            ("behind.glb", (-38.8, 59.5)),
        )
    ]
    files = {name: GLB for name in ("here.glb", "near.glb", "wide.glb", "behind.glb")}
    files["tileset.json"] = tileset(
        tile(1e9, None, below, volume={"sphere": [0.0, 0.0, 0.0, 7.0e6]}, refine="ADD")
    )
    eye = np.array([[0.0, 0.0, height]])
    views = lod.ViewSet(eye, np.eye(3), [5.0, 5.0], above_terrain=False)
    matrix = ecef_to_frame(FRAME)
    shown = {}
    for earth in (None, matrix):
        loader = Loader(Memory(files))
        seen = Views(views, cut.pixels([1080], 5.0), eye, earth)
        choice = cut.select_tiles(loader, seen, matrix, 1e-9)
        shown[earth is None] = sorted(loader.tree.reference(k) for k in choice.contents)
    assert shown[False] == wanted
    assert "behind.glb" in shown[True], "without the horizon the far side is chosen"
