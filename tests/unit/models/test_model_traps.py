"""Traps of fire models' files that no other test file has: each test fails without its cure."""

import tomllib
from pathlib import Path

import model_files as made
import numpy as np
import pytest
from firetwin.run import maps
from firetwin.run import opening as runs
from firetwin.run.models import fuels, raster
from matplotlib.collections import QuadMesh
from model_files import said

# ---- CFBM and WRF-SFIRE


def test_coarse_longitudes_turn_no_wind(tmp_path, converted):
    """0.65 m of 10 m would turn the wind of a cell by 1.9 degrees, were only its neighbours asked."""
    paths, _ = made.cfbm(tmp_path, count=2, turn=30.0)
    run = converted(paths)
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    np.testing.assert_allclose(run.wind(1)[0], 3 * c - 4 * s, atol=0.05)
    np.testing.assert_allclose(run.wind(1)[1], 3 * s + 4 * c, atol=0.05)


def test_of_what_fluxes_are_means(tmp_path, converted):
    for paths, expected in ((made.cfbm(tmp_path, count=2)[0], 0.0), (made.wrf(tmp_path)[0], 0.5)):
        run = converted(paths)
        assert tomllib.loads((Path(run.path) / "run.toml").read_text())["mean_s"] == expected
        (tmp_path / "run").rename(tmp_path / f"run {expected}")


def test_a_trace_of_heat_is_no_fire(tmp_path, converted):
    paths, truth = made.cfbm(tmp_path)
    converted(paths)
    (tmp_path / "run" / "fuel_arrival_time.npy").unlink()  # then the flux alone says where the fire is
    bare = runs.open(tmp_path / "run")
    most, found = np.max(truth["flux"][1:], axis=0), np.isfinite(bare.arrival_time())
    assert (most > 0).all()
    assert not found[most < 1.0].any()
    assert found[most > 5e4].all()
    (axes, *_) = maps.intensity_map(bare, "UTC").axes
    (mesh,) = (each for each in axes.collections if isinstance(each, QuadMesh))
    np.testing.assert_array_equal(mesh.get_array().mask, np.load(tmp_path / "run/heat_flux.npy").max(0) < 1.0)


def test_fuel_14_is_none(tmp_path, converted):
    paths, truth = made.cfbm(tmp_path, count=2)
    load = np.asarray(converted(paths).surface_fuel)
    np.testing.assert_array_equal(load, np.where(truth["x"] < 150, np.float32(fuels.SFIRE[2]), 0))


def test_what_burned_before_the_first_time(tmp_path, converted):
    """FIRE_AREA is above 0 there, and the flux is 0: burned by then, without heat."""
    paths, truth = made.wrf(tmp_path, times=(60, 120), without=("TIGN_G", "LFN"))
    with made.netCDF4.Dataset(paths[0], "a") as file:
        file["FGRNHFX"][0] = 0.0
    run = converted(paths)
    arrival, begun = run.fuel_arrival_time(), truth["x"] < made.SPEED * 60 - 5
    assert (arrival[begun] == 60.0).all()
    assert run.heat_flux(0).max() == 0.0
    later = (truth["x"] > made.SPEED * 60 + 5) & (truth["x"] < made.SPEED * 120 - 5)
    assert ((arrival[later] > 60.0) & (arrival[later] <= 120.0)).all()


# ---- ForeFire

TABLE = """Index;Rhod;Rhol;Md;Ml;sd;sl;e;Sigmad;Sigmal
1;500;500;.08;.5;2400;5700;1;.4;.3
2;500;500;.08;.5;2400;5700;1;.9;.3
"""


