"""Fire models' files become runs: each model's structure and its traps, exact numbers, places and totals."""

import re
import tomllib
from datetime import UTC, datetime
from pathlib import Path

import model_files as made
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.jobs import convert
from firetwin.run import areas, info, released
from firetwin.run import opening as runs
from firetwin.run.models import fuels, heat_from_intensity
from firetwin.run.readers import forefire
from firetwin_core import constants
from model_files import said

START = made.START.replace(tzinfo=UTC)


def source(run):
    return tomllib.loads((Path(run.path) / "run.toml").read_text())["source"]


def moment(run):
    return datetime.fromisoformat(run.start)


def burned_area(run):
    factors = areas.cell_areas(run.fuel_latitude, run.fuel_longitude)
    return float((factors * (run.fuel_arrival_time() <= run.times[-1])).sum())


# ---- WRF-SFIRE


def test_wrf_sfire(tmp_path, converted):
    paths, truth = made.wrf(tmp_path)
    run = converted(paths[::-1])
    assert source(run)["model"] == "WRF-SFIRE"
    assert source(run)["version"] == "V4.4"
    assert "+proj=lcc" in source(run)["projection"]
    assert "sphere of 6370 km are used as WGS84 coordinates" in said(run)
    assert moment(run) == START
    np.testing.assert_array_equal(run.times, [60, 120, 180])
    for i in range(3):
        np.testing.assert_array_equal(run.heat_flux(i), truth["FGRNHFX"][i])
        np.testing.assert_array_equal(run.burned_fraction(i), truth["FIRE_AREA"][i])
    np.testing.assert_array_equal(
        run.elevation, truth["ZSF"][: made.NY * made.SR, : made.NX * made.SR].astype(np.float32)
    )
    np.testing.assert_allclose(run.fuel_latitude, truth["lat"][:, 0], atol=2e-5)
    np.testing.assert_allclose(run.fuel_longitude, truth["lon"][0], atol=2e-5)
    arrival = run.fuel_arrival_time()
    assert arrival.shape == (made.NY * made.SR, made.NX * made.SR)  # the junk edge is not there
    inside = truth["x"] < made.SPEED * 180
    np.testing.assert_allclose(arrival[inside], truth["x"][inside] / made.SPEED, rtol=1e-6)
    assert (~inside).any()
    assert not np.isfinite(arrival[~inside]).any()  # TIGN_G there is no time of arrival
    load = np.asarray(run.surface_fuel)
    np.testing.assert_array_equal(np.unique(load), np.float32([0, fuels.SFIRE[0], fuels.SFIRE[7]]))


def test_wrf_sfire_in_three_dimensions(tmp_path, converted):
    paths, truth = made.wrf(tmp_path)
    run = converted(paths)
    kelvin = np.load(f"{run.path}/temperature_3d.npy")
    pressure = truth["PB"][1] + np.float32(12)
    expected = (truth["T"][1] + 300.0) * (pressure / 1e5) ** (287 / 1004.5)
    np.testing.assert_allclose(kelvin[1], expected, rtol=1e-6)
    np.testing.assert_allclose(
        np.load(f"{run.path}/height_3d.npy")[0, :, 0, 0], 925 + 50 * np.arange(made.LEVELS)
    )
    smoke = np.load(f"{run.path}/smoke_3d.npy")[1]
    np.testing.assert_allclose(smoke, truth["tr17_1"][1] * 1e-3 * pressure / (287 * expected), rtol=1e-5)
    east, up = (np.load(f"{run.path}/wind_{way}_3d.npy")[0] for way in ("east", "up"))
    np.testing.assert_allclose(
        east[0, 0], np.arange(made.NX) + 0.5, atol=1e-3
    )  # staggered: means of both sides
    np.testing.assert_allclose(up[:, 0, 0], np.arange(made.LEVELS) + 0.5)


def test_wrf_sfire_keeps_the_air_on_the_grid_of_the_atmosphere(tmp_path, converted):
    """Wind is as the model has it at the middles of the atmosphere's cells, and even between them."""
    paths, truth = made.wrf(tmp_path)
    run = converted(paths)
    np.testing.assert_allclose(np.load(f"{run.path}/wind_east.npy"), truth["U10"], atol=1e-3)
    assert run.air_latitude.shape == (made.NY,)
    assert run.wind(1)[0].shape == run.elevation.shape
    half = made.SR // 2
    u = truth["U10"][1].astype(np.float64)
    along = u[0, 0] + (u[0, 1] - u[0, 0]) * (np.arange(made.SR) + 0.5) / made.SR
    np.testing.assert_allclose(
        run.wind(1)[0][0, half : half + made.SR], along, atol=5e-3
    )  # 32-bit degrees: 0.8 m of 40
    assert run.wind(1)[0][0, 0] == pytest.approx(u[0, 0])  # beyond the outermost middles


