"""Station import: accepted, merged, rejected and never stored values."""

import json
import sqlite3
from dataclasses import replace

import pytest
from firetwin.errors import InputError
from firetwin.stations import import_rows, importers, merging, names, reading, writing
from firetwin.stations.importers import firetwin, hifld, osm, resources_csv, stations_csv, usgs
from firetwin.stations.records import Source, Station
from firetwin.stations.station_file import StationFile
from random_stations import random_stations
from station_files import (
    HIFLD_ROWS,
    OVERPASS,
    STATION,
    USGS_ROWS,
    point,
    usgs_row,
    write_geojson,
    write_hifld,
    write_usgs,
)

NOBODY = merging.SourceOptions()


def merged(*paths, about=NOBODY):
    return merging.merge([(path, importers.read(path)) for path in paths], about)


def texts(station_file):
    """Every text that a file of these places holds."""
    rows = (*station_file.stations, *station_file.resources, *station_file.sources)
    return json.dumps([str(getattr(row, name)) for row in rows for name in row.__slots__])


def test_hifld_is_made_readable_merged_and_refused_by_reason(tmp_path):
    path = write_hifld(tmp_path / "Fire_Stations.csv")
    station_file, messages = merged(path)
    assert [(each.name, each.source_id) for each in station_file.stations] == [
        ("Made Up Valley Fire Department Station 1", "10700001"),
        ("Made Up Valley Fire Department Station 2", "3"),
        ("Invented Ridge Lookout", "4"),
    ]
    assert station_file.stations[0].address == "1 Example Street, Nowhere, CA"
    assert {each.origin for each in station_file.stations} == {"fact"}
    (source,) = station_file.sources
    assert (source.name, source.licence) == (hifld.NAME, hifld.LICENCE)
    assert source.retrieved == "2010-03-22"
    assert len(source.sha256) == 64
    told = "\n".join(messages)
    assert "1 duplicate merged (within 150 m, similar name, same kind)" in told
    for line in (
        "2 rejected, the first in line 7: no coordinates",
        "1 rejected, the first in line 6: ambulance or medical service, not a fire station",
        "1 rejected, the first in line 9: coordinates are not in degrees (save them in WGS84, EPSG:4326)",
        "telephone numbers and persons are not stored (EMERGPHONE, EMERGTITLE, PHONELOC, TELEPHONE)",
    ):
        assert line in told


def test_no_telephone_and_no_person_is_stored(tmp_path):
    overpass = tmp_path / "osm.json"
    overpass.write_text(json.dumps(OVERPASS))
    station_file, _ = merged(write_hifld(tmp_path / "a.csv"), write_usgs(tmp_path / "u.gpkg"), overpass)
    writing.write(station_file, tmp_path / "stations.gpkg")
    stored = (tmp_path / "stations.gpkg").read_bytes().lower() + texts(station_file).lower().encode()
    for secret in (b"555", b"person", b"chief", b"example.org"):
        assert secret not in stored
    assert b"invented ridge lookout" in stored


def test_hifld_as_geojson_is_the_same(tmp_path):
    rows = []
    for row in HIFLD_ROWS:
        number = [float(row[axis]) if row[axis] and abs(float(row[axis])) < 180 else None for axis in "XY"]
        rows.append((point(*number), row))
    found, _ = merged(write_geojson(tmp_path / "a.geojson", rows[:4]))
    table, _ = merged(write_hifld(tmp_path / "b.csv", HIFLD_ROWS[:4]))
    plain = [replace(each, source=0) for each in found.stations]
    assert plain == [replace(each, source=0) for each in table.stations]


