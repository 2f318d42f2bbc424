"""Georeference of exports, against pyproj, PROJ's reading of the WKT, and pymap3d."""

import json

import numpy as np
import pymap3d
import pytest
from firetwin.shot import georeference
from firetwin.shot.georeference import Georeference
from firetwin_core import geo
from pyproj import CRS, Transformer

LOCAL = np.array([[0.0, 0.0, 0.0], [1500.0, -2000.0, 900.0], [-25_000.0, 18_000.0, 2500.0]])
ECEF = Transformer.from_crs(4979, 4978)


@pytest.fixture(params=[0.0, -24.9, 48.0])
def place(request):
    return Georeference(geo.LocalFrame(38.77, -120.53, 0.0), request.param, "a test")


def test_geodetic_positions_agree_with_proj_in_earth_centred_metres(place):
    geodetic = place.geodetic(LOCAL)
    np.testing.assert_allclose(place.ecef(LOCAL), np.transpose(ECEF.transform(*geodetic.T)), atol=1e-6)
    np.testing.assert_allclose(place.local(geodetic), LOCAL, atol=1e-6)
    latitude, longitude, height = pymap3d.enu2geodetic(*LOCAL.T, place.latitude, place.longitude, 0.0)
    expected = np.column_stack([latitude, longitude, height + place.geoid_m])
    assert (np.abs(geodetic - expected) < [1e-10, 1e-10, 1e-6]).all()


def test_the_matrix_is_the_frame_that_proj_reads_from_the_wkt(place):
    by_matrix = LOCAL @ place.matrix[:3, :3].T + place.matrix[:3, 3]
    by_proj = Transformer.from_crs(CRS.from_wkt(place.wkt), 4978).transform(*LOCAL.T)
    np.testing.assert_allclose(by_matrix, np.transpose(by_proj), atol=1e-6)
    np.testing.assert_allclose(place.matrix[:3, :3].T @ place.matrix[:3, :3], np.eye(3), atol=1e-15)


def test_matrix_and_geodetic_positions_differ_by_the_geoid_over_the_radius(place):
    by_matrix = LOCAL @ place.matrix[:3, :3].T + place.matrix[:3, 3]
    away = np.linalg.norm(by_matrix - place.ecef(LOCAL), axis=1)
    expected = abs(place.geoid_m) * np.hypot(*LOCAL[:, :2].T) / 6.371e6
    np.testing.assert_allclose(away, expected, rtol=0.01, atol=1e-6)


def test_the_file_has_the_heights_and_the_matrix(place, tmp_path):
    found = json.loads(place.write(tmp_path).read_text())
    assert found["ellipsoidal_height_m"] == found["model_height_m"] + found["geoid_m"] == place.geoid_m
    np.testing.assert_array_equal(found["local_to_ecef"], place.matrix)
    assert CRS.from_wkt(found["wkt"]).to_wkt()


class FakeShot:
    """Shot with heights and settings alone."""

    def __init__(self, vertical="orthometric", geoid=None):
        tiles = type("Tiles", (), {"geoid": geoid})
        self.run = type("Run", (), {"vertical": vertical})
        self.settings = type("Settings", (), {"tiles": tiles})
        self.local_frame = geo.LocalFrame(38.77, -120.53, 0.0)


def test_the_geoid_is_that_of_the_command_line_then_of_the_scene_then_of_a_grid(monkeypatch):
    grid = type("Grid", (), {"plane": lambda self, frame: (-24.0, 0.0, 0.0)})
    monkeypatch.setattr(georeference.geoid, "find", grid)
    both = georeference.resolve(FakeShot(geoid=-20.0), -22.0)
    assert (both.geoid_m, both.source) == (-22.0, "--geoid")
    assert georeference.resolve(FakeShot(geoid=-20.0)).geoid_m == -20.0
    assert georeference.resolve(FakeShot()).geoid_m == -24.0
    ellipsoidal = georeference.resolve(FakeShot("ellipsoidal", -20.0), -22.0)
    assert (ellipsoidal.offset, ellipsoidal.height, ellipsoidal.above_sea(5.0)) == (0.0, 0.0, 27.0)
    monkeypatch.setattr(georeference.geoid, "find", lambda: None)
    unknown = georeference.resolve(FakeShot())
    assert (unknown.geoid_m, unknown.source) == (0.0, georeference.UNKNOWN)
