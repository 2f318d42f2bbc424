"""UTM coordinates and names of grid squares, against PROJ and published examples."""

import numpy as np
import pyproj
import pytest
from firetwin.geometry.utm import Zone


@pytest.mark.parametrize(("number", "south"), [(10, False), (33, True), (60, False)])
def test_coordinates_are_those_of_proj(number, south):
    zone = Zone(number, south)
    there = pyproj.Transformer.from_crs("EPSG:4326", f"EPSG:{zone.epsg}", always_xy=True)
    latitude = np.linspace(-79.0, -0.1, 40) if south else np.linspace(0.0, 83.0, 40)
    longitude = 6 * number - 183 + np.linspace(-6.0, 6.0, 40)
    east, north = zone.forward(latitude, longitude)
    assert np.column_stack([east, north]) == pytest.approx(
        np.column_stack(there.transform(longitude, latitude)), abs=1e-6
    )
    back = zone.inverse(east, north)
    assert back[0] == pytest.approx(latitude, abs=1e-11)
    assert (back[1] - longitude + 180.0) % 360.0 - 180.0 == pytest.approx(np.zeros(40), abs=1e-11)


@pytest.mark.parametrize(
    ("place", "zone"),
    [
        ((38.8, -120.5), "10N"),
        ((60.0, 5.0), "32N"),
        ((78.0, 15.0), "33N"),
        ((-33.9, 151.2), "56S"),
        ((0.0, 180.0), "1N"),
    ],
)
def test_zones_have_their_exceptions(place, zone):
    assert Zone.at(*place).name == zone


@pytest.mark.parametrize(
    ("place", "name"),
    [
        ((38.889467, -77.035239), "18S UJ"),  # Washington Monument, FGDC-STD-011-2001
        ((-33.85678, 151.21529), "56H LH"),  # Sydney Opera House
        ((0.0, 0.0), "31N AA"),
        ((19.5, -155.5), "5Q KB"),
    ],
)
def test_squares_of_the_national_grid(place, name):
    zone = Zone.at(*place)
    assert zone.square(*zone.forward(*place)) == name
    assert zone.square(50_000.0, 0.0) == ""


def test_grid_north_lies_east_of_true_north_east_of_the_meridian():
    zone = Zone(10, False)
    factors = pyproj.Proj(f"EPSG:{zone.epsg}").get_factors(-120.5, 38.8)
    assert zone.convergence(38.8, -120.5) == pytest.approx(factors.meridian_convergence, abs=1e-9)
    assert zone.convergence(38.8, -120.5) > 0.0
