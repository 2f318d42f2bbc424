"""The user's elevation model: heights of the ground, and messages on a bad model."""

import builtins
from dataclasses import replace

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run import content
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource
from firetwin.shot.terrain.elevation import ramp
from hypothesis import given
from hypothesis import strategies as st
from scene_text import GROUND_ALONE
from small_run import FX, FY, NX, NY


def plane(latitude, longitude):
    """A slope of 45 degrees and more, m."""
    return 1200.0 + 5.0e4 * (latitude - 38.905) + 3.0e4 * (longitude + 120.592)


def waves(latitude, longitude):
    """The same with waves of 200 m, which the fuel grid's 170 m cannot hold."""
    return plane(latitude, longitude) + 6.0 * np.sin(latitude * 3500.0) * np.sin(longitude * 2700.0)


@pytest.fixture
def make(make_run, tmp_path):
    """Write a scene of the small run with an elevation model, and give its choice."""
    make_run(elevation=np.full((NY, NX), 1100.0, np.float32), fuel_elevation=np.full((FY, FX), 1100.0))

    def scene(key='elevation = "dem.tif"', near=0.0, apron=0.0):
        (tmp_path / "scene.toml").write_text(GROUND_ALONE.format(key=key, near=near, apron=apron))
        return ShotSource(scene=str(tmp_path / "scene.toml"))

    return scene


@pytest.fixture
def tiff(tmp_path):
    rasters = pytest.importorskip("rasters", reason="needs rasterio")
    return lambda values=plane, **options: rasters.write_tiff(tmp_path / "dem.tif", values, **options)


@pytest.fixture
def axes():
    from rasters import LATITUDE, LONGITUDE

    return LATITUDE, LONGITUDE


PROJECTIONS = {"EPSG:32610": 10.0, "EPSG:4326": 1.0e-4, "EPSG:3310": 10.0, "EPSG:2226": 30.0}


@pytest.mark.parametrize(("projection", "step"), PROJECTIONS.items())
def test_heights_are_the_models_in_any_projection(make, tiff, axes, projection, step):
    tiff(projection=projection, step=step)
    shot = make().shot()
    wanted = plane(axes[0][:, None], axes[1][None, :])
    assert shot.relief.fuel == pytest.approx(wanted, abs=0.15)
    run = shot.run
    assert shot.relief.coarse == pytest.approx(plane(run.latitude[:, None], run.longitude), abs=0.15)
    assert shot.relief.rows(2, 5) == pytest.approx(wanted[2:5], abs=0.15)
    assert shot.ground.fields.elevation == pytest.approx(wanted, abs=0.15)
    latitude, longitude = np.array([38.9013, 38.9077]), np.array([-120.5993, -120.5871])
    point = shot.ground.point(latitude, longitude)
    assert shot.ground.frame.reverse(point)[2] == pytest.approx(plane(latitude, longitude), abs=0.15)


def test_cameras_and_fire_stand_on_it(make, tiff):
    tiff()
    shot = make().shot()
    place = shot.ground.frame.reverse(shot.paths[0].position)
    assert place[2] == pytest.approx(plane(38.904, -120.592) + 200.0, abs=0.5)
    latitude, longitude, height = shot.ground.frame.reverse(shot.fire.fuel.position)
    assert len(height) > 3
    assert height == pytest.approx(plane(latitude, longitude), abs=0.1)


