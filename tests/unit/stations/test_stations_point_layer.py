"""Station files in the layouts of a federal service, a county and QGIS; all stations are invented."""

import csv
import json
import os
import sqlite3
import struct

import numpy as np
import pytest
from firetwin import cli
from firetwin.errors import InputError
from firetwin.run.observations import projection
from firetwin.stations import importers, reading
from firetwin.stations.import_options import ImportOptions
from firetwin.stations.importers import days, point_layer
from pyproj import Transformer

ROWS = [
    ("Exercise Station Alpha", "Day Station", "Seasonal", -120.55, 38.85),
    ("Exercise Station Bravo", "Lookout", "Volunteer", -120.65, 38.95),
    ("Exercise Station Charlie", "Fire Station", "Career", -120.75, 39.05),
]


def projected(system):
    """Rows with x and y in a reference system."""
    there = Transformer.from_crs("EPSG:4326", system, always_xy=True)
    return [(*row[:3], *there.transform(*row[3:])) for row in ROWS]


def table(path, columns, rows):
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        csv.writer(file).writerows([columns, *rows])
    return path


def federal(path, rows=None, system="EPSG:3857"):
    """A federal CSV: x and y in Web Mercator, telephones, and the date of each edit in ms."""
    columns = ["X", "Y", "OBJECTID", "Station_Name", "Type", "Staffing", "Phone", "EditDate"]
    rows = projected(system) if rows is None else rows
    return table(path, columns, [(x, y, k, name, kind, staff, "530-555-0100", 1_683_158_400_000)
                                 for k, (name, kind, staff, x, y) in enumerate(rows, 1)])  # fmt: skip


def county(path, system="EPSG:4326"):
    """A county's CSV: three columns."""
    return table(path, ["X", "Y", "Station_Name"], [(x, y, name) for name, _, _, x, y in projected(system)])


def qgis_geojson(path, system="EPSG:3857"):
    """A layer that QGIS saved as GeoJSON in its own reference system, which it names."""
    features = [
        {"type": "Feature", "properties": {"fid": k, "StationName": name, "Type": kind, "staffing": staff},
         "geometry": {"type": "Point", "coordinates": [x, y]}}
        for k, (name, kind, staff, x, y) in enumerate(projected(system), 1)
    ]  # fmt: skip
    crs = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{system.replace(':', '::')}"}}
    whole = {"type": "FeatureCollection", "name": "exercise_stations", "crs": crs, "features": features}
    path.write_text(json.dumps(whole))
    return path


def qgis_geopackage(path, system=26910, number=26910):
    """A layer that QGIS saved as GeoPackage, with its table of styles; the last change is in the file."""
    with sqlite3.connect(path) as base:
        base.executescript(
            f"""CREATE TABLE gpkg_spatial_ref_sys (srs_name, srs_id INTEGER, organization,
organization_coordsys_id INTEGER, definition, description);
INSERT INTO gpkg_spatial_ref_sys VALUES ('', 26910, 'EPSG', 26910, 'PROJCS', '');
INSERT INTO gpkg_spatial_ref_sys VALUES ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', '');
CREATE TABLE gpkg_contents (table_name, data_type, identifier, description, last_change, srs_id);
INSERT INTO gpkg_contents VALUES ('stations', 'features', '', '', '2026-03-04T05:06:07.000Z', {number});
INSERT INTO gpkg_contents VALUES ('layer_styles', 'attributes', '', '', '2026-09-09T05:06:07.000Z', 0);
CREATE TABLE layer_styles (id INTEGER PRIMARY KEY, styleQML TEXT);
CREATE TABLE gpkg_geometry_columns (table_name, column_name, geometry_type_name, srs_id, z, m);
INSERT INTO gpkg_geometry_columns VALUES ('stations', 'geom', 'POINT', {number}, 0, 0);
CREATE TABLE stations (fid INTEGER PRIMARY KEY, geom BLOB, Station_Name TEXT, Type TEXT, Staffing TEXT)"""
        )
        for name, kind, staff, x, y in projected(f"EPSG:{system}"):
            blob = b"GP\0\1" + struct.pack("<i", number) + struct.pack("<BIdd", 1, 1, x, y)
            base.execute("INSERT INTO stations VALUES (NULL, ?, ?, ?, ?)", (blob, name, kind, staff))
    base.close()
    return path


def check(batch, full=True):
    """Compare stations with the invented ones, within 1 m."""
    assert [each.name for each in batch.stations] == [row[0] for row in ROWS]
    for each, (_, kind, staff, longitude, latitude) in zip(batch.stations, ROWS, strict=True):
        assert each.latitude == pytest.approx(latitude, abs=2e-5)  # NAD83 is within 2 m
        assert each.longitude == pytest.approx(longitude, abs=2e-5)
        assert (each.kind, each.staffing) == ((kind, staff) if full else ("fire station", ""))


def test_a_federal_table_in_web_mercator(tmp_path):
    batch = importers.read(federal(tmp_path / "a.csv"))
    check(batch)
    assert batch.retrieved == "2023-05-04"
    assert batch.dropped == ["Phone"]
    assert any("Web Mercator (EPSG:3857) for their size" in each for each in batch.notes)
    assert any("name from Station_Name" in each for each in batch.notes)