def test_wrf_sfire_without_heights_of_the_fire_grid(tmp_path, converted):
    paths, truth = made.wrf(tmp_path, without=("ZSF",))
    run = converted(paths)
    coarse = truth["HGT"]
    assert run.elevation[0, 0] == pytest.approx(coarse[0, 0])
    assert run.elevation[-1, -1] == pytest.approx(coarse[-1, -1])
    near = run.elevation[:, made.SR - 1 : made.SR + 1].mean(1)[[0, -1]]  # half-way between two middles
    assert near == pytest.approx(coarse[[0, -1], :2].mean(1), abs=1e-3)


def disc(x, y):
    """A fire of 1 m/s from a point that is not the centre of a cell."""
    return np.hypot(x - 5_720.0, y - 4_390.0)


@pytest.mark.parametrize("turn", [0.0, 20.0])
@pytest.mark.parametrize("touched", [False, True])
def test_wrf_sfire_burns_what_its_own_fire_area_says(tmp_path, converted, turn, touched):
    """At every hour, also of a young fire; cells that the front only touches do not burn as a whole."""
    times = tuple(range(600, 3601, 600))
    paths, truth = made.wrf(
        tmp_path, times=times, per_file=4, turn=turn, shape=(15, 20), cell=600.0, came=disc, touched=touched
    )
    run = converted(paths)
    own = np.array([share.sum() * 150.0**2 for share in truth["FIRE_AREA"]])
    assert np.array(info.burned(run, times)) == pytest.approx(own, rel=0.01)
    assert info.gather(run, "UTC")["burned"]["from"] == "burned_fraction"
    assert info.burned(run, [0.0, 900.0]) == pytest.approx([0.0, own[:2].mean()], rel=0.01)
    if turn == 0.0:  # the line that is drawn, too
        assert burned_area(run) == pytest.approx(own[-1], rel=0.02)


def test_wrf_sfire_where_the_flux_is_on_the_grid_of_the_atmosphere_alone(tmp_path, converted):
    paths, truth = made.wrf(tmp_path, without=("FGRNHFX", "TIGN_G"))
    run = converted(paths)
    np.testing.assert_array_equal(run.heat_flux(1), truth["GRNHFX"][1])
    np.testing.assert_array_equal(run.wind(1)[0], truth["U10"][1])
    assert not run.has("air_latitude")
    arrival = run.fuel_arrival_time()
    later = (truth["x"] > made.SPEED * 60) & (truth["x"] < made.SPEED * 180)
    np.testing.assert_allclose(arrival[later], truth["x"][later] / made.SPEED, rtol=1e-5)
    assert (arrival[truth["x"] < made.SPEED * 60] == 60).all()  # burned in the first frame: by then


def test_wrf_sfire_restarted_counts_from_the_simulation(tmp_path, converted):
    paths, truth = made.wrf(tmp_path, START_DATE="2020-07-01_18:01:00")
    run = converted(paths)
    assert moment(run) == START
    inside = truth["x"] < 100
    np.testing.assert_allclose(run.fuel_arrival_time()[inside], truth["x"][inside] / made.SPEED, rtol=1e-6)


def test_wrf_sfire_in_metres(tmp_path, converted):
    paths, _ = made.wrf(tmp_path, ideal=True)
    run = converted(paths, at="40,-105")
    assert "its centre is 40, -105" in said(run)
    north, east = areas.metres_per_degree(40.0)
    np.testing.assert_allclose(np.diff(run.fuel_longitude) * east, 10.0, rtol=1e-4)
    np.testing.assert_allclose(np.diff(run.latitude) * north, 10.0, rtol=1e-4)


def test_wrf_sfire_turned(tmp_path, converted):
    """On a rotated grid each value is the nearest cell's, the wind is rotated, and the error is printed."""
    paths, truth = made.wrf(tmp_path, turn=20.0)
    run = converted(paths)
    assert "turned or curved" in said(run)
    load = np.asarray(run.surface_fuel)
    assert load[0, 0] == load[1, 1] == np.float32(fuels.SFIRE[0])  # beyond the model's cells it goes on
    values = np.setdiff1d(run.heat_flux(1), np.append(truth["FGRNHFX"][1], 0))
    assert values.size == 0
    u, v = truth["U10"][1].ravel(), truth["V10"][1].ravel()
    turned = np.hypot(u, v).max()
    assert np.hypot(run.wind(1)[0], run.wind(1)[1]).max() <= turned * 1.0001
    there = np.load(f"{run.path}/wind_east.npy")[1]
    c, s = np.cos(np.radians(20)), np.sin(np.radians(20))
    east = (u * c - v * s).astype(np.float32)
    assert np.abs(there.ravel()[:, None] - east[None]).min(axis=1).max() < 1e-2
    x, y = np.meshgrid(run.fuel_longitude, run.fuel_latitude)
    along = c * (x + 120) * 111_300 * np.cos(np.radians(39)) + s * (y - 39) * 111_100
    arrival = run.fuel_arrival_time()
    known = np.isfinite(arrival)
    assert np.abs(arrival[known] * made.SPEED - along[known]).max() < 7.5  # m: half a diagonal and a float
    assert burned_area(run) == pytest.approx((truth["x"] < made.SPEED * 180).sum() * 100.0, rel=0.07)