def test_beside_it_and_in_its_gaps_the_runs_relief_goes_on(make, tiff, axes):
    """The western half is the model's, with a hole; between the two there is no step."""

    def holed(latitude, longitude):
        hole = np.hypot((latitude - axes[0][4]) * 111e3, (longitude - axes[1][1]) * 86e3) < 60.0
        return np.where(hole, -9999.0, plane(latitude, longitude))

    tiff(holed, nodata=-9999.0, box=(-120.62, 38.88, -120.5905, 38.93))
    shot = make().shot()
    heights, share = shot.relief.fuel, shot.relief.share
    wanted = plane(axes[0][:, None], axes[1][None, :])
    east = axes[1] > -120.590
    assert np.all(heights[:, east] == 1100.0)
    assert heights[4, 1] == 1100.0
    assert share[4, 1] == 0.0
    west = axes[1] < -120.592
    assert np.all((share[:, west] > 0.0).sum() == share[:, west].size - 1)
    assert heights == pytest.approx(1100.0 + share * (wanted - 1100.0), abs=0.5)
    assert np.abs(np.diff(share, axis=1)).max() < 0.5


@given(st.integers(1, 9), st.integers(0, 12), st.integers(0, 15))
def test_a_gap_is_filled_smoothly(width, row, column):
    known = np.ones((13, 16), bool)
    known[row, column] = False
    share = ramp(known, width)
    away = np.maximum(*np.abs(np.mgrid[:13, :16] - np.array([row, column])[:, None, None]))
    assert share[row, column] == 0.0
    assert np.all(share[away >= width] == 1.0)
    ranked = [share[away == k] for k in range(away.max() + 1)]
    assert all(np.ptp(ring) == 0.0 for ring in ranked)
    assert np.all(np.diff([ring[0] for ring in ranked]) >= 0.0)
    assert np.all(ramp(np.ones((3, 4), bool), width) == 1.0)
    assert np.all(ramp(np.zeros((3, 4), bool), width) == 0.0)


def test_near_cameras_the_ground_is_as_fine_as_the_model(make, tiff, axes):
    tiff(waves, step=4.0)
    shot = make(near=4000.0).shot()
    rng = np.random.default_rng(2)
    latitude, longitude = (rng.uniform(axis[1], axis[-2], 400) for axis in axes)
    height = shot.ground.frame.reverse(shot.ground.point(latitude, longitude))[2]
    assert height == pytest.approx(waves(latitude, longitude), abs=0.4)
    row, column = shot.ground.indices(latitude, longitude)
    assert np.abs(shot.ground.height(row, column) - waves(latitude, longitude)).max() > 4.0
    assert 4.0 < shot.ground.rough < 20.0


def test_no_ground_of_the_model_is_under_the_floor(make, tiff, axes):
    """The occluder in `sights` is the floor: it must not occlude points above the true ground."""
    tiff(lambda *place: plane(*place) + 8.0 * (waves(*place) - plane(*place)), step=4.0)
    ground = make(near=4000.0).shot().ground
    floor = ground.floor()
    rng = np.random.default_rng(3)
    row, column = (rng.uniform(0.0, count - 1.001, 3000) for count in ground.shape)
    point = ground.point(*ground.places(row, column))
    i, j = row.astype(int), column.astype(int)
    lowest = np.min([floor[i + a, j + b, 2] for a in (0, 1) for b in (0, 1)], axis=0)
    assert np.all(point[:, 2] >= lowest - 1e-3)


def test_the_apron_has_its_heights_too(make, tiff):
    tiff(step=20.0, box=(-120.68, 38.84, -120.50, 38.97))
    ground = make(apron=20_000.0).shot().ground
    margin, fields = ground.fields.margin, ground.fields
    near = np.s_[margin - 3 : -margin + 3]
    wanted = plane(fields.latitude[:, None], fields.longitude)
    assert fields.elevation[near, near] == pytest.approx(wanted[near, near], abs=1.0)
    assert fields.elevation[0, 0] != pytest.approx(wanted[0, 0], abs=100.0)


@pytest.mark.parametrize(("unit", "metres"), [("ft", 0.3048), ("US survey foot", 1200 / 3937), ("m", 1.0)])
def test_feet_that_are_said_become_metres(make, tiff, axes, unit, metres):
    tiff(lambda *place: plane(*place) / metres, unit=unit)
    assert make().shot().relief.fuel == pytest.approx(plane(axes[0][:, None], axes[1]), abs=0.15)


