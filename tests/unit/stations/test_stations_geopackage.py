"""Station file: round trip, valid GeoPackage, and messages on edits of other programs."""

import sqlite3
import struct
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from firetwin import geopackage as firetwin_geopackage
from firetwin.errors import InputError
from firetwin.run.observations import geopackage
from firetwin.stations import reading, schema, writing
from firetwin.stations.records import Area
from random_stations import random_stations

SQUARE = np.array([[-121.0, 38.5], [-120.0, 38.5], [-120.0, 39.5], [-121.0, 39.5]])
HOLE = np.array([[-120.7, 38.8], [-120.5, 38.8], [-120.5, 39.0]])


def with_area(station_file):
    station = station_file.stations[0].id
    return replace(station_file, areas=(Area(1, "My area", "district", station, ((SQUARE, HOLE), (HOLE,))),))


@pytest.fixture
def file(tmp_path):
    station_file = with_area(random_stations(1))
    path = tmp_path / "stations.gpkg"
    writing.write(station_file, path)
    return path, station_file


def test_what_is_written_is_read(file):
    path, station_file = file
    result = reading.read(path)
    assert result.stations == station_file.stations
    assert result.resources == tuple(sorted(station_file.resources, key=lambda each: each.id))
    assert all(type(each.night) is bool for each in result.resources)
    assert (result.availability, result.sources, result.types) == (
        station_file.availability,
        station_file.sources,
        station_file.types,
    )
    (area,), (own,) = result.areas, station_file.areas
    assert (area.name, area.kind, area.station) == (own.name, own.kind, own.station)
    for rings, wanted in zip(area.polygons, own.polygons, strict=True):
        for ring, corners in zip(rings, wanted, strict=True):
            assert (ring == corners).all()


def query(path, command, *values):
    with closing(sqlite3.connect(path)) as base:
        return base.execute(command, values).fetchall()


def edit(path, *commands):
    """Change a file as a program does that knows neither triggers nor constraints: (SQL, values)."""
    with closing(sqlite3.connect(path)) as base:
        for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            base.execute(f"DROP TRIGGER {name}")
        base.execute("PRAGMA ignore_check_constraints = ON")
        for command, values in commands:
            base.execute(command, values)
        base.commit()


def test_it_is_a_geopackage_by_the_standard(file):
    path, station_file = file
    assert query(path, "PRAGMA application_id") == [(int.from_bytes(b"GPKG", "big"),)]
    assert query(path, "PRAGMA user_version") == [(10400,)]
    assert query(path, "PRAGMA integrity_check") == [("ok",)]
    assert query(path, "PRAGMA foreign_key_check") == []
    assert {row[0] for row in query(path, "SELECT srs_id FROM gpkg_spatial_ref_sys")} == {4326, -1, 0}
    contents = dict(query(path, "SELECT table_name, data_type FROM gpkg_contents"))
    assert contents == dict.fromkeys(schema.FEATURES, "features") | dict.fromkeys(
        schema.ATTRIBUTES, "attributes"
    )
    for table in contents:  # each has one column as an integer primary key
        keys = [row for row in query(path, "SELECT type, pk FROM pragma_table_info(?)", table) if row[1]]
        assert keys == [("INTEGER", 1)]
    columns = query(
        path, "SELECT table_name, column_name, geometry_type_name, srs_id, z, m FROM gpkg_geometry_columns"
    )
    assert columns == [("station", "geom", "POINT", 4326, 0, 0), ("area", "geom", "MULTIPOLYGON", 4326, 0, 0)]
    west, south, east, north = query(
        path, "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'station'"
    )[0]
    latitude, longitude = station_file.positions
    assert (west, south, east, north) == (longitude.min(), latitude.min(), longitude.max(), latitude.max())


