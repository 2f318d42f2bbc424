"""Zarr stores as runs: formats, folders and archives, projections, damage, and the missing package."""

import json
import re
import sys

import numpy as np
import pytest
from firetwin import extras
from firetwin.errors import Error, InputError
from firetwin.run import readers
from firetwin.run.models import zarr_store
from firetwin.run.models.model import Options
from firetwin.run.readers import netcdf_cf

LATITUDE, LONGITUDE = 38.9 + 0.001 * np.arange(20), -120.6 + 0.001 * np.arange(30)
HOURS = np.arange(6)
MASKS = (np.arange(30) * 600.0 < 3600.0 * HOURS[:, None, None]).repeat(20, axis=1).astype(np.float32)


@pytest.fixture
def store(tmp_path):
    """Write a store of hourly masks."""
    zarr = pytest.importorskip("zarr")

    def write(name, version, consolidated=False, chunks=(4, 7, 9), **arrays):
        path = tmp_path / name
        kind = (
            zarr.storage.ZipStore(path, mode="w") if name.endswith(".zip") else zarr.storage.LocalStore(path)
        )
        group = zarr.create_group(kind, zarr_format=version)

        def add(name, values, chunks=None, **attributes):
            values = np.asarray(values)
            array = group.create_array(name, shape=values.shape, dtype=values.dtype, chunks=chunks or "auto")
            array[...] = values
            array.attrs.update(attributes)

        add("time", HOURS, units="hours since 2014-09-17 19:00:00")
        add("lat", LATITUDE, units="degrees_north")
        add("lon", LONGITUDE, units="degrees_east")
        add("burned_fraction", MASKS, chunks)
        for each, (values, attributes) in arrays.items():
            add(each, values, **attributes)
        if consolidated:
            zarr.consolidate_metadata(kind)
        kind.close()
        return path

    return write


def arrival(path, **options):
    model = netcdf_cf.read([path], Options(**options))
    return model, np.asarray(model.still["fuel_arrival_time"]())


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("name", ["a.zarr", "a.zarr.zip"])
@pytest.mark.parametrize("consolidated", [False, True])
def test_hourly_masks_of_both_formats(store, version, name, consolidated):
    path = store(name, version, consolidated)
    assert readers.gathered([path]) == [path]
    assert readers.reader([path]) is netcdf_cf
    model, found = arrival(path)
    assert model.start.isoformat() == "2014-09-17T19:00:00+00:00"
    middle = 3600.0 * (np.floor(np.arange(30) / 6.0) + 0.5)
    np.testing.assert_allclose(found, middle[None].repeat(20, 0), rtol=1e-6)


def test_arrival_times_with_a_projection_and_missing_values(store, tmp_path):
    pyproj = pytest.importorskip("pyproj")
    zarr = pytest.importorskip("zarr")
    path = tmp_path / "b.zarr"
    group = zarr.create_group(path, zarr_format=2)
    east, north = 700_000.0 + 30.0 * np.arange(5), 4_310_000.0 - 30.0 * np.arange(4)
    times = np.arange(20.0).reshape(4, 5)
    times[0, 0] = -9999.0
    wkt = pyproj.CRS(32610).to_wkt()
    for name, values, fill, attributes in (
        ("x", east, None, {"standard_name": "projection_x_coordinate"}),
        ("y", north, None, {"standard_name": "projection_y_coordinate"}),
        ("fuel_arrival_time", times, -9999.0, {"grid_mapping": "spatial_ref"}),
        ("spatial_ref", np.array(0), None, {"crs_wkt": wkt}),
    ):
        array = group.create_array(name, shape=values.shape, dtype=values.dtype, fill_value=fill)
        array[...] = values
        array.attrs.update(attributes)
    model, found = arrival(path, start=Options.of("2014-09-17T19:00:00Z", "", "", 0.0, []).start)
    assert np.isnan(found[0, 0])
    assert found[1, 2] == 7.0
    back = pyproj.Transformer.from_crs(32610, 4326, always_xy=True).transform(east[2], north[1])
    assert (model.grid.longitude[1, 2], model.grid.latitude[1, 2]) == pytest.approx(back, abs=1e-9)


def test_a_damaged_chunk_is_one_error(store):
    path = store("a.zarr", 3)
    for chunk in (path / "burned_fraction/c").rglob("*"):
        if chunk.is_file():
            chunk.write_bytes(chunk.read_bytes()[:9])
    with pytest.raises(InputError, match=r"a\.zarr: cannot be read as a zarr store: .*; export it again"):
        arrival(path)


def test_unknown_codecs_and_large_chunks_are_refused(store, monkeypatch):
    path = store("a.zarr", 2)
    about = path / "burned_fraction/.zarray"
    sound = json.loads(about.read_text())
    other = {"id": "astype", "encode_dtype": "<f4", "decode_dtype": "<f4"}
    about.write_text(json.dumps(sound | {"filters": [other]}))
    with pytest.raises(InputError, match="has the codec astype, which is not read"):
        arrival(path)
    for key, value in (("compressor", {"id": "pickle"}), ("filters", [{"id": "pickle"}])):
        about.write_text(json.dumps(sound | {key: value}))
        with pytest.raises(InputError):
            arrival(path)
    monkeypatch.setattr(zarr_store, "_CHUNK", 100)
    with pytest.raises(InputError, match="write chunks below"):
        arrival(store("c.zarr", 3))


def test_without_the_package_the_error_says_how_to_install_it(tmp_path, monkeypatch):
    (tmp_path / ".zgroup").write_text('{"zarr_format": 2}')
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(
        Error, match=re.escape(f"needs the Python package zarr; install it with: {extras.install('models')}")
    ):
        zarr_store.ZarrFile(tmp_path)