@pytest.mark.parametrize("form", ["gpkg", "geojson"])
def test_usgs_fire_stations_among_structures(tmp_path, form):
    path = tmp_path / f"structures.{form}"
    if form == "gpkg":
        write_usgs(path)
    else:
        write_geojson(path, [(point(x, y), row) for x, y, row in USGS_ROWS])
    station_file, messages = merged(path)
    (station,) = station_file.stations
    assert (station.name, station.latitude, station.longitude) == ("Made Up Fire Station 7", 38.8, -120.6)
    assert station.source_id == usgs_row()["PERMANENT_IDENTIFIER"]
    assert station_file.sources[0].retrieved == "2023-05-04"
    assert ": other structure (FCODE is not 74026)" in "\n".join(messages)
    assert ": no coordinates" in "\n".join(messages)
    assert importers.find_importer(path) is usgs


def test_overpass_nodes_and_centres_of_ways_and_relations(tmp_path):
    path = tmp_path / "overpass.json"
    path.write_text(json.dumps(OVERPASS))
    station_file, messages = merged(path)
    assert [(each.name, each.source_id) for each in station_file.stations] == [
        ("Made Up Station 5", "node/1"),
        ("Fire station 12", "way/2"),
        ("Made Up Compound", "relation/5"),
        ("Made Up Hall", "way/9"),
        ("Fire station node/8", "node/8"),
    ]
    hall = station_file.stations[3]
    assert (hall.latitude, hall.longitude) == pytest.approx((39.1, -120.3))
    way = station_file.stations[1]
    assert (way.latitude, way.longitude, way.agency, way.address) == (
        38.95, -120.65, "Made Up District", "12 Example Lane",
    )  # fmt: skip
    (source,) = station_file.sources
    assert (source.name, source.licence, source.retrieved) == (osm.NAME, "ODbL 1.0", "2026-10-01")
    told = "\n".join(messages)
    assert "1 rejected, the first in element 5: no coordinates" in told  # without `out center`
    assert ": ambulance or medical service" in told
    assert "(contact:email, phone)" in told


def test_geojson_of_openstreetmap_with_outlines(tmp_path):
    ring = [[-120.6, 38.9], [-120.5, 38.9], [-120.5, 39.0], [-120.6, 39.0], [-120.6, 38.9]]
    outline = {"type": "Polygon", "coordinates": [ring]}
    rows = [(outline, STATION | {"@id": "way/9"}), (point(-120.0, 38.0), {"@id": "node/1", "shop": "x"})]
    station_file, messages = merged(write_geojson(tmp_path / "export.geojson", rows))
    (station,) = station_file.stations
    assert (station.latitude, station.longitude) == pytest.approx((38.95, -120.55))
    assert station.source_id == "way/9"
    assert ": not tagged amenity=fire_station" in "\n".join(messages)


STATIONS = """name,lat,lon,kind,id,phone
My Camp,38.9,-120.6,camp,C1,555-0100
my camp,38.9004,-120.6004,camp,C2,
My Camp,38.9004,-120.6004,water point,C3,
,38.8,-120.6,camp,,
"""
RESOURCES = """station;type;name;count;load_kg;speed_km_h;mobilise_min;cost_hour;night;begins;ends;status
C1;engine/3;Engine A;2;;50;5;100;yes;2014-09-17T06:00-07:00;2014-09-17T18:00-07:00;available
C1;engine/3;Engine A;2;;50;5;100;yes;2014-09-17T18:00-07:00;2014-09-18T06:00-07:00;committed
C1;tender/1;Tender;1;8000;;;;;;;
C3;dozer/2;;1;;;;;;;;
Nowhere;engine/3;;1;;;;;;;;
"""


def test_tables_of_the_users_own(tmp_path):
    stations, resources = tmp_path / "stations.csv", tmp_path / "resources.csv"
    stations.write_text(STATIONS)
    resources.write_text(RESOURCES)
    station_file, messages = merged(
        resources, stations, about=merging.SourceOptions("me", "CC0", "2026-01-02", "here")
    )
    assert [(each.name, each.kind, each.origin) for each in station_file.stations] == [
        ("My Camp", "camp", "user"),
        ("My Camp", "water point", "user"),
    ]
    engine, tender, dozer = station_file.resources
    assert (engine.station, engine.count, engine.night, engine.mode) == (
        station_file.stations[0].id,
        2,
        True,
        "attack",
    )
    assert [each.status for each in station_file.availability] == ["available", "committed"]
    assert (tender.mode, tender.load_kg, tender.speed_km_h, tender.currency) == ("water", 8000.0, None, "USD")
    assert station_file.type_of["tender/1"].standard == "user"
    assert (dozer.name, dozer.station) == ("dozer/2", station_file.stations[1].id)
    assert {(each.name, each.licence, each.retrieved, each.url) for each in station_file.sources} == {
        ("me", "CC0", "2026-01-02", "here")
    }
    told = "\n".join(messages)
    assert "1 rejected, the first in line 6: unknown station" in told
    assert "1 rejected, the first in line 5: no name and no number" in told