def test_blobs_are_as_the_standard_lays_them_out(file):
    path, station_file = file
    station = station_file.stations[0]
    ((blob,),) = query(path, "SELECT geom FROM station WHERE fid = ?", station.id)
    assert blob == (
        b"GP\x00\x01"
        + struct.pack("<i", 4326)
        + b"\x01"
        + struct.pack("<Idd", 1, station.longitude, station.latitude)
    )
    ((blob,),) = query(path, "SELECT geom FROM area")
    assert blob[:4] == b"GP\x00\x03"
    assert struct.unpack_from("<4d", blob, 8) == (-121.0, -120.0, 38.5, 39.5)
    shapely = pytest.importorskip("shapely")
    shape = shapely.from_wkb(blob[40:])
    assert shape.geom_type == "MultiPolygon"
    assert shape.geoms[0].equals(shapely.Polygon(SQUARE, [HOLE]))


def test_its_own_reader_of_geopackages_reads_it(file):
    path, station_file = file
    features = [each for each in geopackage.read(path) if each.properties["layer"] == "station"]
    assert [each.properties["name"] for each in features] == [each.name for each in station_file.stations]
    assert features[0].points[0].tolist() == [
        station_file.stations[0].longitude,
        station_file.stations[0].latitude,
    ]


def test_the_index_of_stations_finds_them_and_follows_edits(file):
    path, station_file = file
    base = sqlite3.connect(path)
    for k, name in enumerate(("MinX", "MaxX", "MinY", "MaxY")):  # as GDAL and QGIS have them
        at = k // 2
        base.create_function(f"ST_{name}", 1, lambda blob, at=at: firetwin_geopackage.position(blob)[1 - at])
    base.create_function("ST_IsEmpty", 1, lambda blob: firetwin_geopackage.position(blob) is None)

    def indexed():
        return dict(base.execute(f"SELECT id, minx FROM {schema.INDEX}").fetchall())

    assert indexed() == {each.id: pytest.approx(each.longitude, rel=1e-6) for each in station_file.stations}
    number = station_file.stations[0].id
    base.execute("UPDATE station SET geom = ? WHERE fid = ?", (firetwin_geopackage.point(10.0, 20.0), number))
    assert indexed()[number] == 20.0
    base.execute("PRAGMA foreign_keys = OFF")
    base.execute("UPDATE station SET fid = 999 WHERE fid = ?", (number,))
    assert indexed()[999] == 20.0
    assert number not in indexed()
    base.execute("DELETE FROM station WHERE fid = 999")
    assert len(indexed()) == len(station_file.stations) - 1
    base.execute(
        "INSERT INTO station SELECT 5, ?, name, kind, agency, address, source, source_id, origin, picture, "
        "staffing FROM station LIMIT 1",
        (firetwin_geopackage.point(1.0, 2.0),),
    )
    assert indexed()[5] == 2.0
    base.close()


