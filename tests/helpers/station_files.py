"""Files of stations with the columns of real sources and rows that are made up."""

import json
import sqlite3

from firetwin import geopackage

HIFLD_COLUMNS = (
    *("X", "Y", "OBJECTID", "ID", "SECCLASS", "NAME", "TELEPHONE", "ADDRESS", "ADDRESS2", "CITY", "STATE"),
    *("ZIP", "ZIPP4", "COUNTY", "FIPS", "DIRECTIONS", "EMERGTITLE", "EMERGPHONE", "EMERGEXT", "CONTDATE"),
    *("CONTHOW", "GEODATE", "GEOHOW", "HSIPTHEMES", "NAICSCODE", "NAICSDESCR", "GEOLINKID", "X_1", "Y_1"),
    *("ST_VENDOR", "ST_VERSION", "GEOPREC", "PHONELOC", "QC_QA", "OWNER"),
)


def hifld_row(**values):
    """A row of HIFLD; other values are as HIFLD writes missing values."""
    row = dict.fromkeys(HIFLD_COLUMNS, "NOT AVAILABLE") | {
        "X": "-120.5", "Y": "38.9", "ID": "10700001", "TELEPHONE": "530-555-0101", "STATE": "CA",
        "EMERGTITLE": "CHIEF A. PERSON", "EMERGPHONE": "(530) 555-0102", "GEODATE": "2010/03/22",
        "GEOPREC": "BLOCKFACE", "NAICSCODE": "922160", "NAICSDESCR": "FIRE PROTECTION",
        "NAME": "MADE UP VALLEY FIRE DEPARTMENT STATION 1", "ADDRESS": "1 EXAMPLE STREET", "CITY": "NOWHERE",
    }  # fmt: skip
    return row | values


HIFLD_ROWS = [
    hifld_row(),
    hifld_row(ID="2", NAME="MADE UP VALLEY FD STATION 1", X="-120.5005", Y="38.9005", CITY="NOWHERE"),
    hifld_row(ID="3", NAME="MADE UP VALLEY FIRE DEPARTMENT STATION 2", X="-120.5001"),
    hifld_row(ID="4", NAME="INVENTED RIDGE LOOKOUT", X="-120.7", Y="39.0", ADDRESS="CALL 530-555-0103"),
    hifld_row(ID="5", NAME="IMAGINARY AMBULANCE SERVICE", X="-120.8"),
    hifld_row(ID="6", NAME="NO PLACE FIRE STATION", X="", Y=""),
    hifld_row(ID="7", NAME="NULL ISLAND FIRE STATION", X="0", Y="0"),
    hifld_row(ID="8", NAME="METRES FIRE STATION", X="-13413597.6", Y="4707000.1"),
]


def write_hifld(path, rows=HIFLD_ROWS):
    """HIFLD's CSV."""
    lines = [",".join(HIFLD_COLUMNS), *(",".join(row[name] for name in HIFLD_COLUMNS) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


def point(x, y):
    return None if x is None else {"type": "Point", "coordinates": [x, y]}


def write_geojson(path, rows):
    """A FeatureCollection of (geometry, properties)."""
    features = [{"type": "Feature", "geometry": shape, "properties": row} for shape, row in rows]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return path


def usgs_row(**values):
    return {
        "PERMANENT_IDENTIFIER": "{00000000-0000-0000-0000-000000000001}", "FTYPE": 740, "FCODE": 74026,
        "NAME": "Made Up Fire Station 7", "ISLANDMARK": 2, "POINTLOCATIONTYPE": None, "ADMINTYPE": 0,
        "ADDRESSBUILDINGNAME": None, "ADDRESS": "7 Example Road", "CITY": "Nowhere", "STATE": "CA",
        "ZIPCODE": "00000", "LOADDATE": "2023-05-04T00:00:00Z", "GNIS_ID": None,
    } | values  # fmt: skip


USGS_ROWS = [
    (-120.6, 38.8, usgs_row()),
    (-120.61, 38.81, usgs_row(FCODE=74034, NAME="Made Up Sheriff")),
    (None, None, usgs_row(NAME="Made Up Fire Station 8")),
]


def write_usgs(path):
    """A GeoPackage of structures, with the tables that readers look at."""
    with sqlite3.connect(path) as base:
        columns = list(USGS_ROWS[0][2])
        base.execute(
            "CREATE TABLE gpkg_spatial_ref_sys (srs_id, organization, organization_coordsys_id, definition)"
        )
        base.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (4269, 'EPSG', 4269, 'GEOGCS')")
        base.execute("CREATE TABLE gpkg_geometry_columns (table_name, column_name, srs_id)")
        base.execute("INSERT INTO gpkg_geometry_columns VALUES ('Struct_Point', 'SHAPE', 4269)")
        base.execute(f"CREATE TABLE Struct_Point (OBJECTID INTEGER PRIMARY KEY, SHAPE, {', '.join(columns)})")
        for x, y, row in USGS_ROWS:
            shape = None if x is None else geopackage.point(y, x)
            marks = ", ".join("?" * (len(columns) + 1))
            base.execute(
                f"INSERT INTO Struct_Point (SHAPE, {', '.join(columns)}) VALUES ({marks})",
                [shape, *row.values()],
            )
    base.close()
    return path


STATION = {"amenity": "fire_station", "name": "Made Up Station 5", "ref": "5", "phone": "+1-530-555-0104"}
BOUNDS = {"minlat": 39.0, "minlon": -120.4, "maxlat": 39.2, "maxlon": -120.2}
OVERPASS = {
    "version": 0.6,
    "generator": "Overpass API",
    "osm3s": {"timestamp_osm_base": "2026-10-01T12:00:00Z", "copyright": "OpenStreetMap contributors"},
    "elements": [
        {"type": "node", "id": 1, "lat": 38.85, "lon": -120.55, "tags": STATION},
        {"type": "way", "id": 2, "center": {"lat": 38.95, "lon": -120.65}, "nodes": [3, 4],
         "tags": {"amenity": "fire_station", "ref": "12", "operator": "Made Up District",
                  "addr:housenumber": "12", "addr:street": "Example Lane", "contact:email": "x@example.org"}},
        {"type": "relation", "id": 5, "center": {"lat": 38.96, "lon": -120.75},
         "tags": {"amenity": "fire_station", "name": "Made Up Compound"}},
        {"type": "node", "id": 3, "lat": 38.95, "lon": -120.65},
        {"type": "way", "id": 6, "tags": {"amenity": "fire_station", "name": "Made Up Outline"}},
        {"type": "way", "id": 9, "bounds": BOUNDS,
         "tags": {"amenity": "fire_station", "name": "Made Up Hall"}},
        {"type": "node", "id": 7, "lat": 38.9, "lon": -120.6, "tags": {"emergency": "ambulance_station"}},
        {"type": "node", "id": 8, "lat": 38.9, "lon": -120.6, "tags": {"amenity": "fire_station"}},
    ],
}  # fmt: skip
