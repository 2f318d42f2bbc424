"""Geodesics against PROJ, which has the same series (Karney 2013), and against Vincenty's formula."""

import numpy as np
import pyproj
import pytest
from firetwin_core import geo
from pymap3d import vincenty

EARTH = pyproj.Geod(ellps="WGS84")


@pytest.fixture(scope="module")
def pairs():
    """2000 pairs of places all over the Earth, and some odd ones."""
    rng = np.random.default_rng(7)
    latitude = np.degrees(np.arcsin(rng.uniform(-1, 1, (2, 2000))))
    longitude = rng.uniform(-180, 180, (2, 2000))
    odd = np.array(
        [
            [90, 0, -90, 0],
            [0, 0, 0, 90],
            [0, 179.9, 0, -179.9],
            [38.8, -120.5, 38.8, -120.5],
            [10, 20, -30, 20],
            [89.9, 10, 89.9, -170],
        ]
    ).T
    return np.concatenate([[latitude[0], longitude[0], latitude[1], longitude[1]], odd], axis=1)


def angle(a, b):
    return np.abs((np.asarray(a) - b + 180.0) % 360.0 - 180.0)


def test_lengths_and_azimuths(pairs):
    length, first, last = geo.geodesic_inverse(*pairs)
    forward, back, wanted = EARTH.inv(pairs[1], pairs[0], pairs[3], pairs[2])
    assert np.abs(length - wanted).max() < 1e-6
    some = wanted > 0.0  # else azimuths are 0 here
    assert angle(first, forward)[some].max() < 1e-9
    assert angle(last, back + 180.0)[some].max() < 1e-9
    near = (wanted < 19e6) & (wanted > 1000.0) & (np.abs(pairs[[0, 2]]) < 89.9).all(axis=0)
    vincenty_length, vincenty_azimuth = vincenty.vdist(*pairs[:, near])
    assert np.abs(length[near] - vincenty_length).max() < 1e-4
    assert angle(first[near], vincenty_azimuth).max() < 1e-8


def test_points_on_the_way(pairs):
    rng = np.random.default_rng(8)
    azimuth, length = rng.uniform(-180, 180, pairs.shape[1]), rng.uniform(0, 19e6, pairs.shape[1])
    latitude, longitude, course = geo.geodesic_direct(pairs[0], pairs[1], azimuth, length)
    east, north, back = EARTH.fwd(pairs[1], pairs[0], azimuth, length)
    away = EARTH.inv(longitude, latitude, east, north)[2]
    assert np.max(away) < 1e-6
    some = np.abs(latitude) < 89.9
    assert angle(course, back + 180.0)[some].max() < 1e-9


def test_nearly_opposite_places():
    """The example of Karney's solution, where Vincenty's formula does not converge."""
    length, first, last = geo.geodesic_inverse(0.0, 0.0, 0.5, 179.5)
    assert float(length) == pytest.approx(19_936_288.579, abs=1e-3)
    assert (float(first), float(last)) == pytest.approx((25.67187, 154.32708), abs=1e-4)


def test_places_and_lengths_broadcast():
    """One start, azimuths (3, 1) and lengths (2,); a length of 0 has no azimuth."""
    found = geo.geodesic_direct(38.0, -120.0, [[0.0], [90.0], [180.0]], [0.0, 1000.0])
    assert {each.shape for each in found} == {(3, 2)}
    assert geo.geodesic_inverse(38.0, -120.0, *found[:2])[0] == pytest.approx(
        np.tile([0.0, 1000.0], (3, 1)), abs=1e-8
    )
    assert [float(each) for each in geo.geodesic_inverse(38.0, -120.0, 38.0, -120.0)] == [0.0, 0.0, 0.0]
    with pytest.raises(ValueError, match="shape"):
        geo.geodesic_inverse([1.0, 2.0], 0.0, [1.0, 2.0, 3.0], 0.0)