# ---- CFBM


def test_cfbm(tmp_path, converted):
    paths, truth = made.cfbm(tmp_path)
    run = converted(paths)
    assert source(run)["model"] == "Community Fire Behavior Model"
    assert "sphere of 6370 km are used as WGS84 coordinates" in said(run)
    assert moment(run) == START
    np.testing.assert_array_equal(run.times, [0, 30, 60, 90])
    for i in (1, 2, 3):
        np.testing.assert_array_equal(
            run.heat_flux(i), truth["flux"][i]
        )  # all rows and columns, all tiny values
        share = np.clip(0.5 - (truth["x"] - made.SPEED * 30 * i) / 10.0, 0, 1)
        np.testing.assert_allclose(run.burned_fraction(i), share, atol=1e-6)
    assert run.heat_flux(0).max() == 0  # never set by the model
    np.testing.assert_allclose(run.latitude, truth["lat"].mean(1), rtol=1e-12)
    arrival = run.fuel_arrival_time()
    later = (truth["x"] > made.SPEED * 30) & (truth["x"] < made.SPEED * 90)
    np.testing.assert_allclose(arrival[later], truth["x"][later] / made.SPEED, rtol=1e-5)
    assert (
        arrival[truth["x"] < made.SPEED * 30] == 15
    ).all()  # no level function before ignition: the middle
    assert not np.isfinite(arrival[truth["x"] > made.SPEED * 90]).any()
    np.testing.assert_allclose(run.wind(1)[0], 3.0, rtol=1e-3)


def test_what_is_assumed_where_fuel_and_height_are_not_said_is_said(tmp_path, converted):
    paths, _ = made.cfbm(tmp_path, count=2)
    for path in paths:
        with made.netCDF4.Dataset(path, "a") as file:
            file.renameVariable("nfuel_cat", "a")
            file.renameVariable("zsf", "b")
    assumed = said(converted(paths))
    assert "1 kg/m2 of surface fuel is assumed everywhere" in assumed
    assert "the ground is flat, at 0 m" in assumed


def test_cfbm_without_a_time_in_its_name(tmp_path, converted):
    paths, _ = made.cfbm(tmp_path, count=1)
    with pytest.raises(InputError, match="its time is in its name only"):
        converted([paths[0].rename(tmp_path / "first.nc")])


# ---- ForeFire


def round_fire(shape, cell, speed=0.3):
    """A round fire from the middle, its ignition negative as the model writes it."""
    y, x = ((np.arange(n) - (n - 1) / 2) * side for n, side in zip(shape, cell, strict=True))
    arrival = np.hypot(*np.meshgrid(x, y)) / speed - 15.0
    return np.where(arrival > 1200, -9999.0, arrival)


def test_forefire(tmp_path, converted):
    arrival = round_fire((51, 101), (20.0, 30.0))
    run = converted([made.forefire(tmp_path / "ForeFire.0.nc", arrival, lx=3030.0, ly=1020.0)], at="42,9")
    assert moment(run) == datetime(2020, 7, 18, tzinfo=UTC)
    found = run.fuel_arrival_time()
    np.testing.assert_array_equal(found, np.where(arrival == -9999, np.nan, arrival).astype(np.float32))
    assert (found < 0).any()  # ignitions burn
    north, east = areas.metres_per_degree(42.0)
    np.testing.assert_allclose(np.diff(run.longitude) * east, 30.0, rtol=1e-6)  # cells are not square
    np.testing.assert_allclose(np.diff(run.latitude) * north, 20.0, rtol=1e-6)
    burned = (arrival > -9999).sum() * 600.0
    assert released.energy(run) == pytest.approx(
        burned * constants.HEAT_OF_COMBUSTION, rel=3e-3
    )  # 1 kg/m2, as printed
    assert "1 kg/m2" in said(run)


