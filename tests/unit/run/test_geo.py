"""ENU against GeographicLib's CartConvert, the IOGP example, 50-digit arithmetic and itself."""

import shutil
import subprocess

import geodesy
import numpy as np
import pytest
from firetwin_core.geo import LocalFrame
from hypothesis import given, settings
from hypothesis import strategies as st

ORIGIN = (38.93, -120.55, 0.0)
NANOMETRES = 5e-9


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(2)
    n = 300
    return rng.uniform(38.4, 39.2, n), rng.uniform(-121.1, -120.1, n), rng.uniform(-50, 3500, n)


def test_iogp_topocentric_example():
    """IOGP Guidance Note 373-7-2, topocentric origin 55 N 5 E 200 m."""
    enu = LocalFrame(55, 5, 200).forward([53.80939444444444], [2.12955], [73])
    np.testing.assert_allclose(enu, [[-189013.869, -128642.040, -4220.171]], atol=5e-4)


def test_scattered_points_within_5_nm_of_50_digits(points):
    enu = LocalFrame(*ORIGIN).forward(*points)
    for result, point in zip(enu, zip(*points, strict=True), strict=True):
        exact = geodesy.enu_exact(*point, ORIGIN)
        assert max(abs(a - b) for a, b in zip(result, exact, strict=True)) < NANOMETRES


@pytest.mark.parametrize("origin", [ORIGIN, (-33.0, 179.9, 850.0), (89.9, 0.0, 0.0)])
def test_grid_within_5_nm_of_50_digits(origin):
    rng = np.random.default_rng(3)
    latitude = np.clip(origin[0] + np.linspace(-0.3, 0.3, 12), -90, 90)
    longitude = origin[1] + np.linspace(0.3, -0.3, 9)
    height = rng.uniform(-50, 3500, (12, 9))
    enu = LocalFrame(*origin).forward_grid(latitude, longitude, height)
    for (y, x), h in np.ndenumerate(height):
        exact = geodesy.enu_exact(latitude[y], longitude[x], h, origin)
        assert max(abs(a - b) for a, b in zip(enu[y, x], exact, strict=True)) < NANOMETRES


@pytest.mark.skipif(not shutil.which("CartConvert"), reason="needs geographiclib-tools")
def test_agrees_with_cart_convert(points):
    lines = "\n".join(" ".join(f"{v:.17g}" for v in p) for p in zip(*points, strict=True))
    command = ["CartConvert", "-l", *(str(v) for v in ORIGIN), "-p", "10"]
    output = subprocess.run(command, input=lines, capture_output=True, text=True, check=True).stdout
    expected = np.array([line.split() for line in output.splitlines()], float)
    np.testing.assert_allclose(LocalFrame(*ORIGIN).forward(*points), expected, rtol=0, atol=NANOMETRES)


@settings(deadline=None)
@given(
    st.floats(-90, 90),
    st.floats(-180, 180),
    st.floats(-500, 9000),
    st.tuples(*[st.floats(-60000, 60000)] * 2, st.floats(-3000, 5000)),
)
def test_round_trip_within_10_nm(latitude, longitude, height, enu):
    frame = LocalFrame(latitude, longitude, height)
    np.testing.assert_allclose(frame.forward(*frame.reverse([enu])), [enu], rtol=0, atol=10e-9)


def test_a_longitude_is_the_same_a_turn_further():
    frame = LocalFrame(10, 179.5)
    grid = frame.forward_grid([10.0], [-179.5, 180.5], np.zeros((1, 2)))
    np.testing.assert_allclose(grid[0, 0], grid[0, 1], atol=NANOMETRES)
    assert grid[0, 0, 0] == pytest.approx(109_600, rel=1e-3)


def test_impossible_places_are_nan():
    frame = LocalFrame(*ORIGIN)
    assert np.isnan(frame.forward([91.0], [0.0], [0.0])).any()
    assert np.isnan(frame.forward_grid([91.0, np.nan], [0.0], np.zeros((2, 1)))).any(axis=-1).all()


@pytest.mark.parametrize("origin", [(90.1, 0, 0), (np.nan, 0, 0), (0, np.inf, 0), (0, 0, np.nan)])
def test_impossible_origin(origin):
    with pytest.raises(ValueError, match="origin"):
        LocalFrame(*origin)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([1.0, 2.0], [1.0], [1.0, 2.0]), r"longitude must have shape \(2\)"),
        (([[1.0]], [1.0], [1.0]), "latitude must have shape"),
        ((["a"], [1.0], [1.0]), "latitude must contain real numbers"),
        (([1j], [1.0], [1.0]), "latitude must contain real numbers"),
    ],
)
def test_wrong_arrays(arguments, message):
    with pytest.raises(ValueError, match=message):
        LocalFrame(0, 0).forward(*arguments)


def test_no_points():
    assert LocalFrame(0, 0).forward([], [], []).shape == (0, 3)
    assert LocalFrame(0, 0).forward_grid([], [1.0], np.zeros((0, 1))).shape == (0, 1, 3)
