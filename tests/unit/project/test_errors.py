"""Readers of a user's files turn every exception into one line: file, fault and remedy."""

import errno
import importlib
import sqlite3
import zipfile

import numpy as np
import pytest
import small_run
from firetwin import errors, limits
from firetwin.errors import FullDiskError, InputError
from firetwin.jobs import convert
from firetwin.run import content, labels, observations, readers
from firetwin.run.models import netcdf, raster, write
from firetwin.run.readers import pyretechnics
from firetwin.shot.cameras import track
from firetwin.shot.sections.terrain import TerrainSettings
from firetwin.shot.settings import Settings, scene_file
from firetwin.shot.surface import globe_picture, orthophoto
from firetwin.shot.terrain import raster as geotiff
from firetwin.stations import importers, reading
from firetwin.tiles import explicit
from firetwin.tiles.loader import Loader
from firetwin.tiles.sources.folder import Folder
from firetwin_core import sensor
from small_stations import write as write_stations
from station_files import write_geojson
from tilesets import tile, tileset
from tilesets import write as write_tileset

PLANTED = {
    sqlite3.OperationalError("disk I/O error"): "cannot be read as a GeoPackage: disk I/O error; export it",
    sqlite3.DatabaseError("malformed"): "cannot be read as a GeoPackage: malformed; export it",
    ValueError("odd"): "is damaged or incomplete: odd; export it",
    OverflowError("date value out of range"): "is damaged or incomplete: date value out of range; export it",
    KeyError("k"): "is damaged or incomplete: 'k'; export it",
    AssertionError(): "is damaged or incomplete: AssertionError; export it",
    RecursionError("maximum recursion depth exceeded"): "nested too deeply; export it without nesting",
    MemoryError(): "does not fit into the memory; use a part",
    UnicodeDecodeError("utf-8", b"\xff", 0, 1, "invalid"): "is not UTF-8 text (byte 1); save it as UTF-8",
    PermissionError(errno.EACCES, "Permission denied"): "permission denied); change its permissions",
    OSError(errno.EROFS, "Read-only file system"): "cannot be read (read-only file system); copy it",
    OSError(errno.EIO, "Input/output error"): "cannot be read (input/output error); copy it",
    OSError(errno.ENOSPC, "No space left on device"): "the disk is full; free some space",
}


def _observed(name):
    return lambda path: observations.features(path.with_name(f"a{name}"))


def _convert(path):
    convert.in_process([path.with_name("a.npz")], path.with_name("out"), ["2020-07-01", "", "", 0])


def _read_netcdf(path):
    library = pytest.importorskip("netCDF4")
    if not (path := path.with_name("a.nc")).exists():
        with library.Dataset(path, "w") as file:
            file.createDimension("x", 1)
            file.createVariable("v", "f4", ("x",))
    netcdf.File(path).read("v")


def _settings(path, **terrain):
    return Settings(path=path, terrain=TerrainSettings(**terrain))


def _photo(path):
    orthophoto._file(_settings(path, photo=path.with_name("a.png")))


def _geotiff(path):
    pytest.importorskip("rasterio")
    geotiff.GeoTiff(_settings(path, photo=path.with_name("a.tif")), "photo")


def _globe(path):
    globe_picture.check(_settings(path, globe=path.with_name("a.png")))


READERS = {
    "GeoJSON": (_observed(".geojson"), observations.__name__ + ".geojson:read"),
    "KML": (_observed(".kml"), observations.__name__ + ".kml:read"),
    "GeoPackage": (_observed(".gpkg"), observations.__name__ + ".geopackage:read"),
    "shapefile": (_observed(".shp"), observations.__name__ + ".shapefile:read"),
    "detections": (_observed(".csv"), observations.__name__ + ".firms:read"),
    "station file": (reading.read, reading.__name__ + ":_Reader.station_file"),
    "import": (importers.read, importers.__name__ + ".firetwin:read"),
    "labels": (lambda path: labels.read(path.with_name("l.csv")), labels.__name__ + ":_csv"),
    "track": (lambda path: track.read(path.with_name("t.gpx")), track.__name__ + ":_validated"),
    "scene file": (lambda path: scene_file.read(path.with_name("s.toml")), scene_file.__name__ + ":parse"),
    "run folder": (lambda path: readers.open(path.parent), readers.__name__ + ":_check_years"),
    "model's folder": (lambda path: readers.gathered([path.parent]), "pathlib:Path.iterdir"),
    "model": (_convert, pyretechnics.__name__ + ":_grid"),
    "model's field": (_convert, write.__name__ + ":on_run_grid"),
    "NumPy archive": (lambda path: pyretechnics._arrays(path.with_name("a.npz")), "numpy:load"),
    "netCDF file": (_read_netcdf, netcdf.__name__ + ":_decoded"),
    "raster": (lambda path: raster.read(path.with_name("a.asc")), raster.__name__ + ":_read_ascii"),
    "landscape (LCP)": (lambda path: raster.landscape(path), raster.__name__ + ":_read_landscape"),
    "GeoTIFF": (_geotiff, "rasterio:open"),
    "orthophoto": (_photo, sensor.__name__ + ":read_image"),
    "world file": (_photo, "pathlib:Path.read_text"),
    "globe": (_globe, "pathlib:Path.open"),
    "hashed file": (lambda path: content.of_file(path, path.parent), content.__name__ + ":_read_all"),
    "tileset": (lambda path: Loader(Folder(path.parent)), explicit.__name__ + ":read"),
}