def test_forefire_fronts_place_and_date_it(tmp_path, converted):
    import json

    arrival = round_fire((60, 60), (20.0, 20.0))
    path = made.forefire(tmp_path / "ForeFire.0.nc", arrival, lx=1200.0, ly=1200.0)
    ring = [[9.0 + 0.004 * c, 42.0 + 0.003 * s, 0] for c, s in ((-1, 0), (0, 1), (1, 0), (0, -1), (-1, 0))]
    front = {"valid_at": "2020-07-18T14:00:00Z", "features": [{"geometry": {"coordinates": [[ring]]}}]}
    (tmp_path / "a.geojson").write_text(json.dumps(front))
    run = converted([path, tmp_path / "a.geojson"])
    assert abs((run.latitude[0] + run.latitude[-1]) / 2 - 42.0) < 1e-6
    assert abs((run.longitude[0] + run.longitude[-1]) / 2 - 9.0) < 1e-6
    last = np.ceil(arrival.max())
    assert (datetime(2020, 7, 18, 14, tzinfo=UTC) - moment(run)).total_seconds() == last
    ring[0][1] = 88.0  # of a domain with a UTM corner
    (tmp_path / "a.geojson").write_text(json.dumps(front))
    (tmp_path / "run").rename(tmp_path / "before")
    assert "fronts that are not used: a.geojson: beyond 84 degrees" in said(
        converted([path, tmp_path / "a.geojson"])
    )


def test_fronts_that_are_not_used_are_named_in_one_line(tmp_path):
    import json

    notes = []
    for k in range(19):
        front = {"type": "FeatureCollection", "features": [{"geometry": {"coordinates": [[1.0, 89.0]]}}]}
        (tmp_path / f"front{k:02d}.geojson").write_text(json.dumps(front))
        (tmp_path / f"own{k:02d}.json").write_text('{"fronts": []}')
    assert forefire._fronts(sorted(tmp_path.iterdir()), notes) == []
    assert notes == [
        "fronts that are not used: 19 files (own00.json to own18.json): the model's own JSON, which has no "
        "degrees",
        "fronts that are not used: 19 files (front00.geojson to front18.geojson): beyond 84 degrees, as "
        "fronts of a UTM corner are written",
    ]


def test_forefire_itself(tmp_path):
    """The model runs, and its output is converted: area, position and time."""
    pytest.importorskip("pyforefire", reason="pip install forefire")
    import subprocess
    import sys

    code = """
import os, pyforefire
ff = pyforefire.ForeFire()
os.mkdir("ForeFire")
ff["caseDirectory"] = os.getcwd()
for key, value in {"spatialIncrement": 3., "perimeterResolution": 10., "atmoNX": 40, "atmoNY": 30,
                   "refYear": 2020, "refDay": 200, "minimalPropagativeFrontDepth": 10.}.items():
    ff[key] = value
ff.execute("FireDomain[sw=(0,0,0);ne=(3000,2000,0);t=0]")
ff.addLayer("propagation", "Iso", "propagationModel")
ff.execute("startFire[loc=(1500,1000,0);t=0]")
ff.execute("step[dt=900]")
ff["dumpMode"] = "geojson"
ff.execute("print[front.geojson]")
ff["dumpMode"] = "json"
ff.execute("print[front.json]")
ff.execute("save[]")
"""
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, timeout=60, capture_output=True)
    convert.in_process(
        [tmp_path / name for name in ("ForeFire.0.nc", "front.geojson", "front.json")],
        tmp_path / "run",
        ["", "", "", 0],
    )
    run = runs.open(tmp_path / "run")
    raw = np.asarray(made.netCDF4.Dataset(tmp_path / "ForeFire.0.nc")["arrival_time_of_front"][:])
    arrival = run.fuel_arrival_time()
    np.testing.assert_array_equal(np.isfinite(arrival), raw != -9999)
    np.testing.assert_array_equal(arrival[raw != -9999], raw[raw != -9999].astype(np.float32))
    cell = 3000 * 2000 / raw.size
    assert burned_area(run) == pytest.approx((raw != -9999).sum() * cell, rel=1e-3)
    assert moment(run) == datetime(2020, 7, 18, tzinfo=UTC)
    import json

    (front,) = json.loads((tmp_path / "front.json").read_text())["fronts"]
    own = float(front["area"].removesuffix("ha")) * 1e4
    assert own * 1.0 < burned_area(run) < own * 1.1  # a touched cell counts: as stated
    shapely = pytest.importorskip("shapely")
    data = json.loads((tmp_path / "front.geojson").read_text())
    rings = [
        np.array(ring)[:, :2] for f in data["features"] for p in f["geometry"]["coordinates"] for ring in p
    ]
    west, south, east, north = shapely.Polygon(np.concatenate(rings)).bounds
    dx, dy = abs(np.diff(run.longitude).mean()), abs(np.diff(run.latitude).mean())
    burned = np.isfinite(arrival)
    columns, rows = run.fuel_longitude[burned.any(0)], run.fuel_latitude[burned.any(1)]
    assert abs(columns.min() - west) < 1.5 * dx  # a touched cell counts
    assert abs(columns.max() - east) < 1.5 * dx
    assert abs(rows.min() - south) < 1.5 * dy
    assert abs(rows.max() - north) < 1.5 * dy


