"""Web Mercator and its tiles against mercantile and PROJ."""

import math

import numpy as np
import pytest
from firetwin.geometry.mercator import forward
from firetwin.tiles.imagery import mercator

PLACES = [(38.9, -120.6), (-33.5, 151.2), (78.22, 15.65), (85.0, 179.99), (-84.99, -179.99), (0.001, -0.001)]


@pytest.mark.parametrize("level", [0, 3, 11, 19, 28])
def test_tiles_are_those_of_mercantile(level):
    mercantile = pytest.importorskip("mercantile", reason="needs mercantile")
    for latitude, longitude in PLACES:
        wanted = mercantile.tile(longitude, latitude, level)
        column, row = mercator.tile_at(latitude, longitude, level)
        assert (math.floor(column), math.floor(row)) == (wanted.x, wanted.y)
        box = mercantile.bounds(wanted)
        north, west = mercator.place_of(wanted.x, wanted.y, level)
        south, east = mercator.place_of(wanted.x + 1, wanted.y + 1, level)
        assert np.allclose((west, south, east, north), box, rtol=0.0, atol=1e-9)


def test_metres_are_those_of_proj():
    pyproj = pytest.importorskip("pyproj", reason="needs pyproj")
    to = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:3857", always_xy=True)
    latitude, longitude = np.array(PLACES).T
    assert np.allclose(forward(latitude, longitude), to.transform(longitude, latitude), atol=1e-6)
    assert pyproj.CRS("EPSG:3857").area_of_use.bounds[3] == pytest.approx(mercator.NORTHMOST, abs=0.01)


def test_a_place_comes_back_from_its_tile():
    latitude, longitude = np.array([*PLACES, (10.0, 187.5), (10.0, -190.0)]).T
    back = mercator.place_of(*mercator.tile_at(latitude, longitude, 17), 17)
    assert np.allclose(back, (latitude, longitude), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(("latitude", "level"), [(0.0, 10), (38.9, 15), (-70.0, 18)])
def test_a_texel_is_as_large_as_the_ellipsoid_says(latitude, level):
    pyproj = pytest.importorskip("pyproj", reason="needs pyproj")
    geod = pyproj.Geod(ellps="WGS84")
    column, row = mercator.tile_at(latitude, 10.0, level)
    here = mercator.place_of(column, row, level)
    across = mercator.place_of(column + 1 / 256, row, level)
    down = mercator.place_of(column, row + 1 / 256, level)
    wide, high = (geod.inv(here[1], here[0], other[1], other[0])[2] for other in (across, down))
    size = mercator.texel(latitude, level, 256)
    assert size == pytest.approx(wide, rel=1e-5)
    assert size * 0.993 < high < size * 1.0001
    assert mercator.texel(latitude, level, 512) == size / 2


def test_the_level_is_the_coarsest_that_is_fine_enough():
    for step in (0.05, 0.6, 3.0, 1000.0):
        level = mercator.level_for(step, 38.9, 256)
        assert mercator.texel(38.9, level, 256) <= step < mercator.texel(38.9, level - 1, 256)
    assert mercator.level_for(1.0e9, 38.9, 256) == 0
    assert mercator.level_for(mercator.texel(38.9, 12, 256), 38.9, 256) == 12