def test_a_row_without_a_true_origin_cannot_be_written(tmp_path):
    station_file = random_stations(1)
    rumour = replace(station_file.stations[0], origin="rumour")
    with pytest.raises(InputError, match="CHECK constraint failed: origin"):
        writing.write(
            replace(station_file, stations=(rumour, *station_file.stations[1:])), tmp_path / "a.gpkg"
        )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ("UPDATE station SET origin = 'rumour' WHERE fid = 7", 'station 7 has origin "rumour"'),
        ("UPDATE station SET source = 9 WHERE fid = 7", "station 7 has no source"),
        ("UPDATE station SET geom = x'00' WHERE fid = 7", "station 7 has no position in degrees"),
        ("UPDATE station SET geom = 'here' WHERE fid = 7", "station 7 has no position in degrees"),
        (
            "UPDATE resource SET station = 1 WHERE id = 100",
            "resource 100 names station 1, which does not exist",
        ),
        ("UPDATE resource SET type = 'x' WHERE id = 100", 'resource 100 has type "x"'),
        ("UPDATE resource SET mode = 'x' WHERE id = 100", 'resource 100 has mode "x"'),
        ("UPDATE resource SET load_kg = -1 WHERE id = 100", "resource 100 has load_kg -1"),
        ("UPDATE resource SET speed_km_h = 'fast' WHERE id = 100", "resource 100 has speed_km_h 'fast'"),
        ("UPDATE resource SET speed_km_h = 0 WHERE id = 100", "has speed_km_h 0"),
        ("UPDATE resource SET count = 0 WHERE id = 100", "has count 0"),
        ("UPDATE resource SET cost_hour = 1e308", "has cost_hour 1e+308; enter 0, or 0.000001 to"),
        ("UPDATE resource SET speed_km_h = 5e-324", "has speed_km_h 5e-324"),
        ("UPDATE type SET tank_l = 'full' WHERE code = 'engine/3'", "type engine/3 has tank_l 'full'; enter"),
        ("UPDATE availability SET begins = 'soon'", "has no time in begins"),
        ("UPDATE availability SET begins = '0001-01-01T00:00:00+14:00'", "has the year 1 in begins; enter"),
        ("UPDATE availability SET ends = '9999-12-31T23:59:59-14:00'", "has the year 9999 in ends; enter"),
        ("UPDATE availability SET status = 'lost'", 'has status "lost"'),
        (
            "UPDATE availability SET resource = 1",
            "resource 1 has a window of availability but does not exist",
        ),
        ("UPDATE area SET geom = x'00'", "area 1 has no polygon"),
        ("UPDATE area SET station = 1", "area 1 names station 1, which does not exist"),
        ("DROP TABLE availability", "is not a station file"),
        ("ALTER TABLE resource DROP COLUMN note", "has no stored column note"),
    ],
)
def test_what_another_program_broke_is_named(file, command, reason):
    path, _ = file
    edit(path, (command, ()))
    with pytest.raises(InputError) as caught:
        reading.read(path)
    assert reason in str(caught.value)
    assert str(path) in str(caught.value)


def test_geometries_in_one_another_are_refused_from_a_depth(file):
    path, _ = file
    nested = struct.pack("<BII", 1, 7, 1) * 50_000 + struct.pack("<BIdd", 1, 1, -120.5, 39.0)
    edit(path, ("UPDATE station SET geom = ?", (b"GP\0\1" + struct.pack("<i", 4326) + nested,)))
    with pytest.raises(InputError, match="has no position in degrees"):
        reading.read(path)


def test_points_as_other_programs_write_them_are_read(file):
    path, station_file = file
    number = station_file.stations[0].id
    big = b"GP\x00\x00" + struct.pack(">i", 4326) + b"\x00" + struct.pack(">Idd", 1, -120.25, 38.75)
    boxed = (
        b"GP\x00\x03"
        + struct.pack("<i4d", 4326, 1, 1, 2, 2)
        + b"\x01"
        + struct.pack("<Iddd", 1001, -120.5, 38.5, 9)
    )
    for blob, wanted in ((big, (38.75, -120.25)), (boxed, (38.5, -120.5))):
        edit(path, ("UPDATE station SET geom = ? WHERE fid = ?", (blob, number)))
        station = reading.read(path).stations[0]
        assert (station.latitude, station.longitude) == wanted


def test_texts_of_any_kind_are_texts(file):
    path, _ = file
    edit(
        path,
        ("UPDATE station SET name = 12, agency = x'41' WHERE fid = 7", ()),
        ("UPDATE resource SET note = x'41'", ()),
    )
    found = reading.read(path)
    assert found.stations[0].name == "12"
    assert {each.note for each in found.resources} == {"b'A'"}
    damaged = path.read_bytes().replace(b"Station 1", b"Station \xff")
    path.write_bytes(damaged)
    with pytest.raises(InputError, match="UTF-8"):
        reading.read(path)


def test_no_file_and_no_database(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        reading.read(tmp_path / "none.gpkg")
    (tmp_path / "text.gpkg").write_text("not a database, and long enough that SQLite looks at it" * 20)
    with pytest.raises(InputError, match="is not a station file"):
        reading.read(tmp_path / "text.gpkg")