# ---- ELMFIRE, FARSITE, pyretechnics


def plane(ny=20, nx=30, cell=30.0, speed=0.5, until=600.0):
    """Arrival (s) of a front that moves along rows, and its fuel numbers."""
    x = (np.arange(nx) + 0.5) * cell + np.zeros((ny, 1))
    arrival = np.where(x / speed <= until * 2, x / speed, np.nan).astype(np.float32)
    return arrival, np.where(x < 300, 102, np.where(x < 600, 165, 98)).astype(np.int16)


def test_elmfire(tmp_path, converted):
    arrival, number = plane()
    case = "0000001_0001200"
    files = [made.tiff(tmp_path / f"time_of_arrival_{case}.tif", np.where(np.isnan(arrival), -9999, arrival))]
    flin = np.where(np.isnan(arrival), -9999, 500.0).astype(np.float32)  # kW/m
    files.append(made.tiff(tmp_path / f"flin_{case}.tif", flin))
    files.append(made.tiff(tmp_path / f"vs_{case}.tif", np.full_like(flin, 0.5 / 0.3048 * 60)))  # ft/min
    files.append(made.tiff(tmp_path / "fbfm40.tif", number))
    files.append(made.tiff(tmp_path / "cbd.tif", np.full(number.shape, 12, np.int16)))
    files.append(made.tiff(tmp_path / "ch.tif", np.full(number.shape, 150, np.int16)))
    files.append(made.tiff(tmp_path / "cbh.tif", np.full(number.shape, 50, np.int16)))
    files.append(made.tiff(tmp_path / "dem.tif", np.full(number.shape, 900, np.int16)))
    run = converted(files, start="2020-07-01T20:00:00Z")
    assert source(run)["model"] == "ELMFIRE"
    assert np.unique(run.canopy_fuel).max() == pytest.approx(0.12 * 10.0)
    assert set(np.unique(run.surface_fuel)) <= {np.float32(0), np.float32(0.247), np.float32(3.138)}
    assert set(np.unique(run.fuel_rows("fuel_category", 0, len(run.fuel_latitude)))) <= {102, 165, 98}
    assert run.elevation.max() == 900
    burns = np.isfinite(arrival)
    joules = (fuels.loads(number) + 1.2)[burns].mean() * constants.HEAT_OF_COMBUSTION  # a m2
    own = float(re.search(r"heat per area is ([\d.e+]+) times", said(run))[1])
    assert own == pytest.approx(500e3 / 0.5 / joules, rel=5e-3)  # kW/m over ft/min
    cell = areas.cell_areas(run.latitude, run.longitude)
    burned = np.isfinite(run.fuel_arrival_time())
    fuel = (np.asarray(run.surface_fuel) + np.asarray(run.canopy_fuel)) * burned * cell
    assert released.energy(run) == pytest.approx(fuel.sum() * constants.HEAT_OF_COMBUSTION, rel=1e-3)
    place = run.latitude[-1], run.longitude[0]  # a corner, by PROJ
    from pyproj import Transformer

    x, y = Transformer.from_crs("EPSG:4326", "EPSG:32610", always_xy=True).transform(place[1], place[0])
    assert abs(x - 500_015) < 30
    assert abs(y - (4_300_000 - 15 if run.latitude[-1] > run.latitude[0] else 4_300_000 - 585)) < 30


