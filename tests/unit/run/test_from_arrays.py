"""A run from arrays, GeoTIFF bands or netCDF masks: the same arrival times, and the page's own code runs."""

import re
from datetime import UTC, datetime
from pathlib import Path

import firetwin.cli
import firetwin.run
import numpy as np
import pytest
from firetwin.errors import Error, InputError, UsageError
from firetwin.run import opening as runs
from firetwin.run import readers

PAGE = Path(__file__).parents[3] / "docs/runs.md"
START = datetime(2014, 9, 17, 19, tzinfo=UTC)
LATITUDE, LONGITUDE = 38.9 + 0.001 * np.arange(20), -120.6 + 0.001 * np.arange(30)
HOURS = 3600.0 * np.arange(6)
FRONT = np.broadcast_to(np.arange(30) * 600.0, (20, 30))
"""Arrival, s: 6 columns an hour."""


def masks():
    return (FRONT[None] < HOURS[:, None, None]).astype(np.float32)


def expected():
    """The middle of the hour in which a cell's mask turns; NaN for never."""
    middle = 3600.0 * (np.floor(FRONT / 3600.0) + 0.5)
    return np.where(HOURS[-1] > FRONT, middle, np.nan)


def check(run):
    assert datetime.fromisoformat(run.start) == START
    np.testing.assert_allclose(run.fuel_arrival_time(), expected(), rtol=1e-6)
    flux = np.stack([run.heat_flux(index) for index in range(len(run.times))])
    burning = np.isfinite(expected())
    assert (flux.max(axis=0) > 0.0).tolist() == burning.tolist()


def place():
    return {"start": START, "latitude": LATITUDE, "longitude": LONGITUDE}


def test_the_code_on_the_page_runs(tmp_path, monkeypatch):
    section = PAGE.read_text("utf-8").partition("## Your model is not listed")[2]
    code = re.search(r"```python\n(.*?)```", section, re.DOTALL)[1]
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    called = []
    monkeypatch.setattr(firetwin.cli, "main", called.append)  # the film takes minutes
    monkeypatch.chdir(tmp_path)
    exec(compile(code, str(PAGE), "exec"), {})
    assert called == [["render", "my_run", "--out", "my_film"]]
    run = readers.open(tmp_path / "my_run")
    assert run.name == "my_run"
    assert np.nanmin(run.fuel_arrival_time()) == 1800.0


def test_masks_and_their_arrival_times_make_one_run(tmp_path):
    by_masks = firetwin.run.write(tmp_path / "a", **place(), burned=masks(), times=HOURS)
    by_times = firetwin.run.write(tmp_path / "b", **place(), arrival=expected(), elevation=FRONT / 100.0)
    check(runs.open(by_masks))
    check(runs.open(by_times))
    np.testing.assert_allclose(runs.open(by_times).elevation, FRONT / 100.0)


def test_a_burned_share_is_interpolated(tmp_path):
    share = np.linspace(0.0, 1.0, 6)[:, None, None] * np.ones((20, 30))
    run = runs.open(firetwin.run.write(tmp_path / "a", **place(), burned=share, times=HOURS))
    np.testing.assert_allclose(run.fuel_arrival_time(), 2.5 * 3600.0)


@pytest.mark.parametrize(
    ("change", "kind", "message"),
    [
        ({}, UsageError, "give arrival, or burned and times"),
        ({"burned": masks()}, UsageError, "give arrival, or burned and times"),
        ({"burned": masks(), "times": HOURS[1:]}, UsageError, "has 6 times, and times has 5"),
        ({"burned": 100 * masks(), "times": HOURS}, InputError, "0 to 100, not 0 to 1"),
        ({"burned": 0 * masks(), "times": HOURS}, Error, "nothing burns"),
        ({"arrival": FRONT.T}, InputError, r"\(30, 20\) on a grid of \(20, 30\)"),
        ({"arrival": FRONT, "start": "noon"}, UsageError, "is not a time"),
    ],
)
def test_arrays_that_make_no_run_are_refused(tmp_path, change, kind, message):
    with pytest.raises(kind, match=message):
        firetwin.run.write(tmp_path / "run", **(place() | change))
    assert not (tmp_path / "run").exists()


def geotiff(path, values, texts=None):
    import rasterio

    step, (west, north) = 0.001, (LONGITUDE[0] - 0.0005, LATITUDE[-1] + 0.0005)
    where = rasterio.transform.from_origin(west, north, step, step)
    count, height, width = values.shape
    kind = {"count": count, "height": height, "width": width, "dtype": values.dtype}
    with rasterio.open(path, "w", driver="GTiff", crs="EPSG:4326", transform=where, **kind) as file:
        file.write(values[:, ::-1])
        if texts:
            file.descriptions = texts
    return path


@pytest.mark.parametrize("dated", [True, False])
def test_a_geotiff_of_hourly_masks(tmp_path, converted, dated):
    texts = [f"2014-09-17T{19 + hour}:00:00Z" if hour < 5 else "2014-09-18T00:00:00Z" for hour in range(6)]
    path = geotiff(tmp_path / "burned_mask.tif", (255 * masks()).astype(np.uint8), texts if dated else None)
    run = converted([path], start="" if dated else "2014-09-17T19:00:00Z")
    np.testing.assert_allclose(
        run.fuel_arrival_time()[:: np.sign(np.diff(run.latitude)[0]).astype(int)], expected()
    )
    assert datetime.fromisoformat(run.start) == START


def test_a_geotiff_without_times_or_with_one_band_is_refused(tmp_path, converted):
    path = geotiff(tmp_path / "mask.tif", masks())
    with pytest.raises(InputError, match="--start"):
        converted([path])
    with pytest.raises(InputError, match="a band for each time"):
        converted([geotiff(tmp_path / "fraction.tif", masks()[:1])], start="2014-09-17T19:00:00Z")


def netcdf(path, **variables):
    library = pytest.importorskip("netCDF4")
    with library.Dataset(path, "w") as file:
        for name, size in (("time", 6), ("y", 20), ("x", 30)):
            file.createDimension(name, size)
        axes = (("time", "time", HOURS, "seconds since 2014-09-17 19:00:00"),)
        axes += (("lat", "y", LATITUDE, "degrees_north"), ("lon", "x", LONGITUDE, "degrees_east"))
        for name, dimension, values, units in axes:
            file.createVariable(name, "f8", (dimension,))[:] = values
            file[name].units = units
        for name, values in variables.items():
            file.createVariable(name, "f4", ("time", "y", "x")[3 - values.ndim :])[:] = values
    return path


def test_a_netcdf_of_masks_by_a_mapping(tmp_path, converted):
    path = netcdf(tmp_path / "a.nc", prediction=100 * masks(), load=np.full((20, 30), 0.7))
    mapping = tmp_path / "map.toml"
    mapping.write_text(
        '[fields]\nburned_fraction = { variable = "prediction", scale = 0.01 }\nsurface_fuel = "load"\n'
    )
    run = converted([path, mapping])
    check(run)
    np.testing.assert_allclose(run.surface_fuel, 0.7, rtol=1e-6)
