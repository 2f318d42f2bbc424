"""GIS export: GDAL, shapely and rasterio read it, and positions agree in Earth-centred metres."""

import contextlib
import json
import shutil
import sqlite3
import subprocess
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import rasterio
import shapely
from firetwin import cli, extras
from firetwin.export import gis, gis_rasters
from firetwin.export.gis_rasters import Raster
from firetwin.export.request import ExportRequest
from firetwin.imaging import map_symbols
from firetwin.run import observations
from firetwin.shot.source import ShotSource
from pyproj import Transformer
from small_run import RUN_TOML

HOSTILE = """A "quoted" <name> & 'more'; DROP TABLE fronts; 🔥"""
SCENE = """\
run = "run"
[time]
start = 2014-09-17T04:45:30Z
end = 2014-09-17T04:47:00Z
frames = 4
[terrain]
near_radius = 0.0
[tiles]
geoid = -24.9
[labels]
enabled = true
file = "places.csv"
[stations]
enabled = true
routes_file = "plan.geojson"
[[cameras]]
name = "drone"
keys = [
  { at = 0.0, latitude = 38.905, longitude = -120.59, height = 400, target = "fire" },
  { at = 1.0, latitude = 38.9, longitude = -120.6, height = 300, target = "fire" },
]
"""
PLAN = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"kind": kind, "FeatureCategory": category, "division": "A", "held": True},
            "geometry": {"type": shape, "coordinates": coordinates},
        }
        for kind, category, shape, coordinates in (
            ("control_line", "Planned Line", "LineString", [[-120.6, 38.9], [-120.59, 38.91]]),
            ("division_break", "Division Break", "Point", [-120.6, 38.9]),
            ("other", "", "Point", [-120.6, 38.9]),
        )
    ],
}
TO_ECEF = Transformer.from_crs(4979, 4978)


@pytest.fixture
def request_(make_run, tmp_path):
    rows, columns = np.ogrid[:8, :10]
    arrival = (30.0 * np.hypot(rows - 3.6, columns - 4.3)).astype(np.float32)
    make_run(toml=RUN_TOML.replace("Small", "Small <&>"), fuel_arrival_time=arrival)
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "plan.geojson").write_text(json.dumps(PLAN))
    (tmp_path / "places.csv").write_text(
        'name,latitude,longitude\n"{}",38.903,-120.592\n'.format(HOSTILE.replace('"', '""'))
    )
    folder = tmp_path / "made"
    folder.mkdir()
    return ExportRequest(ShotSource(scene=str(tmp_path / "scene.toml")), "gis", folder)


@pytest.fixture
def exported(request_):
    gis.write(request_)
    return request_.folder


def rows(folder, sql):
    with contextlib.closing(sqlite3.connect(folder / gis.GEOPACKAGE)) as base:
        return base.execute(sql).fetchall()


def shape(blob):
    """Decode well-known binary after the header and an envelope of x and y."""
    assert blob[:3] == b"GP\x00"
    return shapely.from_wkb(blob[8 + 32 :])


def test_a_camera_is_where_the_scene_has_it_in_earth_centred_metres(exported, request_):
    (line, begin, end), *more = rows(exported, "SELECT geom, begin_time, end_time FROM camera_paths")
    assert not more
    points = shapely.get_coordinates(shape(line), include_z=True, include_m=True)
    expected = request_.georeference.ecef(request_.shot.paths[0].position)
    x, y, z = TO_ECEF.transform(points[:, 1], points[:, 0], points[:, 2])
    np.testing.assert_allclose(np.column_stack([x, y, z]), expected, atol=0.01)
    np.testing.assert_allclose(np.diff(points[:, 3]), 30.0)
    assert points[0, 3] == request_.shot.utc(1).timestamp()
    assert (begin, end) == ("2014-09-17T04:45:30.000Z", "2014-09-17T04:47:00.000Z")
    frames, blobs = zip(*rows(exported, "SELECT frame, geom FROM camera_frames"), strict=True)
    assert frames == (1, 2, 3, 4)
    single = shapely.get_coordinates([shape(each) for each in blobs], include_z=True)
    np.testing.assert_array_equal(single, points[:, :3])


def test_burned_areas_are_the_areas_within_the_fronts(exported, request_):
    areas = rows(exported, "SELECT a.geom, f.geom, a.area_ha FROM burned_area a JOIN fronts f USING (fid)")
    assert len(areas) >= 3
    for area, line, _ in areas:
        polygons = shape(area)
        assert polygons.is_valid
        assert polygons.boundary.equals(shapely.normalize(shape(line)))
    assert shape(areas[-1][0]).area * 111_000.0 * 86_700.0 / 1e4 == pytest.approx(areas[-1][2], rel=0.2)
    times = rows(exported, "SELECT begin_time, end_time FROM fronts ORDER BY begin_time")
    assert [end for _, end in times] == [*(begin for begin, _ in times[1:]), None]