def test_heat_is_that_of_the_fuel_burned(tmp_path, converted):
    """Made of intensity on a grid that needs no turning: the total is exact."""
    arrival, number = plane()
    minutes = made.ascii_grid(tmp_path / "FlamMap_Arrival Time.asc", arrival / 60)
    made.ascii_grid(tmp_path / "FlamMap_Intensity.asc", np.where(np.isnan(arrival), np.nan, 400.0))
    layers = np.zeros((*number.shape, 8), np.int16)
    layers[..., 3], layers[..., 5], layers[..., 6], layers[..., 7] = number, 150, 50, 12
    land = made.lcp(tmp_path / "land.lcp", layers, north=number.shape[0] * 30.0)
    files = [minutes, tmp_path / "FlamMap_Intensity.asc", land]
    run = converted(files, start="2020-07-01T20:00:00Z")
    assert source(run)["model"] == "FARSITE or FlamMap"
    np.testing.assert_allclose(run.fuel_arrival_time(), arrival, rtol=1e-6)  # minutes become seconds
    cell = areas.cell_areas(run.latitude, run.longitude)
    burned = np.isfinite(run.fuel_arrival_time())
    fuel = (np.asarray(run.surface_fuel, np.float64) + np.asarray(run.canopy_fuel)) * burned * cell
    step = np.diff(run.times)
    released = sum(float((run.heat_flux(i + 1) * cell).sum()) * step[i] for i in range(len(step)))
    assert released == pytest.approx(fuel.sum() * constants.HEAT_OF_COMBUSTION, rel=1e-5)
    assert np.unique(run.canopy_fuel) == pytest.approx([1.2])


def two_fires(folder, *, speed=True, fuel=True):
    """ELMFIRE's rasters of two fires that meet, one of which stands at a road for an hour."""
    y, x = np.mgrid[:60, :80] * 30.0
    from_a, from_b = (np.hypot(x - a, 1.6 * (y - b)) / v for a, b, v in ((450, 750, 0.5), (1800, 1000, 0.35)))
    arrival = np.minimum(from_a, from_b) + 3600.0 * ((x > 1350) & (y < 450))
    number = np.where(y < 600, 102, np.where(x < 1200, 165, 145)).astype(np.int16)
    number[:, 35] = 98
    burned, case = (arrival < 5000) & (number != 98), "0000001_0005000"
    pace = 0.5 * np.random.default_rng(1).uniform(0.3, 1.5, x.shape)
    layers = {
        "time_of_arrival": arrival,
        "flin": 0.3 * fuels.loads(number) * constants.HEAT_OF_COMBUSTION * pace / 1e3,
    }
    layers |= {"vs": pace / 0.3048 * 60} if speed else {}
    folder.mkdir()
    paths = [
        made.tiff(folder / f"{name}_{case}.tif", np.where(burned, values, -9999).astype(np.float32))
        for name, values in layers.items()
    ]
    if fuel:
        trees = number == 165
        for name, values in {
            "fbfm40": number,
            "cbd": 12 * trees,
            "ch": 150 * trees,
            "cbh": 50 * trees,
        }.items():
            made.tiff(folder / f"{name}.tif", values.astype(np.int16))
    return paths, fuels.loads(number)[burned]


@pytest.mark.parametrize("speed", [True, False])
@pytest.mark.parametrize("fuel", [True, False])
def test_no_cell_releases_more_than_its_fuel(tmp_path, converted, speed, fuel):
    """Nor is less released in total; the rasters are next to files that are named without them."""
    paths, load = two_fires(tmp_path / "elmfire", speed=speed, fuel=fuel)
    run = converted(paths, start="2020-07-01T20:00:00Z")
    burned = np.isfinite(run.fuel_arrival_time())
    own = np.asarray(run.surface_fuel, np.float64) + run.canopy_fuel
    assert (run.heat_released() <= 1.001 * own * constants.HEAT_OF_COMBUSTION)[burned].all()
    assert released.energy(run) == pytest.approx(released.of_fuel(run), rel=1e-3)
    assert released.warnings(released.energy(run), released.of_fuel(run)) == []
    if fuel:
        assert np.median(run.surface_fuel[burned]) == pytest.approx(np.median(load))
        assert "fbfm40.tif, a companion raster" in said(run)
    elif speed:
        assert own[burned].mean() == pytest.approx(0.3 * load.mean(), rel=0.02)
    assert own.max() < 1.01 * load.max() + 1.2


def test_fuels_that_lie_elsewhere_are_not_used(tmp_path, converted):
    paths, _ = two_fires(tmp_path / "elmfire", fuel=False)
    made.tiff(tmp_path / "elmfire/fbfm40.tif", np.full((60, 80), 102, np.int16), west=300_000.0)
    run = converted(paths, start="2020-07-01T20:00:00Z")
    assert "fbfm40.tif does not overlap the model's grid" in said(run)
    assert np.asarray(run.surface_fuel).min() > 0.0


def test_rasters_of_no_projection_lie_where_their_fuels_say(tmp_path, converted):
    """Rasters of ELMFIRE without a projection, before conversion: the fuels next to them have one."""
    arrival, number = plane()
    values = np.where(np.isnan(arrival), -9999, arrival).astype(np.float32)
    bare = made.tiff(tmp_path / "time_of_arrival_0000001_0001200.tif", values, projection=None)
    made.tiff(tmp_path / "fbfm40.tif", number)
    run = converted([bare], start="2020-07-01T20:00:00Z")
    assert 38.0 < run.latitude[0] < 40.0
    assert set(np.unique(run.surface_fuel)) == {np.float32(0), np.float32(0.247), np.float32(3.138)}