def test_a_station_named_by_what_several_have_is_refused(tmp_path):
    stations, resources = tmp_path / "stations.csv", tmp_path / "resources.csv"
    stations.write_text("name,lat,lon\nCamp,38.9,-120.6\nCamp,39.9,-120.6\n")
    resources.write_text("station,type\nCamp,engine/3\n")
    station_file, messages = merged(stations, resources)
    assert station_file.resources == ()
    assert "several stations have this name (use the number)" in "\n".join(messages)


@pytest.mark.parametrize(
    ("row", "reason"),
    [
        ("C1,Engine Three,,,", 'has type "Engine Three"; write kind/type'),
        ("C1,engine/3,fast,,", 'has speed_km_h "fast"; enter a number above 0'),
        ("C1,engine/3,0,,", "enter a number above 0"),
        ("C1,engine/3,nan,,", "enter a number above 0"),
        ("C1,engine/3,,shopping,", 'has mode "shopping"; use one of attack'),
        ("C1,engine/3,,,2014-09-17T06:00", "write a time with its zone"),
    ],
)
def test_a_wrong_value_is_named_with_its_line(tmp_path, row, reason):
    path = tmp_path / "resources.csv"
    path.write_text(f"station,type,speed_km_h,mode,begins\nC1,engine/3,,,\n{row}\n")
    with pytest.raises(InputError) as caught:
        resources_csv.read(path)
    assert reason in str(caught.value)
    assert caught.value.line == 3


def test_a_file_of_places_is_taken_over_beside_others(tmp_path):
    imported = random_stations(2)
    writing.write(imported, tmp_path / "known.gpkg")
    stations = tmp_path / "stations.csv"
    stations.write_text("name,lat,lon\nCamp,10,20\n")
    assert importers.find_importer(tmp_path / "known.gpkg") is firetwin
    station_file, _ = merged(stations, tmp_path / "known.gpkg", tmp_path / "known.gpkg")
    assert len(station_file.stations) == 1 + 2 * len(imported.stations)
    assert len(station_file.resources) == 2 * len(imported.resources)
    assert len(station_file.availability) == 2 * len(imported.availability)
    at = {each.id: each for each in station_file.stations}
    names_of = [(each.name, at[each.station].name) for each in station_file.resources]
    own = {each.id: each.name for each in imported.stations}
    assert sorted(names_of) == sorted(2 * [(each.name, own[each.station]) for each in imported.resources])
    writing.write(station_file, tmp_path / "both.gpkg")
    assert len(reading.read(tmp_path / "both.gpkg").stations) == len(station_file.stations)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "has an unknown format"),
        (b"a,b\n1,2\n", "has no column for name and latitude and longitude: it has a, b"),
        (b"\x00\xff\xfe", "has an unknown format"),
        (b'{"elements": [{"tags": 3}', "not valid JSON"),
        (b'{"osm3s": {}, "elements": 3}', "is not a list"),
        (b'{"osm3s": {}, "elements": [3]}', "element 1 is not an object"),
        (b"name,lat,lon\nA\xff,1,2\n", "is not UTF-8 text"),
        (b"name,lat,lon,origin\nA,1,2,rumour\n", 'has origin "rumour"'),
        (b"SQLite format 3\0 and nothing else", "has an unknown format"),
    ],
)
def test_other_files_are_named(tmp_path, content, reason):
    path = tmp_path / "file"
    path.write_bytes(content)
    with pytest.raises(InputError, match="file") as caught:
        importers.read(path)
    assert reason in str(caught.value)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_may_end_as_on_any_system(tmp_path, end):
    path = tmp_path / "file.csv"
    path.write_bytes(end.join(["name,lat,lon", "A,1,2", "B,,"]).encode())
    batch = importers.read(path)
    assert [each.name for each in batch.stations] == ["A"]
    assert batch.rejected.first == {import_rows.MISSING: "line 3"}


