"""Earth-centred places of tiles in the local frame, against GeographicLib and PROJ."""

import numpy as np
import pytest
from firetwin import ellipsoid
from firetwin.tiles import place, volumes
from firetwin_core import geo
from pyproj import Transformer

ORIGIN = (38.95, -120.55, 0.0)


def corners(height=1500.0):
    """Corners (n, 3) of boxes of tiles up to 60 km around, latitude, longitude (degrees) and height."""
    offset = np.linspace(-0.54, 0.54, 13)  # 60 km north and south
    lat, lon, up = np.meshgrid(ORIGIN[0] + offset, ORIGIN[1] + 1.28 * offset, [-100.0, height], indexing="ij")
    return np.column_stack([lat.ravel(), lon.ravel(), up.ravel()])


def test_places_are_those_of_geographiclib_and_proj_within_4_mm_at_60_km():
    """In float32 at the end, as Blender holds them."""
    frame = geo.LocalFrame(*ORIGIN)
    lat, lon, height = corners().T
    x, y, z = Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True).transform(lon, lat, height)
    matrix = place.ecef_to_frame(frame)
    positions = np.column_stack([x, y, z]) @ matrix[:3, :3].T + matrix[:3, 3]
    expected = frame.forward(lat, lon, height)  # GeographicLib's LocalCartesian
    assert np.abs(expected[:, :2]).max() > 59_000
    assert np.abs(positions - expected).max() < 1e-7
    topocentric = f"+proj=topocentric +ellps=WGS84 +lat_0={ORIGIN[0]} +lon_0={ORIGIN[1]} +h_0=0"
    pipeline = f"+proj=pipeline +step +proj=cart +ellps=WGS84 +step {topocentric}"
    by_proj = Transformer.from_pipeline(pipeline).transform(
        np.radians(lon), np.radians(lat), height, radians=True
    )
    assert np.abs(positions - np.column_stack(by_proj)).max() < 1e-6
    assert np.abs(positions.astype(np.float32) - expected).max() <= 4e-3


def test_boxes_of_tiles_with_transforms_keep_4_mm():
    """A tile's own frame on the Earth, as tilesets have it, times ours: the product is made in float64."""
    frame = geo.LocalFrame(*ORIGIN)
    for lat, lon, height in corners()[::29]:
        there = np.eye(4)
        there[:3, :3] = ellipsoid.enu_axes(np.radians(lat), np.radians(lon)).T
        there[:3, 3] = ellipsoid.ecef(*np.radians([lat, lon]), np.float64(height))
        product = place.ecef_to_frame(frame) @ there
        local = np.array([[50.0, -50.0, 20.0]])
        made = volumes.of_boxes(np.array([[0, 0, 0, 50, 0, 0, 0, 50, 0, 0, 0, 20.0]]))
        moved = made.moved(product[None], np.zeros(1, int)).corners()[0]
        own = geo.LocalFrame(lat, lon, height)
        expected = frame.forward(*own.reverse(local))[0]
        nearest = np.linalg.norm(moved.astype(np.float32) - expected, axis=1).min()
        assert nearest <= 4e-3 * np.sqrt(3)
        assert np.linalg.norm(moved - expected, axis=1).min() < 1e-6


def test_ecef_is_geographiclibs():
    frame = geo.LocalFrame(0.0, 0.0, 0.0)  # up is x, east y, north z
    lat, lon, height = corners().T
    x, y, z = ellipsoid.ecef(np.radians(lat), np.radians(lon), height).T
    expected = frame.forward(lat, lon, height)
    np.testing.assert_allclose(np.column_stack([y, z, x - 6378137.0]), expected, atol=1e-7)


@pytest.mark.parametrize("undulation", [0.0, -25.9])
def test_a_scene_of_orthometric_heights_shows_tiles_below_the_geoids_height(undulation):
    frame = geo.LocalFrame(*ORIGIN)
    matrix = place.ecef_to_frame(frame, undulation)
    there = ellipsoid.ecef(np.radians(ORIGIN[0]), np.radians(ORIGIN[1]), np.float64(100.0))
    np.testing.assert_allclose((matrix @ [*there, 1.0])[:3], [0, 0, 100.0 - undulation], atol=1e-8)