def test_heat_by_intensity_of_a_late_cell_is_that_of_its_neighbours():
    """It was the 13 kg/m2 of the heaviest fuel; heavy fuel keeps its own."""
    fuel, speed = np.full((12, 30), 0.8), 0.2
    fuel[:, 20:] = 4.0
    arrival = np.tile(np.arange(30) * 30.0 / speed, (12, 1))
    intensity = fuel * constants.HEAT_OF_COMBUSTION * speed
    exact = heat_from_intensity.of_intensity(arrival, intensity, None, (30.0, 30.0))
    np.testing.assert_allclose(exact, fuel * constants.HEAT_OF_COMBUSTION, rtol=1e-9)
    late = arrival.copy()
    late[4::4, 3:18:4] += 5000.0
    found = heat_from_intensity.of_intensity(late, intensity, None, (30.0, 30.0))
    np.testing.assert_allclose(found, exact, rtol=1e-9)  # the sum was 15 % more


@pytest.mark.parametrize("layer", ["flin", "hpua"])
def test_fuel_by_heat_is_bounded_by_the_heaviest_fuel_model(tmp_path, converted, layer):
    """A block of late cells, and heats per area beyond all fuels: both are limited, counted and named."""
    arrival, _ = plane()
    arrival[4:8, 8:12] += 20_000.0
    case, heat = "0000001_0001200", np.full(arrival.shape, 2.0 * constants.HEAT_OF_COMBUSTION / 1e3)
    heat[4:8, 8:12] *= 100.0
    values = heat if layer == "hpua" else heat * 0.5
    for name, each in (("time_of_arrival", arrival), (layer, values)):
        made.tiff(
            tmp_path / f"{name}_{case}.tif", np.where(np.isnan(arrival), -9999, each).astype(np.float32)
        )
    run = converted(sorted(tmp_path.glob("*.tif")), start="2020-07-01T20:00:00Z")
    assert np.asarray(run.surface_fuel).max() == pytest.approx(fuels.HEAVIEST)
    text = r"(\d+) of 400 burned cells have more heat per area than the heaviest fuel model, 13 kg/m2"
    assert 16 <= int(re.search(text, said(run))[1]) <= 20  # and slow cells next to the block


def test_a_run_that_releases_more_than_its_fuel_is_warned_of(make_run):
    path = make_run()
    found = info.gather(runs.open(path), "UTC")
    assert not any("times the heat of the fuel" in text for text in found["warnings"])
    np.save(path / "heat_flux.npy", 1e4 * np.load(path / "heat_flux.npy"))
    found = info.gather(runs.open(path), "UTC")
    assert any("times the heat of the fuel" in text for text in found["warnings"])


