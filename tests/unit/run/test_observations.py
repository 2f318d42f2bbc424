"""Perimeters and detections from every kind of file, their dates, and messages on bad files."""

import io
import zipfile
from datetime import UTC, datetime, timedelta, timezone

import geopackage_file
import numpy as np
import pytest
from fires import circle, closed, geojson, square
from firetwin.errors import InputError, UsageError
from firetwin.run import observations
from firetwin.run.observations import dates
from firetwin.run.observations.feature import Feature

RING, HOLE = square(1000.0), square(200.0, 400.0, 400.0)
WHEN = datetime(2014, 9, 18, 11, tzinfo=UTC)


def kml(path, time="<TimeStamp><when>2014-09-18T04:00:00-07:00</when></TimeStamp>"):
    def text(ring):
        return " ".join(f"{x},{y},0" for x, y in ring)

    path.write_text(
        f"""<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Folder>{time}<Placemark>
<name>heat</name><MultiGeometry><Polygon><outerBoundaryIs><LinearRing><coordinates>{text(RING)}</coordinates>
</LinearRing></outerBoundaryIs><innerBoundaryIs><LinearRing><coordinates>{text(HOLE)}</coordinates></LinearRing>
</innerBoundaryIs></Polygon></MultiGeometry></Placemark></Folder></Document></kml>"""
    )
    return path


def kmz(path):
    inner = kml(path.with_suffix(".kml"))
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(inner, "doc.kml")
    return path


def shapefile(path, system="EPSG:32610"):
    import shapefile as pyshp
    from pyproj import CRS, Transformer

    there = Transformer.from_crs("EPSG:4326", system, always_xy=True)
    with pyshp.Writer(str(path)) as writer:
        writer.field("DATECURREN", "C", 30)
        writer.field("perdattime", "C", 30)
        rings = [closed(RING)[::-1], closed(HOLE)]
        writer.poly([[there.transform(*point) for point in ring] for ring in rings])
        writer.record("", "9/18/2014 11:00:00 AM")
    path.with_suffix(".prj").write_text(CRS(system).to_wkt("WKT1_ESRI"))
    return path


def geopackage(path):
    shape = geopackage_file.polygon(closed(RING), closed(HOLE))
    return geopackage_file.write(path, ["date_time"], king=[(shape, "2014-09-18T11:00:00Z")])


MAKERS = {
    "a.geojson": lambda path: geojson(path, ([RING, HOLE], {"poly_DateCurrent": 1411038000000})),
    "a.kml": kml,
    "a.kmz": kmz,
    "a.shp": shapefile,
    "a.gpkg": geopackage,
}


@pytest.mark.parametrize("name", MAKERS)
def test_one_square_with_a_hole_from_every_format(tmp_path, name):
    found = observations.read([MAKERS[name](tmp_path / name)])
    (perimeter,) = found.perimeters
    assert perimeter.time == WHEN
    ((outer, hole),) = perimeter.polygons
    for ring, expected in ((outer, RING), (hole, HOLE)):
        apart = np.abs(ring[:, None] - expected[None]).sum(-1)
        assert ring.shape == expected.shape
        assert apart.min(axis=1).max() < 1e-8


FIRMS = """latitude,longitude,bright_ti4,scan,track,acq_date,acq_time,satellite,instrument,confidence,type
38.9,-120.6,340.1,0.5,0.4,2014-09-17,930,N,VIIRS,n,0
38.91,-120.61,340.1,0.5,0.4,2014-09-17,0930,N,VIIRS,l,0
38.92,-120.62,340.1,0.5,0.4,2014-09-17,09:30,N,VIIRS,h,2
38.93,-120.63,340.1,,,2014-09-17,2105,Terra,MODIS,88,0
"""


def test_detections(tmp_path):
    path = tmp_path / "fire.csv"
    path.write_text(FIRMS)
    (found,) = observations.read([path]).detections
    assert found.time == tuple(datetime(2014, 9, 17, h, m, tzinfo=UTC) for h, m in ((9, 30), (21, 5)))
    np.testing.assert_array_equal(found.latitude, [38.9, 38.93])
    np.testing.assert_array_equal(found.size, [500.0, 1000.0])
    assert found.left_out == 2


@pytest.mark.parametrize(
    ("properties", "stem", "utc", "assumed"),
    [
        ({"valid_at": "2014-09-18T04:00:00-07:00"}, "a", True, False),
        ({"t": "2014-09-18T11:00:00"}, "a", True, True),
        ({"PerimeterDateTime": "2014/09/18 11:00:00+00"}, "a", True, False),
        ({"date": "2014-09-18", "time": "9/18/2014 11:00 AM"}, "a", True, True),
        ({"when": "20140918 1100"}, "a", True, True),
        ({"when": "09/18/2014 04:00 -07:00"}, "a", True, False),
        ({}, "ca_king_20140918_1100_dd83", True, True),
        ({}, "king_2014-09-18T0400-0700", True, True),
        ({"date": "2014-09-18"}, "a", False, False),
        ({"time": 20140918}, "a", False, False),
        ({"time": 1e20, "when": "0001-01-01T00:00:00+14:00"}, "a", False, False),
        ({"time": 10**400, "when": "01/01/0001 01:00:00 +1400"}, "00010101_0100+1400", False, False),
        ({}, "king", False, False),
    ],
)
def test_moments_in_the_ways_that_files_write_them(tmp_path, properties, stem, utc, assumed):
    path, assumptions = tmp_path / f"{stem}.geojson", {}
    feature = Feature((), properties, "feature 1")
    if utc:
        assert dates.parse(path, feature, assumptions) == WHEN
        assert bool(assumptions) == assumed
    else:
        with pytest.raises(InputError, match=r"feature 1: has no date.*@2014-09-18T04:00-07:00"):
            dates.parse(path, feature, assumptions)


