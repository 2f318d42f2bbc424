"""Geodesics against PROJ, which uses GeographicLib (Karney 2013)."""

import numpy as np
import pyproj
import pytest
from firetwin import geodesic

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
    length, first, last = geodesic.inverse(*pairs)
    forward, back, wanted = EARTH.inv(pairs[1], pairs[0], pairs[3], pairs[2])
    assert np.abs(length - wanted).max() < 1e-3
    some = (wanted > 1000.0) & (wanted < 19.9e6) & (np.abs(pairs[[0, 2]]) < 89.9).all(axis=0)
    assert angle(first, forward)[some].max() < 1e-8
    assert angle(last, back + 180.0)[some].max() < 1e-8


def test_points_on_the_way(pairs):
    rng = np.random.default_rng(8)
    azimuth, length = rng.uniform(-180, 180, pairs.shape[1]), rng.uniform(0, 19e6, pairs.shape[1])
    latitude, longitude, course = geodesic.direct(pairs[0], pairs[1], azimuth, length)
    east, north, back = EARTH.fwd(pairs[1], pairs[0], azimuth, length)
    away = EARTH.inv(longitude, latitude, east, north)[2]
    assert np.max(away) < 1e-3
    some = np.abs(latitude) < 89.9
    assert angle(course, back + 180.0)[some].max() < 1e-6


def test_nearly_opposite_places_have_no_certain_way():
    assert np.isnan(geodesic.inverse(0.0, 0.0, 0.1, 179.9)[0])
