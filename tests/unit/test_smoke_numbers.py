"""What the benchmarks say of pictures is so: shapes of known dimension, known spectra, known shifts."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.smoke.domains import Box, Domain

pytest.importorskip("scipy")
pytest.importorskip("matplotlib")
BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


def loaded(name):
    """A benchmark as a module; those that it needs are loaded before."""
    spec = importlib.util.spec_from_file_location(name, BENCHMARKS / f"{name}.py")
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


optical = loaded("optical")
pictures = loaded("smoke_pictures")
sight = loaded("lines_of_sight")


def canvas(shapes):
    """Masks side by side with a pixel's room between them and to the sides."""
    high = max(len(shape) for shape in shapes) + 2
    padded = [np.pad(s, [(1, high - 1 - len(s)), (1, 1)]) for s in shapes]
    return np.concatenate(padded, axis=1)


def disc(radius):
    y, x = np.mgrid[-radius - 1 : radius + 2, -radius - 1 : radius + 2]
    return np.hypot(x, y) <= radius


def snowflake(side):
    """Koch's island of `side` px, with all detail that pixels show (by even-odd crossings of rows)."""
    corners = side * np.array([1.0, np.exp(2j * np.pi / 3), np.exp(-2j * np.pi / 3)])
    ring = np.append(corners, corners[0])
    while abs(ring[1] - ring[0]) > 0.7:
        a, b = ring[:-1], ring[1:]
        peak = (a + b) / 2 + (b - a) * (-1j) * np.sqrt(3) / 6
        ring = np.append(np.stack([a, (2 * a + b) / 3, peak, (a + 2 * b) / 3], 1).ravel(), ring[-1])
    span = int(side * 1.2) + 2
    x = np.arange(-span, span + 1)
    found = np.zeros((len(x), len(x)), bool)
    a, b = ring[:-1], ring[1:]
    for row, y in enumerate(x + 0.013):
        cut = (a.imag > y) != (b.imag > y)
        at = a.real[cut] + (y - a.imag[cut]) / (b.imag - a.imag)[cut] * (b.real - a.real)[cut]
        found[row] = (at[None] > x[:, None]).sum(1) % 2 == 1
    return found


def test_discs_have_no_fractal_outline():
    dimension, count = pictures.outline(canvas([disc(r) for r in (5, 8, 12, 17, 25, 40, 60)]))
    assert count == 7
    assert dimension == pytest.approx(1.0, abs=0.04)


def test_koch_islands_have_their_dimension():
    dimension, count = pictures.outline(canvas([snowflake(side) for side in (9, 27, 81, 40, 60, 20, 120)]))
    assert count >= 7
    assert dimension == pytest.approx(np.log(4) / np.log(3), abs=0.05)


def test_one_outline_has_its_dimension_by_the_ruler():
    assert pictures.ruler(np.pad(disc(60), 3)) == pytest.approx(1.0, abs=0.04)
    assert pictures.ruler(np.pad(snowflake(120), 3)) == pytest.approx(np.log(4) / np.log(3), abs=0.05)
    assert np.isnan(pictures.ruler(np.ones((32, 32), bool)))


def test_blobs_that_the_picture_cuts_do_not_count():
    whole = canvas([disc(r) for r in (5, 8, 12, 17, 25)])
    assert pictures.outline(whole[: len(whole) // 2])[1] < 5


def scaling(slope, n=256, seed=1):
    """A random picture whose power goes as wavenumber^slope."""
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n)))
    k[0, 0] = np.inf
    picture = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * k ** (slope / 2)).real
    return picture / picture.std()


@pytest.mark.parametrize("slope", [-2.0, -3.0])
def test_a_power_law_has_its_slope_and_no_bump(slope):
    picture = scaling(slope)
    found, bump, _, squares = pictures.spectrum(picture, np.ones(picture.shape, bool))
    assert squares > 100
    assert found == pytest.approx(slope, abs=0.25)
    assert bump < 1.25


def test_lumps_of_one_size_stand_out():
    picture = scaling(-3.0)
    y, x = np.indices(picture.shape)
    lumps = np.sin(2 * np.pi * x / 9.0) * np.sin(2 * np.pi * y / 9.0)
    _, bump, wave, _ = pictures.spectrum(picture + 0.3 * lumps, np.ones(picture.shape, bool))
    assert bump > 2.5
    assert wave == pytest.approx(9.0 / np.sqrt(2), rel=0.15)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (1.3, -0.6), (4.7, 3.2)])