def test_a_missing_file_and_a_folder(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        importers.read(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is not a file"):
        importers.read(tmp_path)


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("Nowhere Fire Station 1", "Nowhere FD Sta. 01", True),
        ("Nowhere Fire Station 1", "Nowhere Fire Station 2", False),
        ("Nowhere Fire Department", "Nowhere Volunteer Fire Department Station 3", True),
        ("Nowhere Fire Station", "Elsewhere Fire Station", False),
        ("Fire station 5", "Nowhere Station 5", True),
        ("Fire station", "Nowhere Station 5", False),
    ],
)
def test_names_that_mean_the_same(one, other, same):
    assert names.may_be_equal(one, other) is same
    assert names.may_be_equal(other, one) is same


def test_capitals_are_made_readable_and_others_are_left():
    assert names.make_readable("  McCLOUD  Station ") == "McCLOUD Station"
    assert names.make_readable("CITY OF MCARTHUR VFD #2 - O'BRIEN") == "City of McArthur VFD #2 - O'brien"


def test_duplicates_are_those_within_150_metres():
    def station(number, north, **more):
        return replace(Station(number, "Nowhere 1", 38.9 + north / 111_000.0, -120.6, "fact", 1), **more)

    def into(*stations):
        return merging.find_duplicates(stations)

    assert into(station(1, 0.0), station(2, 149.0)) == {2: 1}
    assert into(station(1, 0.0), station(2, 151.0)) == {}
    assert into(station(2, 149.0), station(1, 0.0)) == {1: 2}  # the first of the list stays
    assert into(station(1, 0.0), station(2, 10.0, kind="camp")) == {}
    assert into(station(1, 0.0), station(2, 10.0, origin="exercise")) == {}
    assert into(station(1, 0.0), station(2, 100.0), station(3, 200.0)) == {2: 1}


def test_numbers_of_telephones_are_taken_out_of_texts():
    for text in ("Call 530-555-0101", "Call (530) 555-0101 x12", "Call +1 530.555.0101"):
        assert import_rows.remove_telephones(text) == "Call"
    assert import_rows.remove_telephones("1234 Route 50, 95726-1234") == "1234 Route 50, 95726-1234"


def test_no_source_is_invented(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("name,lat,lon\nCamp,38.9,-120.6\n")
    station_file, _ = merged(path)
    assert (station_file.sources[0].name, station_file.sources[0].licence) == ("mine", merging.NO_LICENCE)
    assert isinstance(station_file, StationFile)
    assert isinstance(station_file.sources[0], Source)
    assert importers.find_importer(path) is stations_csv


def test_a_geopackage_of_something_else_is_no_file_of_places(tmp_path):
    path = tmp_path / "other.gpkg"
    base = sqlite3.connect(path)
    base.execute("CREATE TABLE station (name)")
    base.commit()
    base.close()
    with pytest.raises(InputError, match="has an unknown format"):
        importers.read(path)
    with pytest.raises(InputError, match="is not a station file"):
        reading.read(path)


@pytest.mark.parametrize("length", [10_000, 10_001])
def test_texts_of_stations_are_limited(tmp_path, length):
    path = tmp_path / "mine.csv"
    path.write_text(f"name,lat,lon\n{'A' * length},38.9,-120.6\n")
    if length == 10_000:
        assert len(importers.read(path).stations[0].name) == length
    else:
        with pytest.raises(
            InputError, match=r"mine\.csv: the name of station 1 has 10,001 characters; at most"
        ):
            importers.read(path)