NAMED = ("NumPy archive", "netCDF file", "raster", "landscape (LCP)", "GeoTIFF")
"""Readers whose messages name the format."""


@pytest.fixture(scope="module")
def station_file(tmp_path_factory):
    """A station file, and one file for each of the other readers."""
    folder = tmp_path_factory.mktemp("files")
    write_geojson(folder / "a.geojson", [])
    for name in ("a.kml", "a.gpkg", "a.shp", "a.csv", "l.csv", "s.toml"):
        (folder / name).write_text("")
    (folder / "t.gpx").write_text('<gpx><trk><trkseg><trkpt lat="1" lon="2"/></trkseg></trk></gpx>')
    write_tileset(folder, {"tileset.json": tileset(tile())})
    np.savez(folder / "a.npz", time_of_arrival=np.mgrid[:9, :9][1] * 60.0, cell_width=30.0, cell_height=30.0)
    (folder / "a.asc").write_text("ncols 1")
    (folder / "a.tif").write_bytes(b"II*")
    sensor.write_image(folder / "a.png", np.zeros((2, 2, 3), np.float32))
    (folder / "a.pgw").write_text("1 0 0 1 0 0")
    (folder / "run.toml").write_text(small_run.RUN_TOML)
    for name, values in small_run.small_fields().items():
        small_run.write_field(folder, name, values, "npy")
    return write_stations(folder / "a_stations.gpkg", [(1, "A", 39.0, -120.5, "fire station", "user")])


@pytest.mark.parametrize("reader", READERS)
def test_what_a_reader_raises_becomes_one_line(reader, station_file, monkeypatch):
    read, target = READERS[reader]
    module, _, name = target.partition(":")
    owner, _, last = name.rpartition(".")
    holder = importlib.import_module(module)
    holder = getattr(holder, owner) if owner else holder
    for planted, text in PLANTED.items():
        if reader in NAMED:
            text = text.replace("is damaged or incomplete", f"cannot be read as a {reader}")

        def fail(*_args, error=planted, **_more):
            raise error

        with monkeypatch.context() as patch:
            patch.setattr(holder, last, fail)
            with pytest.raises(InputError) as caught:
                read(station_file)
        assert text in caught.value.reason
        assert caught.value.path.startswith(str(station_file.parent))
        assert "\n" not in str(caught.value)
        assert isinstance(caught.value, FullDiskError) == (getattr(planted, "errno", 0) == errno.ENOSPC)


@pytest.mark.parametrize("fault", [NameError, UnboundLocalError, ImportError, ModuleNotFoundError])
def test_faults_of_the_code_pass_a_reader(fault):
    with pytest.raises(fault), errors.reading("a.gpkg"):
        raise fault


def test_an_interruption_passes_a_reader():
    with pytest.raises(KeyboardInterrupt), errors.reading("a.gpkg"):
        raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("planted", "text"),
    [
        ("disk I/O error", "a.gpkg: the disk is full; free some space"),
        ("database or disk is full", "a.gpkg: the disk is full; free some space"),
        ("attempt to write a readonly database", "a.gpkg: cannot be written (attempt to write a readonly"),
        ("unable to open database file", "a.gpkg: cannot be written (unable to open database file); choose"),
    ],
)
def test_what_sqlite_raises_on_a_full_or_read_only_disk_becomes_one_line(planted, text, monkeypatch):
    monkeypatch.setattr(errors, "is_nearly_full", lambda _: True)
    with pytest.raises(InputError) as caught, errors.writing("a.gpkg"):
        raise sqlite3.OperationalError(planted)
    assert text in str(caught.value)


def test_a_short_text_of_many_values_is_refused_unread(tmp_path, monkeypatch):
    """Also within a KMZ."""
    monkeypatch.setattr(limits, "TEXT_VALUES", 100)
    texts = {"a.geojson": '{"type": "x"' + ",[1]" * 50 + "}", "a.kml": "<kml>" + "<a/>" * 100 + "</kml>"}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    with zipfile.ZipFile(tmp_path / "a.kmz", "w") as archive:
        archive.writestr("a.kml", texts["a.kml"])
    for name, values in {"a.geojson": 101, "a.kml": 102, "a.kmz": r"10\d"}.items():
        with pytest.raises(InputError, match=rf"{name}: has about {values} numbers, .*; at most 100 are"):
            observations.features(tmp_path / name)


@pytest.mark.parametrize("reader", ["GeoJSON", "KML", "detections", "labels", "track"])
def test_a_text_that_is_too_large_is_refused_unread(reader, station_file, monkeypatch):
    monkeypatch.setattr(limits, "TEXT_BYTES", -1)
    with pytest.raises(InputError, match="MB; at most -0 MB are read: take a part of it"):
        READERS[reader][0](station_file)