def test_a_moment_with_the_name_counts_for_the_whole_file(tmp_path):
    path = geojson(tmp_path / "king.geojson", ([circle(500.0)], {}), ([circle(100.0, 900.0)], {"t": "1999"}))
    (found,) = observations.read([f"{path}@2014-09-18T04:00-07:00"]).perimeters
    assert found.time.astimezone(timezone(timedelta(hours=-7))).hour == 4
    assert len(found.polygons) == 2
    with pytest.raises(UsageError, match="noon"):
        observations.read([f"{path}@noon"])


BAD = {
    "none.geojson": (None, "no such file"),
    "a.txt": ("", "end in .csv"),
    "cut.geojson": ('{"type": "Feat', r"cut.geojson:1:10: not valid JSON"),
    "list.geojson": ("[]", 'no "type"'),
    "metres.geojson": (
        '{"type": "Polygon", "coordinates": [[[690000, 4300000], [691000, 4300000], [691000, 4301000]]]}',
        "not degrees.*4326",
    ),
    "words.geojson": ('{"type": "Polygon", "coordinates": [["a", "b", "c"]]}', "longitudes and latitudes"),
    "crs.geojson": (
        '{"type": "Point", "crs": {"properties": {"name": "EPSG:1"}}, "coordinates": [0, 0]}',
        "reference system that is none",
    ),
    "crs_none.geojson": ('{"type": "Point", "crs": {"properties": null}}', "no polygons"),
    "digits.geojson": (f'{{"type": {"1" * 5000}}}', "is damaged or incomplete: .*digits"),
    "large.geojson": (
        f'{{"type": "Polygon", "coordinates": [[[1{"0" * 400}, 1], [2, 2], [3, 1]]]}}',
        "longitudes and latitudes",
    ),
    "line.geojson": ('{"type": "LineString", "coordinates": [[0, 0], [1, 1]]}', "no polygons"),
    "cut.kml": ("<kml><Document>", "cut.kml:1:16: not valid XML"),
    "deep.kml": (
        f"<kml>{'<Folder>' * 3000}{'</Folder>' * 3000}</kml>",
        "nested too deeply",
    ),
    "bomb.kml": ('<!DOCTYPE a [<!ENTITY b "c">]><kml/>', "document type"),
    "wide.kml": ('<!DOCTYPE a [<!ENTITY b "c">]><kml/>', "document type"),
    "a.kmz": ("not a zip", "not a KMZ"),
    "a.gpkg": ("not a base at all, but long enough for a check by SQLite" * 9, "not a GeoPackage"),
    "a.csv": ("lat,lon\n1,2\n", "missing columns latitude"),
    "b.csv": (FIRMS + "38.9,-120.6,340.1,0.5,0.4,2014-13-17,930,N,VIIRS,n,0\n", "b.csv:6: acq_date"),
    "c.csv": (FIRMS + f"{'9' * 200000},", "is damaged or incomplete: field larger"),
    "a.shp": ("not a shapefile", r"no .prj"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_say_what_and_where_in_one_line(tmp_path, name):
    text, words = BAD[name]
    if text is not None:
        encoding = "utf-16" if name.startswith("wide") else "utf-8"
        (tmp_path / name).write_text(text, encoding=encoding)
    with pytest.raises(InputError, match=words) as error:
        observations.read([tmp_path / name])
    assert str(error.value).startswith(str(tmp_path / name))
    assert "\n" not in str(error.value)


@pytest.mark.filterwarnings("ignore")
def test_damaged_bytes_end_in_a_clear_error(tmp_path):
    """Binary formats with each byte inverted in turn, or cut: read or rejected, never another exception."""
    rng = np.random.default_rng(3)
    for maker, name in ((shapefile, "s.shp"), (geopackage, "g.gpkg"), (kmz, "k.kmz")):
        path = maker(tmp_path / name)
        whole = path.read_bytes()
        for at in rng.integers(0, len(whole), 12):
            path.write_bytes(whole[:at] + bytes([whole[at] ^ 0xFF]) + whole[at + 1 :])
            try:
                observations.read([path])
            except InputError as error:
                assert "\n" not in str(error)  # noqa: PT017
        path.write_bytes(whole[: len(whole) // 2])
        with pytest.raises(InputError):
            observations.read([path])


def test_what_lies_in_the_run_folder_is_found(tmp_path):
    assert observations.beside(tmp_path) == []
    folder = tmp_path / observations.FOLDER
    folder.mkdir()
    for name in ("b.geojson", "a.csv", "a.shp", "a.dbf", "a.prj", ".c.kml", "notes.txt"):
        (folder / name).write_text("")
    assert [path.name for path in observations.beside(tmp_path)] == ["a.csv", "a.shp", "b.geojson"]


def test_geojson_with_a_byte_order_mark(tmp_path):
    path = geojson(tmp_path / "a.geojson", ([RING], {"time": WHEN.isoformat()}))
    path.write_bytes(b"\xef\xbb\xbf" + io.BytesIO(path.read_bytes()).read())
    assert len(observations.read([path]).perimeters) == 1
