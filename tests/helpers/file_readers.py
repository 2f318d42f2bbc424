"""Readers of a user's files: a call of each, the function in it that reads, and a folder with their files."""

import numpy as np
import pytest
import small_run
from firetwin.jobs import convert
from firetwin.run import bounds, content, labels, observations, readers
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
    return Settings(path=path.with_name("s.toml"), terrain=TerrainSettings(**terrain))


def _photo(path):
    orthophoto._file(_settings(path, photo=path.with_name("a.png")))


def _geotiff(path):
    pytest.importorskip("rasterio")
    geotiff.GeoTiff(_settings(path, photo=path.with_name("a.tif")), "photo")


def _globe(path):
    globe_picture.check(_settings(path, globe=path.with_name("a.png"), globe_credit="Somebody"))


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
    "run folder": (lambda path: readers.open(path.parent), bounds.__name__ + ":check_times"),
    "model's folder": (lambda path: readers.gathered([path.parent]), "pathlib:Path.iterdir"),
    "model": (_convert, pyretechnics.__name__ + ":_grid"),
    "model's field": (_convert, write.__name__ + ":on_run_grid"),
    "NumPy archive": (
        lambda path: pyretechnics._arrays(path.with_name("a.npz")),
        "numpy.lib.format:read_array",
    ),
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


def write_files(folder):
    """Write a station file, and one file for each of the other readers; returns the station file."""
    stations = write_stations(folder / "a_stations.gpkg", [(1, "A", 39.0, -120.5, "fire station", "user")])
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
    return stations
