"""Satellites' pixels: geometry against PROJ, sub-pixel fire against Dozier, power against the run's heat."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.cli import main
from firetwin.run import opening as runs
from firetwin.shot import passes
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.fire import air_temperature
from firetwin.shot.fire.fire import Fire
from firetwin.shot.satellites import geotiff, imager
from firetwin.shot.satellites.grid import ORBIT, EvenGrid, FixedGrid, pixel_areas
from firetwin.shot.sections import Time
from firetwin.shot.settings import Camera, Render, Settings
from firetwin.shot.shot import Shot
from firetwin_core import constants, sensor
from hypothesis import given
from hypothesis import strategies as st

GRID = FixedGrid(-137.0)
PLACE = 38.8, -120.6


@given(st.floats(-60, 60), st.floats(-190, -80))
def test_scan_angles_are_those_of_proj(latitude, longitude):
    pyproj = pytest.importorskip("pyproj")
    x, y = pyproj.Transformer.from_crs("+proj=longlat +ellps=GRS80", GRID.crs, always_xy=True).transform(
        longitude, latitude
    )
    found = GRID.angles(latitude, longitude)
    if np.isfinite([x, y]).all():
        assert np.array(found) * ORBIT == pytest.approx([x, y], abs=1e-3)


@given(st.floats(-60, 60), st.floats(-190, -80))
def test_a_line_of_sight_comes_back(latitude, longitude):
    row, column = GRID.forward(latitude, longitude)
    if np.isfinite(row):
        assert np.array(GRID.reverse(row, column)) == pytest.approx([latitude, longitude], abs=1e-6)


def test_what_is_behind_the_horizon_is_not_seen():
    assert np.isnan(GRID.angles(38.8, 60.0)).all()


def test_a_pixel_is_2_km_below_the_satellite_and_longer_at_the_fire():
    assert pixel_areas(GRID, np.array([0]), np.array([0])) == pytest.approx(4.0e6, rel=0.01)
    row, column = (int(np.floor(v)) for v in GRID.forward(*PLACE))
    assert pixel_areas(GRID, np.array([row]), np.array([column])) == pytest.approx(2240 * 3050, rel=0.04)


def test_pixels_of_a_swath_are_375_m():
    even = EvenGrid(38.8, 375.0)
    row, column = (int(np.floor(v)) for v in even.forward(*PLACE))
    assert pixel_areas(even, np.array([row]), np.array([column])) == pytest.approx(375.0**2, rel=1e-3)


@pytest.fixture
def burning(make_run):
    """A run of 300 K over 24 x 24 cells of 1 km with one cell that burns, as strongly as asked."""

    def make(flux=5.0e4, **more):
        side = 24
        fields = {
            "latitude": 38.8 + np.arange(side) / 111.0,
            "longitude": -120.6 + np.arange(side) / 87.0,
            "heat_flux": np.zeros((2, side, side), np.float32),
            "temperature": np.full((2, side, side), 300.0, np.float32),
        }
        fields["heat_flux"][:, 11, 12] = flux
        for name in ("elevation", "fuel_elevation", "surface_fuel", "canopy_fuel"):
            fields[name] = np.zeros((side, side), np.float32)
        fields |= {"fuel_latitude": fields["latitude"], "fuel_longitude": fields["longitude"]}
        fields["fuel_arrival_time"] = np.full((side, side), np.nan, np.float32)
        folder = make_run(**(fields | dict.fromkeys(("wind_east", "wind_north")) | more))
        return runs.open(folder.rename(folder.with_name(f"run {len(list(folder.parent.iterdir()))}")))

    return make


def seen(run, name):
    instrument = imager.INSTRUMENTS[name]
    time = float(run.times[0])
    grid, fire = imager.grid_of(instrument, run, -137.0), Fire(run, time, time, 600.0)
    return imager.picture(instrument, grid, fire, time)


def test_a_pixel_shows_the_radiance_mean_of_fire_and_ground(burning):
    """Dozier: 1000 K over 0.37 % of 300 K is 400 K at 3.9 um and 306.5 K at 11.2 um."""
    run = burning(5.0e3)
    image = seen(run, "abi")
    hot = np.unravel_index(image.short.argmax(), image.short.shape)
    part = imager.RADIATED * image.heat / (constants.STEFAN_BOLTZMANN * 1000.0**4) / image.area[hot]
    assert 0.001 < part < 0.02
    for wave, shown, most in zip((3.9, 11.2), (image.short, image.long), imager.ABI.saturation, strict=True):
        fire, ground = sensor.spectral_radiance([1000.0, 300.0], wave)
        mixed = sensor.spectral_temperature(part * fire + (1.0 - part) * ground, wave)
        expected = min(float(mixed), most)
        assert shown[hot] == pytest.approx(expected, abs=1e-3)
        assert np.sort(shown.ravel())[-2] == pytest.approx(300.0, abs=1e-3)
    assert (image.mask > 0).sum() == 1


def test_the_power_of_all_pixels_is_a_sixth_of_the_heat_where_none_is_saturated(burning):
    found = seen(burning(5.0e3), "abi")
    assert (found.mask == imager.BURNING).sum() == 1
    assert found.heat > 0
    ratio = found.power.sum() / found.heat
    exact = imager.RADIATED * sensor.spectral_radiance(1000.0, 3.9) / (3.0e-9 * 1000.0**4)
    assert ratio == pytest.approx(float(exact), rel=1e-3)
    assert ratio == pytest.approx(0.158, abs=0.001)


@pytest.mark.parametrize("name", ["abi", "viirs"])
def test_pixels_saturate(burning, name):
    found = seen(burning(1.0e6), name)
    most = imager.INSTRUMENTS[name].saturation
    assert (found.short.max(), found.long.max()) == pytest.approx(most, abs=1e-6)
    assert (found.mask == imager.SATURATED).any()
    assert found.power.sum() < 0.1 * found.heat
    assert found.limited > 0


def test_viirs_tells_the_power_of_fires_that_its_middle_band_cannot_show(burning):
    """I4 is saturated; M13, up to 634 K over 750 m, has 0.157 of the heat: 1.12 x 14 %."""
    found = seen(burning(2.0e3), "viirs")
    assert (found.mask == imager.SATURATED).any()
    assert found.limited == 0
    exact = imager.RADIATED * sensor.spectral_radiance(1000.0, 4.05) / (2.88e-9 * 1000.0**4)
    assert found.power.sum() / found.heat == pytest.approx(float(exact), rel=1e-3)
    assert float(exact) == pytest.approx(0.157, abs=0.001)


@given(st.integers(-9, 9), st.integers(-9, 9), st.lists(st.floats(0.0, 0.05), min_size=30, max_size=30))
def test_the_power_of_a_wide_pixel_is_shared_among_those_that_show_fire(row, column, parts):
    """A pixel of M13 is 2 x 2, from even rows and columns on; those at the edge of the domain are cut off."""
    part = np.reshape(parts, (5, 6))
    fire = part > 0.01
    blocks = imager.index_blocks(2, row + np.arange(5), column + np.arange(6))
    kelvin, area = np.full((5, 6, 1), 300.0), np.full((5, 6), 375.0**2)
    power, limited = imager.measure_power(imager.VIIRS.power, kelvin, part, area, fire, blocks)
    assert limited == 0
    assert not power[~fire].any()
    above = float(np.diff(sensor.spectral_radiance([300.0, 1000.0], 4.05))[0])
    for y in range(row // 2, (row + 6) // 2):
        for x in range(column // 2, (column + 7) // 2):
            rows, columns = ((first + np.arange(n)) // 2 for first, n in ((row, 5), (column, 6)))
            mine = np.outer(rows == y, columns == x)
            if (mine & fire).any():
                whole = part[mine].sum() * 375.0**2 * constants.STEFAN_BOLTZMANN / 2.88e-9 * above
                assert power[mine & fire] == pytest.approx(whole / (mine & fire).sum(), rel=1e-9)


def test_a_wide_pixel_that_is_saturated_is_counted():
    kelvin, area, part = np.full((2, 2, 1), 300.0), np.full((2, 2), 375.0**2), np.full((2, 2), 0.3)
    blocks = imager.index_blocks(2, np.arange(2), np.arange(2))
    power, limited = imager.measure_power(imager.VIIRS.power, kelvin, part, area, part > 0.0, blocks)
    above = float(np.diff(sensor.spectral_radiance([300.0, 634.0], 4.05))[0])
    assert limited == 1
    assert power.sum() == pytest.approx(4.0 * 375.0**2 * constants.STEFAN_BOLTZMANN / 2.88e-9 * above)


def test_warmer_air_is_a_warmer_background(burning):
    cold, warm = (
        seen(burning(temperature=np.full((2, 24, 24), kelvin, np.float32)), "viirs")
        for kelvin in (300.0, 310.0)
    )
    calm = cold.mask == imager.NONE
    assert (warm.long - cold.long)[calm] == pytest.approx(10.0, abs=1e-3)


def test_the_scar_is_warm_and_cools(burning):
    arrival, timber = np.full((24, 24), -3600.0, np.float32), np.full((24, 24), 2.0, np.float32)
    fresh, old, grass = (
        seen(burning(0.0, fuel_arrival_time=each, canopy_fuel=canopy), "viirs")
        for each, canopy in ((arrival, timber), (arrival - 36_000.0, timber), (arrival, 0.0 * timber))
    )
    assert fresh.long == pytest.approx(300.0 + air_temperature.cooling(3600.0), abs=0.1)
    assert np.all((old.long > 300.5) & (old.long < fresh.long))
    assert grass.long == pytest.approx(300.0 + air_temperature.cooling(3600.0, 15.0), abs=0.1)


def test_a_geotiff_lies_where_its_pixels_are(burning, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    pyproj = pytest.importorskip("pyproj")
    for name in ("abi", "viirs"):
        image, path = seen(burning(), name), tmp_path / f"{name}.tif"
        geotiff.write(path, image, imager.INSTRUMENTS[name], "Test", datetime(2014, 9, 17, tzinfo=UTC))
        with rasterio.open(path) as read:
            assert read.count == 4
            assert "hypothetical" in read.tags()["note"]
            assert ("M13" in read.tags()["power_from"]) == (name == "viirs")
            np.testing.assert_allclose(read.read(1), image.short, rtol=1e-6)
            if name == "abi":
                projection = read.crs.to_dict()
                assert [projection[key] for key in ("proj", "lon_0", "h")] == ["geos", -137, ORBIT]
            else:
                assert read.crs == "EPSG:4326"
            x, y = read.xy(2, 3)  # the middle of a pixel
            back = pyproj.Transformer.from_crs(read.crs.to_wkt(), "EPSG:4326", always_xy=True)
            longitude, latitude = back.transform(x, y)
        row, column = image.grid.forward(latitude, longitude)
        assert (row, column) == pytest.approx((image.row + 2.5, image.column + 3.5), abs=1e-3)
        assert [path.name for path in tmp_path.glob("*.xml")] == []


def test_the_command_writes_a_picture_for_each_moment(burning, tmp_path, capsys):
    pytest.importorskip("rasterio")
    run = burning()
    assert main(["imager", str(run.path), "--out", str(tmp_path / "out"), "--every", "1000000"]) == 0
    written = capsys.readouterr().out.split()
    assert len(written) == 1
    assert written[0].endswith("Z.tif")
    assert main(["imager", str(run.path), "--out", str(tmp_path / "o"), "--longitude", "60"]) == 2
    assert "horizon" in capsys.readouterr().err


@pytest.mark.parametrize(("longitude", "name"), [(None, "viirs"), (-137.0, "abi")])
def test_a_pass_shows_the_imagers_pixels_where_they_lie_in_a_cameras_picture(
    burning, tmp_path, longitude, name
):
    camera = Camera("satellite", Satellite(swath=30_000.0, geostationary=longitude))
    settings = Settings(time=Time(frames=1), cameras=(camera,), render=Render(resolution=(120, 120)))
    shot = Shot(settings, burning(2.0e3))
    image, (path,) = seen(shot.run, name), shot.paths
    depth = {"depth": {"exr": tmp_path / "depth.exr"}}
    away = path.meet if longitude else path.position[0, 2]
    sensor.write_image(depth["depth"]["exr"], np.full((120, 120), away, np.float32))
    rendered = {}
    for band in ("short", "long"):
        png = tmp_path / f"{band}.png"
        passes.finish(f"imager_{band}", {"png": png}, depth, shot, "satellite", 1)
        rendered[band] = sensor.read_image(png)[..., :3]
    hot = np.unravel_index(image.short.argmax(), image.short.shape)
    place = image.grid.reverse(image.row + hot[0] + 0.5, image.column + hot[1] + 0.5)
    there = shot.local_frame.forward(*(np.atleast_1d(each) for each in place), np.zeros(1))[0]
    local = path.rotation[0].T @ (there - path.position[0])
    scale = 1.0 if not path.perspective else -1.0 / local[2]
    x, y = (120 * (0.5 + 0.5 * np.array([1, -1]) * local[:2] * scale / path.half)).astype(int)
    bands = zip(rendered, (image.short, image.long), imager.INSTRUMENTS[name].saturation, strict=True)
    for band, kelvin, most in bands:
        expected = sensor.colour([[kelvin[hot]]], shot.air.coldest, most, "inferno", 20.0)[0, 0]
        assert rendered[band][y, x] == pytest.approx(expected, abs=0.01)
        assert rendered[band][119, 60] == pytest.approx(3 * [0.12], abs=0.01)  # beyond the run's domain
    assert rendered["short"][y, x].sum() > rendered["short"][y, x - 25].sum() + 0.5
    assert (rendered["short"][2:20, 2:60] > 0.99).any()  # a label


def test_pictures_of_years_before_an_imager_say_so():
    assert imager.ABI.label(2014) == "hypothetical for 2014"
    assert "2014" not in imager.VIIRS.label(2014)
    assert imager.ABI.label(2018) == "hypothetical pass"