def test_a_countys_three_columns(tmp_path):
    check(importers.read(county(tmp_path / "a.csv")), full=False)
    path = county(tmp_path / "b.csv", "EPSG:26910")
    with pytest.raises(InputError, match=r"has coordinates such as .* not degrees; name .* --crs EPSG:26910"):
        importers.read(path)
    check(importers.read(path, ImportOptions(crs="EPSG:26910")), full=False)
    check(
        importers.read(county(tmp_path / "c.csv"), ImportOptions(crs="EPSG:26910")), full=False
    )  # in degrees


def test_a_layer_of_qgis_as_geojson(tmp_path):
    for system in ("EPSG:3857", "EPSG:4326", "EPSG:32610"):
        check(importers.read(qgis_geojson(tmp_path / "a.geojson", system)))
    path = tmp_path / "a.geojson"
    whole = json.loads(path.read_text())
    del whole["crs"]
    path.write_text(json.dumps(whole))
    with pytest.raises(InputError, match="or name the system, such as --crs EPSG:26910"):
        importers.read(path)
    check(importers.read(path, ImportOptions(crs="EPSG:32610")))


def test_a_layer_of_qgis_as_geopackage(tmp_path):
    path = qgis_geopackage(tmp_path / "a.gpkg")
    batch = importers.read(path)
    check(batch)
    assert batch.retrieved == "2026-03-04"
    assert importers.find_importer(path) is point_layer
    path = qgis_geopackage(tmp_path / "b.gpkg", number=-1)
    with pytest.raises(InputError, match="has no reference system"):
        importers.read(path)
    check(importers.read(path, ImportOptions(crs="EPSG:26910")))


def test_columns_are_given_or_named_as_missing(tmp_path):
    path = table(
        tmp_path / "a.csv",
        ["Across (m)", "Lat_Y", "What", "Chief_Name"],
        [(-120.5, 38.9, "Camp Exercise", "P")],
    )
    with pytest.raises(
        InputError, match=r"no column for name and latitude and longitude: it has Across \(m\), Lat_Y"
    ):
        importers.read(path)
    given = ImportOptions({"name": "what", "latitude": "Lat_Y", "longitude": "Across (m)"})
    (found,) = importers.read(path, given).stations
    assert (found.name, found.latitude, found.longitude) == ("Camp Exercise", 38.9, -120.5)
    for column, reason in (("Nothing", "does not exist; the columns are Across"), ("Chief_Name", "persons")):
        with pytest.raises(InputError, match=reason):
            importers.read(path, ImportOptions({"name": column}))


def firetwin(capsys, *words):
    status = cli.main([str(word) for word in words])
    return status, capsys.readouterr().err


def test_a_file_that_gives_nothing_fails_unless_it_may_be_skipped(tmp_path, capsys):
    good, out = county(tmp_path / "good.csv"), tmp_path / "out.gpkg"
    empty = table(tmp_path / "empty.csv", ["X", "Y", "Station_Name"], [("", "", "Exercise Nowhere")])
    other = tmp_path / "notes.txt"
    other.write_text("notes")
    for bad, reason in (
        (empty, "gave no station: 1 rejected, the first in line 2: no coordinates"),
        (other, "unknown"),
    ):
        command = ("stations", "import", good, bad, "--out", out)
        status, said = firetwin(capsys, *command)
        assert (status, out.exists()) == (1, False)
        assert reason in said
        assert firetwin(capsys, *command, "--skip-bad")[0] == 0
        out.unlink()


def test_type_staffing_and_date_are_stored(tmp_path, capsys):
    path, out = qgis_geojson(tmp_path / "a.geojson"), tmp_path / "out.gpkg"
    os.utime(path, (1.7e9, 1.7e9))
    assert firetwin(capsys, "stations", "import", path, "--out", out)[0] == 0
    station_file = reading.read(out)
    assert [(each.kind, each.staffing) for each in station_file.stations] == [row[1:3] for row in ROWS]
    assert station_file.sources[0].retrieved == "2023-11-14"  # the file's own date
    base = sqlite3.connect(out)
    base.execute("ALTER TABLE station DROP COLUMN staffing")  # as files of older versions
    base.commit()
    base.close()
    assert [each.staffing for each in reading.read(out).stations] == ["", "", ""]


def test_web_mercator_and_utm_are_those_of_proj(tmp_path):
    rng = np.random.default_rng(0)
    for code, zone, low, high in (
        ("EPSG:26910", 10, 0, 84),
        ("EPSG:32733", 33, -80, 0),
        ("EPSG:3857", 10, -85, 85),
    ):
        longitude, latitude = 6 * zone - 183 + rng.uniform(-3.5, 3.5, 100), rng.uniform(low, high, 100)
        base = "EPSG:4269" if code == "EPSG:26910" else "EPSG:4326"
        x, y = Transformer.from_crs(base, code, always_xy=True).transform(longitude, latitude)
        found = projection.to_degrees(tmp_path, code, np.column_stack([x, y]))
        np.testing.assert_allclose(found, np.column_stack([longitude, latitude]), rtol=0, atol=2e-8)
    assert projection.normalise("urn:ogc:def:crs:OGC:1.3:CRS84") == "OGC:CRS84"
    assert projection.normalise("ESRI:102100") == "EPSG:102100"


@pytest.mark.parametrize(
    ("value", "day"),
    [
        ("2023/05/04 12:00:00+00", "2023-05-04"), ("5/4/2023 10:00", "2023-05-04"),
        (1_683_158_400_000, "2023-05-04"), ("1683158400000", "2023-05-04"),
        ("2023-05-04T00:00:00Z", "2023-05-04"), ("soon", ""), (None, ""),
    ],
)  # fmt: skip
def test_days_as_files_write_them(value, day):
    assert days.parse_day(value) == day
