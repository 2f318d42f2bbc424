"""Stars: true places of the brightest, numbers of the rest, and the turn of the sky."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import sun
from firetwin.shot.light import stars

CHART = stars.chart(1)
FLUX = CHART[..., 2]


def place(direction, latitude, longitude, moment):
    """Return galactic longitude and latitude (degrees) seen in a direction (east, north, up)."""
    angle, axis = stars.sidereal_angle(moment, longitude), stars.pole(latitude)
    turned = direction * np.cos(angle) + np.cross(axis, direction) * np.sin(angle)
    turned += axis * (axis @ direction) * (1.0 - np.cos(angle))
    x, y, z = stars.galactic_axes(latitude) @ turned
    return np.degrees(np.arctan2(y, x)) % 360.0, np.degrees(np.arcsin(z))


@pytest.mark.parametrize(
    ("bearing", "height", "wanted"),
    [(275.386, 76.740, (67.45, 19.24)), (280.648, 17.669, (15.02, 69.11)), (0.832, 38.604, (123.28, 26.46))],
)
def test_stars_stand_where_an_ephemeris_has_them(bearing, height, wanted):
    # Vega, Arcturus and Polaris by PyEphem 4.2.1
    moment = datetime(2014, 9, 18, 4, tzinfo=UTC)
    found = place(sun.direction(bearing, height), 38.8, -120.6, moment)
    assert found == pytest.approx(wanted, abs=0.3)


def test_the_chart_has_the_brightest_star_at_its_place():
    row, column = np.unravel_index(np.argmax(FLUX), FLUX.shape)
    across, up, flux, _ = CHART[row, column]
    longitude = (column + across) * 360.0 / stars.COLUMNS
    latitude = (row + up) * 180.0 / stars.ROWS - 90.0
    assert (longitude, latitude) == pytest.approx((227.2, -8.9), abs=0.3)  # Sirius
    assert -2.5 * np.log10(flux) == pytest.approx(-1.46, abs=1e-4)


def test_numbers_grow_with_magnitude_as_in_the_sky():
    magnitude = -2.5 * np.log10(FLUX[FLUX > 0.0])
    counts = [np.count_nonzero(magnitude < limit) for limit in (2.0, 4.5, 6.5)]
    assert 40 <= counts[0] <= 60  # 48 in the Bright Star Catalogue
    assert 700 <= counts[1] <= 1100  # 900
    assert 6500 <= counts[2] <= 8600  # 8,400, of which some share a texel


def test_stars_crowd_in_the_milky_way_and_keep_off_the_edges_of_their_texels():
    rows = (FLUX > 0.0).sum(axis=1)
    area = np.cos(np.radians((np.arange(stars.ROWS) + 0.5) * 180.0 / stars.ROWS - 90.0))
    assert rows[60:68].sum() / area[60:68].sum() > 2.0 * rows[20:40].sum() / area[20:40].sum()
    inside = CHART[FLUX > 0.0][:, :2]
    assert inside.min() > stars.MARGIN - 1e-6
    assert inside.max() < 1.0 - stars.MARGIN + 1e-6


def test_the_same_seed_has_the_same_stars():
    assert np.array_equal(CHART, stars.chart(1))
    assert not np.array_equal(CHART, stars.chart(2))