def test_an_lcp_is_what_gdal_reads(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    from firetwin.run.models import raster

    layers = np.random.default_rng(3).integers(0, 300, (7, 9, 8)).astype(np.int16)
    path = made.lcp(tmp_path / "a.lcp", layers, north=210.0)
    maps = raster.landscape(path)
    with rasterio.open(path, driver="LCP") as file:
        np.testing.assert_array_equal(maps["elevation"].values, file.read(1))
        np.testing.assert_allclose(maps["height"].values, file.read(6) / 10, rtol=1e-6)
        np.testing.assert_allclose(maps["bulk_density"].values, file.read(8) / 100, rtol=1e-6)
        assert file.transform * (0.5, 0.5) == pytest.approx((maps["elevation"].x[0], maps["elevation"].y[0]))


def test_an_ascii_grid_is_what_gdal_reads(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    from firetwin.run.models import raster

    values = np.random.default_rng(4).uniform(0.0, 9.0, (7, 9)).astype(np.float32)
    values[2, 3] = np.nan
    path = made.ascii_grid(tmp_path / "a.asc", values, cell=30.0, west=600.0, south=900.0)
    found = raster.read(path)
    with rasterio.open(path, driver="AAIGrid") as file:
        expected = file.read(1)
        np.testing.assert_array_equal(found.values, np.where(expected == file.nodata, np.nan, expected))
        corners = [file.xy(0, 0), file.xy(6, 8)]
    assert [(found.x[i], found.y[i]) for i in (0, -1)] == [pytest.approx(corner) for corner in corners]


def test_pyretechnics_itself(tmp_path, converted):
    pytest.importorskip("pyretechnics", reason="pip install 'firetwin[simulate]', which compiles for minutes")
    from pyretechnics.eulerian_level_set import SpreadState, spread_fire_with_phi_field
    from pyretechnics.space_time_cube import SpaceTimeCube

    shape = (1, 40, 50)
    values = {"slope": 0, "aspect": 0, "fuel_model": 102, "canopy_cover": 0, "canopy_height": 0}
    values |= {
        "canopy_base_height": 0,
        "canopy_bulk_density": 0,
        "wind_speed_10m": 30,
        "upwind_direction": 270,
    }
    values |= {f"fuel_moisture_dead_{k}hr": 0.05 for k in (1, 10, 100)}
    values |= {"fuel_moisture_live_herbaceous": 0.9, "fuel_moisture_live_woody": 0.6, "foliar_moisture": 0.9}
    values |= {"fuel_spread_adjustment": 1, "weather_spread_adjustment": 1}
    cubes = {name: SpaceTimeCube(shape, value) for name, value in values.items()}
    state = SpreadState(shape).ignite_cell((20, 20))
    done = spread_fire_with_phi_field(cubes, state, (60.0, 30.0, 30.0), 0.0, 60.0)
    matrices = done["spread_state"].get_full_matrices()
    path = tmp_path / "out.npz"
    np.savez(path, **matrices, cell_width=30.0, cell_height=30.0)
    run = converted([path], start="2020-07-01T20:00:00Z", at="39,-120")
    arrival = run.fuel_arrival_time()
    raw = matrices["time_of_arrival"]
    burned = np.isfinite(raw) & (raw >= 0)
    np.testing.assert_array_equal(np.isfinite(arrival), burned)
    np.testing.assert_allclose(arrival[burned], raw[burned] * 60, rtol=1e-6)
    assert burned_area(run) == pytest.approx(burned.sum() * 900.0, rel=1e-3)
    assert run.latitude[0] < run.latitude[-1]  # rows are from the south
    assert np.flatnonzero(burned.any(0)).max() > 22  # the wind blows it east


# ---- any CF netCDF


def test_any_netcdf_by_a_mapping(tmp_path, converted):
    path, expected = made.cf(tmp_path / "a.nc")
    mapping = tmp_path / "map.toml"
    mapping.write_text('[fields]\nheat_flux = { variable = "hfx", scale = 2.0 }\n')
    run = converted([path, mapping])
    assert moment(run) == START
    np.testing.assert_array_equal(run.heat_flux(1), (expected[1] * 2).astype(np.float32))
    np.testing.assert_allclose(run.latitude, 39 + 0.001 * np.arange(5), rtol=1e-12)


def test_many_netcdf_files_are_each_read_for_what_is_theirs(tmp_path, converted):
    """More files than are open at once: facts about the first are not read from another."""
    paths = [made.cf(tmp_path / f"{k:02}.nc", name="heat_flux", times=(60 * k,))[0] for k in range(12)]
    for k, path in enumerate(paths):
        with made.netCDF4.Dataset(path, "a") as f:
            f.title = f"file {k}"
            if k == 0:
                f.createVariable("elevation", "f8", ("y", "x"))[:] = 700.0
    run = converted(paths)
    assert run.name == "run (file 0)"
    np.testing.assert_array_equal(run.elevation, 700.0)


def test_chunks_of_several_times_are_unpacked_once(tmp_path):
    """Chunks as libraries choose them if time is not unlimited."""
    from firetwin.run.models import netcdf

    with made.netCDF4.Dataset(tmp_path / "a.nc", "w") as f:
        for dim, size in (("t", 8), ("y", 60), ("x", 50)):
            f.createDimension(dim, size)
        f.createVariable("flux", "f4", ("t", "y", "x"), zlib=True, chunksizes=(4, 32, 32))[:] = 1.0
    file = netcdf.File(tmp_path / "a.nc")
    file.read("flux", 3)
    size, count, _ = file.variables["flux"].get_var_chunk_cache()
    assert size >= 4 * 64 * 64 * 4
    assert count >= 4
    assert size < 2 << 20
    file.close()


def test_a_netcdf_of_no_known_model_says_how_to_map_it(tmp_path, converted):
    path, _ = made.cf(tmp_path / "a.nc")
    with pytest.raises(InputError, match=r"hfx, la, lo, t.*\[fields\] heat_flux"):
        converted([path])
    (tmp_path / "map.toml").write_text('[fields]\nheatflux = "hfx"\n')
    with pytest.raises(InputError, match="unknown field heatflux"):
        converted([path, tmp_path / "map.toml"])


def test_a_start_that_nothing_says_is_asked_for(tmp_path, converted):
    arrival, _ = plane()
    path = made.ascii_grid(tmp_path / "x_Arrival Time.asc", arrival / 60)
    with pytest.raises(InputError, match="--start"):
        converted([path])
