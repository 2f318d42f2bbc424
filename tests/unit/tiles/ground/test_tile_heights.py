"""Heights of tiles: the highest surface of triangles on a grid, and an elevation model made of it."""

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run.opening import open as open_run
from firetwin.shot.terrain import tile_heights
from firetwin.tiles.decoded import Decoded, TileSummary
from firetwin_core import geo, tiles
from hypothesis import given
from hypothesis import strategies as st

FRAME = geo.LocalFrame(38.9, -120.5, 0.0)


def tile(position, triangle, origin=(0.0, 0.0, 0.0)):
    position = np.asarray(position, np.float32)
    count = len(position)
    return Decoded(
        origin=np.asarray(origin, float),
        position=position,
        normal=np.zeros((count, 3), np.float32),
        uv=np.zeros((count, 2), np.float32),
        colour=np.zeros((0, 4), np.float32),
        triangle=np.asarray(triangle, np.int32),
        material_index=np.zeros(len(triangle), np.int32),
        materials=(),
        about=TileSummary(count, len(triangle), 0, 0.0, ""),
    )


def highest(position, triangles, x, y):
    """Height of the highest triangle over a point, by solving for each; NaN without."""
    top = np.nan
    for corners in position[triangles]:
        matrix = np.vstack([corners[:, :2].T, np.ones(3)])
        if abs(np.linalg.det(matrix)) < 1e-9:
            continue
        weight = np.linalg.solve(matrix, [x, y, 1.0])
        if weight.min() >= -1e-9:
            top = np.fmax(top, weight @ corners[:, 2])
    return top


@given(st.integers(0, 10_000))
def test_heights_are_those_of_the_highest_triangle(seed):
    rng = np.random.default_rng(seed)
    position = np.column_stack([rng.uniform(-2, 12, (9, 2)), rng.uniform(-5, 5, 9)])
    triangles = rng.integers(0, 9, (6, 3))
    surface = tiles.HeightMap((0.0, 0.0), 1.0, 8, 10)
    surface.add(position, (0.0, 0.0, 0.0), triangles)
    expected = [[highest(position, triangles, x, y) for x in range(10)] for y in range(8)]
    assert np.allclose(surface.height, expected, atol=1e-4, equal_nan=True)


def test_a_vertex_that_does_not_exist_is_an_error():
    surface = tiles.HeightMap((0.0, 0.0), 1.0, 2, 2)
    with pytest.raises(IndexError, match="does not exist"):
        surface.add(np.zeros((3, 3)), (0.0, 0.0, 0.0), [[0, 1, 3]])
    with pytest.raises(ValueError, match="step"):
        tiles.HeightMap((0.0, 0.0), 0.0, 2, 2)


def test_a_level_surface_has_its_height_at_60_km():
    """A surface of 700 m above the ellipsoid, far from the origin, where verticals lean by half a degree."""
    axis = np.linspace(-300.0, 300.0, 25)
    east, north = (v.ravel() for v in np.meshgrid(axis + 45_000.0, axis + 40_000.0))
    latitude, longitude, _ = FRAME.reverse(np.column_stack([east, north, np.full(len(east), 400.0)]))
    place = FRAME.forward(latitude, longitude, np.full(len(east), 700.0))
    number = np.arange(25 * 25).reshape(25, 25)
    low, right, up, far = (
        v.ravel() for v in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:])
    )
    triangles = np.vstack([np.column_stack([low, right, up]), np.column_stack([right, far, up])])
    origin = np.round(place.mean(axis=0))
    model = tile_heights.TileHeights(FRAME, tile_heights.rasterise([tile(place - origin, triangles, origin)]))
    west, south, east_, north_ = model.bounds
    middle = 0.5 * (south + north_), 0.5 * (west + east_)
    found = model.on_grid(np.array([middle[0] - 1e-3, middle[0]]), np.array([middle[1], middle[1] + 1e-3]))
    assert np.abs(found - 700.0).max() < 0.01
    beyond = model.on_grid(np.array([south - 0.01, south - 0.005]), np.array([west, west + 0.001]))
    assert np.isnan(beyond).all()
    assert model.overlaps(np.array([south, north_]), np.array([west, east_]))
    assert not model.overlaps(np.array([south - 1.0, south - 0.5]), np.array([west, east_]))


def test_a_surface_comes_back_as_it_was_written(tmp_path, make_run):
    rng = np.random.default_rng(2)
    height = rng.uniform(900, 1000, (30, 40)).astype(np.float32)
    height[:3] = np.nan
    shown = rng.integers(0, 3, height.shape).astype(np.uint8)
    ground = np.where(shown > 0, height - 7.5, height)
    surface = tile_heights.Surface(np.array([3.0, -4.0]), 2.5, height, ground, shown)
    tile_heights.write(tmp_path / "x.npz", surface)
    found = tile_heights.read(tmp_path / "x.npz", open_run(make_run())).surface
    assert (found.low == surface.low).all()
    assert found.step == 2.5
    assert np.array_equal(found.height, height, equal_nan=True)
    np.testing.assert_allclose(found.ground, ground, atol=1e-4)
    assert (found.shown == shown).all()


def test_damaged_heights_are_named(tmp_path):
    (tmp_path / "x.npz").write_bytes(b"PK\3\4 no")
    with pytest.raises(InputError, match=r"x\.npz"):
        tile_heights.read(tmp_path / "x.npz", None)