def test_a_shifted_picture_has_gone_by_its_shift(shift):
    picture = 0.5 + 0.1 * optical.smoothed(optical.smoothed(scaling(-2.5)))
    k = np.fft.fftfreq(256)
    phase = np.exp(-2j * np.pi * (k[None] * shift[0] + k[:, None] * shift[1]))
    moved = np.fft.ifft2(np.fft.fft2(picture) * phase).real
    moved = 0.9 * moved + 0.05  # and the light is another
    centre = np.stack(np.meshgrid(np.arange(60, 200, 20), np.arange(60, 200, 20)), -1).reshape(-1, 2)
    found, trusted = optical.displacement(picture, moved, centre, 24)
    assert trusted.mean() > 0.9
    assert np.abs(found[trusted] - shift).max() < 0.15


def test_what_is_even_or_new_is_not_trusted():
    rng = np.random.default_rng(5)
    centre = np.stack(np.meshgrid(np.arange(40, 160, 20), np.arange(40, 160, 20)), -1).reshape(-1, 2)
    one, other = rng.normal(size=(2, 200, 200))
    even = 0.5 + 1e-4 * one
    assert not optical.displacement(even, even, centre, 24)[1].any()
    assert optical.displacement(0.5 + 0.1 * one, 0.5 + 0.1 * one, centre, 24)[1].all()
    assert optical.displacement(0.5 + 0.1 * one, 0.5 + 0.1 * other, centre, 24)[1].mean() < 0.02


class Camera:
    """At 100 m, looking north, 90 degrees wide."""

    position = np.array([[0.0, 0.0, 100.0]])
    rotation = np.array([[[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]])
    half = (1.0, 0.5)


class Shear:
    """Wind east that grows from 0 at the camera's height, m/s; unknown far east."""

    def at(self, place):
        wind = np.stack([0.1 * (place[:, 2] - 100.0), 0 * place[:, 2], 0 * place[:, 2] + 2.0], 1)
        return np.where(place[:, :1] < 900.0, wind, np.nan)


def test_what_is_seen_goes_as_the_wind_where_it_is_seen():
    """Thick smoke from 2 km on: its face alone counts, at the width of the picture over 2 x the distance."""
    wall = sight.Grid(np.full((200, 50, 100), 0.1, np.float32), np.array([-2000.0, 2010.0, -890.0]), 20.0)
    pixels = np.array([[100.0, 20.0], [99.5, 49.5], [150.0, 49.5]])
    way, light = sight.expected(Camera, [wall], Shear(), pixels, (200, 100), 3.0)
    assert light[:2] == pytest.approx(1.0, abs=0.01)
    assert light[2] < 0.01
    up = (49.5 - pixels[0, 1]) / 100.0 * 2010.0
    expected = np.array([0.1 * up, -2.0]) * 3.0 / 2010.0 * 100.0
    assert way[0] == pytest.approx(expected, rel=0.02)
    assert way[1] == pytest.approx([0.0, expected[1]], abs=0.005)


def test_thin_smoke_lets_what_is_behind_it_count():
    near = sight.Grid(np.full((400, 5, 200), 0.0069, np.float32), np.array([-4000.0, 1000.0, -1900.0]), 20.0)
    far = sight.Grid(np.full((400, 50, 200), 0.1, np.float32), np.array([-4000.0, 4000.0, -1900.0]), 20.0)
    _, light = sight.expected(Camera, [near], Shear(), np.array([[99.5, 49.5]]), (200, 100), 1.0)
    assert light == pytest.approx(0.5, abs=0.03)
    way, _ = sight.expected(Camera, [near, far], Shear(), np.array([[99.5, 49.5]]), (200, 100), 1.0)
    assert -way[0, 1] == pytest.approx(2.0 * 100.0 * (0.5 / 1050 + 0.5 / 4000), rel=0.06)


def test_the_wind_of_a_place_is_that_of_its_cell():
    rng = np.random.default_rng(2)
    box = Box(tuple(np.linspace(0, 2000, 11)), (6, 8), 100.0, (300.0, -200.0))
    part = Domain(box, rng.uniform(100, 400, (6, 8)), 250.0, 2000.0, Path(), Scale())
    wind = rng.normal(size=(10, 6, 8, 3)).astype(np.float32)
    x, y = box.middles()
    up = part.heights()
    places = np.stack(np.broadcast_arrays(x, y[:, None], up), -1)
    found = sight.SolvedWind(part, wind).at(places.reshape(-1, 3)).reshape(wind.shape)
    np.testing.assert_array_equal(found, wind)
    assert np.isnan(sight.SolvedWind(part, wind).at(np.array([[200.0, 0.0, 500.0]]))).all()