def test_names_and_divisions_are_values(exported):
    assert (HOSTILE,) in rows(exported, "SELECT name FROM places")
    assert rows(exported, "SELECT kind, category, division, held FROM divisions") == [
        ("control_line", "Planned Line", "A", 1)
    ]
    assert rows(exported, "SELECT category FROM division_breaks") == [("Division Break",)]


def test_our_own_reader_finds_the_fronts(exported):
    read = observations.features(exported / gis.GEOPACKAGE)
    assert any(each.polygons for each in read)


def test_the_maps_have_the_values_of_the_run_where_it_has_them(exported, request_):
    run = request_.shot.run
    for name, values in {"arrival": run.fuel_arrival_time(), "fuel": run.surface_fuel}.items():
        with rasterio.open(exported / "maps" / f"{name}.tif") as raster:
            assert raster.crs.to_epsg() == 4326
            assert raster.tags(ns="IMAGE_STRUCTURE")["LAYOUT"] == "COG"
            longitude, latitude = np.meshgrid(run.fuel_longitude, run.fuel_latitude)
            found = np.array([*raster.sample(np.column_stack([longitude.ravel(), latitude.ravel()]))])
            np.testing.assert_array_equal(found[:, 0], np.asarray(values, np.float32).ravel())
    with rasterio.open(exported / "maps" / "burned.tif") as raster:
        first, last = raster.read(1), raster.read(raster.count)
        assert raster.descriptions[0] == "2014-09-17T04:45:00Z"
    assert last.sum() == (np.asarray(run.fuel_arrival_time()) <= 120.0).sum() > first.sum()


def test_an_axis_of_uneven_steps_is_sampled_at_the_nearest_cell(tmp_path, request_):
    latitude, longitude = np.array([40.3, 40.1, 40.05, 40.0]), np.array([1.0, 1.1, 1.2])
    values = np.arange(12, dtype=np.float32).reshape(4, 3)
    raster = Raster("x", "X", {"x": values}, latitude, longitude, "m")
    (path,) = gis_rasters.write([raster], tmp_path, request_.shot.run)
    with rasterio.open(path) as found:
        assert found.bounds.top == pytest.approx(40.4)
        for k in range(4):
            assert next(found.sample([(1.1, latitude[k])]))[0] in values[max(k - 1, 0) : k + 2, 1]


def test_the_smoke_column_is_the_integral_over_height():
    class Air:
        times = np.array([0.0, 60.0])
        has = staticmethod(lambda name: True)
        smoke_3d_at = staticmethod(lambda time: np.full((3, 2, 2), 0.002 * time, np.float32))
        height_3d_at = staticmethod(
            lambda time: np.array([0.0, 100.0, 500.0], np.float32)[:, None, None] * np.ones((3, 2, 2))
        )

    np.testing.assert_allclose(gis_rasters._smoke_column(Air, 30.0), 0.06 * 500.0)


def test_the_project_names_existing_layers_once(exported):
    root = ET.parse(exported / gis.PROJECT).getroot()
    assert root.findtext("title") == "Small <&>"
    layers = root.findall("projectlayers/maplayer")
    keys = [layer.findtext("id") for layer in layers]
    assert len(set(keys)) == len(keys) >= 9
    assert min(map(len, keys)) >= 10  # QGIS renames shorter ones
    tables = {name for (name,) in rows(exported, "SELECT table_name FROM gpkg_geometry_columns")}
    for layer in layers:
        file, _, table = layer.findtext("datasource").partition("|layername=")
        assert (exported / file).is_file()
        assert not table or table in tables
    assert root.find("ProjectTimeSettings/TemporalRange/start").text == "2014-09-17T04:45:30Z"


def test_styles_are_in_files_and_in_the_geopackage_with_the_colours_of_the_standard(exported):
    for name, text in rows(exported, "SELECT f_table_name, styleQML FROM layer_styles"):
        assert (exported / "styles" / f"{name}.qml").read_text() == text
    fronts = ET.parse(exported / "styles" / "fronts.qml").getroot()
    red = ",".join(str(int(map_symbols.FIRE_EDGE[i : i + 2], 16)) for i in (1, 3, 5))
    colours = [each.get("value") for each in fronts.iter("Option") if each.get("name") == "line_color"]
    assert colours[-1] == f"{red},255"
    assert fronts.find("temporal").get("startField") == "begin_time"


@pytest.mark.skipif(not shutil.which("ogrinfo"), reason="needs ogrinfo of GDAL")
def test_gdal_reads_the_dates_and_dimensions(exported):
    ended = subprocess.run(
        ["ogrinfo", "-so", "-al", exported / gis.GEOPACKAGE], capture_output=True, text=True
    )
    assert ended.returncode == 0
    assert "ERROR" not in ended.stderr + ended.stdout
    assert "begin_time: DateTime" in ended.stdout
    assert "Geometry: 3D Measured Line String" in ended.stdout


def test_without_rasterio_the_command_names_it(request_, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "rasterio", None)
    out = tmp_path / "out"
    assert cli.main(["export", str(tmp_path / "scene.toml"), "--to", "gis", "--out", str(out)]) == 1
    assert f"install it with: {extras.install('raster')}" in capsys.readouterr().err
    assert not out.exists()