def test_a_landscape_larger_than_the_map(tmp_path, converted):
    """Each of its variables has separate dimensions; the map is its upper right quarter."""
    arrival = np.hypot(*np.mgrid[-10:10, -10:10]) * 20.0
    made.forefire(tmp_path / "ForeFire.0.nc", arrival, lx=1000.0, ly=1000.0, west=1000.0, south=1000.0)
    fuel, altitude = np.ones((1, 1, 4, 4), np.int16), np.zeros((1, 1, 8, 8), np.int16)
    fuel[0, 0, 2:, 2:] = [[1, 2], [2, 1]]
    altitude[0, 0] = 100 * np.arange(8)[:, None]
    made.landscape(tmp_path / "data.nc", fuel, altitude, size=2000.0, box="9.0,42.0,9.02,42.02")
    (tmp_path / "fuels.ff").write_text(TABLE)
    (tmp_path / "a_front.ff").write_text("FireDomain[sw=(0,0,0);ne=(2000,2000,0);t=900]\n")
    (tmp_path / "b.json").write_text('{"fronts": [{"area": "-12.3ha", "coordinates": "1,2,3 4,5,6"}]}')
    run = converted(sorted(tmp_path.iterdir()))
    assert (run.latitude[0], run.longitude[-1]) == pytest.approx((42.01025, 9.01975))
    load = np.asarray(run.surface_fuel)
    np.testing.assert_array_equal(load[[0, 0, -1, -1], [0, -1, 0, -1]], np.float32([0.4, 0.9, 0.9, 0.4]))
    np.testing.assert_allclose(run.elevation[[0, -1], 0], [360.0, 700.0])  # between middles of cells
    assert "b.json: the model's own JSON" in said(run)


def test_the_ground_burns_where_the_model_says(tmp_path, converted):
    """Islands that a fire left out are invented in a synthetic run alone."""
    from firetwin.shot.settings import Settings
    from firetwin.shot.terrain.terrain import Terrain

    arrival = np.hypot(*np.mgrid[-60:60, -60:60]) * 10.0
    run = converted([made.forefire(tmp_path / "ForeFire.0.nc", arrival, lx=6000.0, ly=6000.0)], at="42,9")
    inner = np.s_[2:-2, 2:-2]

    def burned():
        ground = Terrain(Settings(), run, run.fuel_arrival_time())
        margin = ground.fields.margin
        return ground.burned[margin:-margin, margin:-margin][inner]

    assert burned().min() == 1.0
    toml = Path(run.path) / "run.toml"
    toml.write_text(f"synthetic = true\n{toml.read_text()}")
    run = runs.open(run.path)
    assert burned().min() < 0.5


# ---- rasters


def test_bil(tmp_path, converted):
    """Write a raster as ELMFIRE does before conversion: with a .hdr, rows from the north."""
    rasterio = pytest.importorskip("rasterio")
    arrival = np.arange(12, dtype=np.float32).reshape(3, 4) * 60
    arrival[2, 3] = -9999
    path = tmp_path / "time_of_arrival_0000001_0001200.bil"
    with rasterio.open(
        path, "w", driver="EHdr", width=4, height=3, count=1, dtype="float32",
        transform=rasterio.transform.from_origin(9.0, 42.0, 0.001, 0.001),
    ) as file:  # fmt: skip
        file.write(arrival, 1)
    run = converted([path], start="2020-07-01", projection="EPSG:4326")
    expected = np.where(arrival == -9999, np.nan, arrival)
    assert run.latitude[0] > run.latitude[-1]
    np.testing.assert_array_equal(run.fuel_arrival_time(), expected)
    assert run.latitude[0] == pytest.approx(41.9995)


@pytest.mark.parametrize(
    ("code", "height", "density"),
    [(1, 1.0, 1.0), (2, 0.3048, 16.018463), (3, 0.1, 0.01), (4, 0.03048, 0.016018463), (0, 0.1, 0.01)],
)
def test_units_of_a_landscape(tmp_path, code, height, density):
    layers = np.full((2, 3, 8), 40, np.int16)
    layers[0, 0] = -9999
    path = made.lcp(tmp_path / "a.lcp", layers, height_unit=code, density_unit=code)
    (tmp_path / "a.prj").write_text("EPSG:5070")
    found = raster.landscape(path)
    assert found["height"].values[1, 1] == pytest.approx(40 * height)
    assert found["base_height"].values[1, 1] == pytest.approx(40 * height)
    assert found["bulk_density"].values[1, 1] == pytest.approx(40 * density)
    assert np.isnan(found["height"].values[0, 0])
    assert found["elevation"].projection == "EPSG:5070"