def test_scaled_integers_are_heights(make, tiff, tmp_path, axes):
    import rasterio

    tiff(lambda *place: (plane(*place) - 500.0) * 10.0, dtype="int16")
    with rasterio.open(tmp_path / "dem.tif", "r+") as raster:
        raster.scales, raster.offsets = (0.1,), (500.0,)
    assert make().shot().relief.fuel == pytest.approx(plane(axes[0][:, None], axes[1]), abs=0.1)


BAD = {
    "feet": (
        lambda *at: plane(*at) / 0.3048,
        {},
        "look like feet; set the unit with gdal_edit.py -units ft dem.tif",
    ),
    "fathoms": (plane, {"unit": "fathom"}, 'has heights in "fathom"; convert them to metres or feet'),
    "centimetres": (lambda *at: 100.0 * plane(*at), {}, "gdal_edit.py -a_nodata"),
    "decimetres": (lambda *at: 5.0 * plane(*at), {}, "above the run's ground in most places"),
    "elsewhere": (plane, {"box": (-119.0, 37.0, -118.99, 37.01)}, "outside of the run, which covers 38.900"),
    "empty": (lambda y, x: y * 0 - 9999, {"nodata": -9999}, "has no data in the run's area"),
    "not said": (
        lambda y, x: np.where(x > -120.59, -9999.0, plane(y, x)),
        {},
        "has heights of -9999 m; if that means no data: gdal_edit.py -a_nodata -9999 dem.tif",
    ),
    "no projection": (plane, {"crs": None}, "has no georeference"),
}


@pytest.mark.parametrize(("values", "options", "reason"), BAD.values(), ids=BAD)
def test_a_bad_model_is_one_line(make, tiff, tmp_path, values, options, reason):
    tiff(values, **options)
    with pytest.raises(InputError) as caught:
        make().shot()
    text = str(caught.value)
    assert text.startswith(f"{tmp_path / 'dem.tif'}: ")
    assert reason in text
    assert "\n" not in text


def test_other_files_are_one_line(make, tiff, tmp_path):
    whole = tiff().read_bytes()
    for content_of in (b"", b"no raster", whole[:400], b"\x89PNG\r\n\x1a\n", b"<VRTDataset/>"):
        (tmp_path / "dem.tif").write_bytes(content_of)
        with pytest.raises(InputError, match=r"dem\.tif:? (cannot be read as a GeoTIFF|has no georeference)"):
            make().shot()
    (tmp_path / "dem.tif").unlink()
    for _ in range(2):
        with pytest.raises(InputError, match=r"scene\.toml:9:1: terrain\.elevation: no such file"):
            make().shot()
        (tmp_path / "dem.tif").mkdir(exist_ok=True)


def test_what_is_cut_off_is_one_line(make, tiff, tmp_path):
    path = tiff()
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(InputError, match=r"dem\.tif: cannot be read as a GeoTIFF: .*; export it again"):
        _ = make().shot().relief.fuel


def test_without_rasterio_it_says_what_to_install(make, monkeypatch):
    real = builtins.__import__

    def without(name, *rest, **more):
        if name.startswith("rasterio"):
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(
        InputError, match=r"scene\.toml:9:1: terrain\.elevation needs .* 'firetwin\[raster\]'"
    ):
        make().shot()
    make(key="").shot()


def test_what_stands_on_the_ground_depends_on_the_models_content(make, tiff, tmp_path):
    tiff()
    shot = make().shot()
    plain, whole = content.inputs(shot.run, tmp_path / "cache"), shot.input_hashes()
    assert set(whole) - set(plain) == {"elevation model"}
    assert make().shot().input_hashes() == whole
    tiff(waves)
    assert make().shot().input_hashes() != whole
    assert not (tmp_path / content.REMEMBERED).exists()
    bare = replace(scene_file.read(tmp_path / "scene.toml").terrain, elevation=None)
    assert replace(shot.settings, terrain=bare).terrain.elevation is None
