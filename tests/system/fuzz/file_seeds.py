"""Sound files of users that fuzzing starts from, and odd values to put into them."""

import json

PLACES = [(39.0, -120.5), (39.1, -120.4)]
SQUARE = [[-120.6, 38.9], [-120.5, 38.9], [-120.5, 39.0], [-120.6, 39.0], [-120.6, 38.9]]
TOKENS = (
    *("", "0", "-0", "-1", "1e308", "-1e308", "1e999", "nan", "inf", "5e-324", "9" * 400, "1" * 5000),
    *("true", "null", "None", "[]", "{}", "[[[[[[[[", '"', "'", "\\", "\0", "\x1b[31m", "\u202e", "\u2028"),
    *("0001-01-01T00:00:00+14:00", "9999-12-31T23:59:59-14:00", "2014-09-17", "25:61", "http://u:p@h/?key=k"),
    *(
        "90",
        "90.0000001",
        "-180",
        "540",
        "541",
        "/dev/zero",
        "..",
        "%2e%2e",
        "${HOME}",
        "<a>",
        "</kml>",
        "&x;",
    ),
    *(
        "é",
        "\U0001f525",
        "x" * 3000,
        ",,,,",
        ";",
        "#",
        "\n",
        "\r",
        "\t",
        "--",
        "engine/3",
        "1-",
        "0x10",
        "1_0",
    ),
)
VALUES = (
    *(
        None,
        0,
        -1,
        1,
        2**63 - 1,
        -(2**63),
        1e308,
        -1e308,
        float("inf"),
        5e-324,
        0.5,
        "",
        "x",
        "nan",
        b"",
        b"\0",
    ),
    *(
        "0001-01-01T00:00:00+14:00",
        "9999-12-31T23:59:59-14:00",
        "2014-09-17T00:00:00Z",
        "engine/3",
        "\u202ex",
    ),
    *("a\0b", "x" * 100_000, b"GP\0\1" + bytes(60), 4326, -4326, "EPSG", "GEOGCS[", "station", "geom"),
)


def feature(geometry, **properties):
    return {"type": "Feature", "geometry": geometry, "properties": properties}


GEOJSON = {
    "type": "FeatureCollection",
    "features": [
        feature({"type": "Polygon", "coordinates": [SQUARE]}, height=8.0, date="2014-09-18T04:00:00Z"),
        feature({"type": "MultiPolygon", "coordinates": [[SQUARE], [SQUARE]]}, name="a", levels="2"),
        feature({"type": "LineString", "coordinates": SQUARE}, origin="fact"),
        feature({"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": SQUARE[0]}]}),
        feature({"type": "Point", "coordinates": SQUARE[0]}, name="Station 1", FTYPE=740, FCODE=74026),
    ],
}
RING = " ".join(f"{x},{y},0" for x, y in SQUARE)
KML = f"""<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Folder><name>Fire</name>
<TimeSpan><begin>2014-09-17T00:00:00Z</begin><end>2014-09-18T00:00:00Z</end></TimeSpan>
<Placemark><name>A</name><ExtendedData><Data name="height"><value>9</value></Data></ExtendedData>
<Polygon><outerBoundaryIs><LinearRing><coordinates>{RING}</coordinates></LinearRing></outerBoundaryIs></Polygon>
</Placemark><Placemark><Point><coordinates>-120.5,39.0,0</coordinates></Point></Placemark>
</Folder></Document></kml>
"""
TRACK_KML = """<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>
<Placemark><gx:Track><altitudeMode>absolute</altitudeMode><when>2014-09-17T21:30:00Z</when>
<when>2014-09-17T21:31:00Z</when><gx:coord>-120.5 39.0 1500</gx:coord><gx:coord>-120.4 39.1 1600</gx:coord>
</gx:Track></Placemark></Document></kml>
"""
LINES_KML = """<kml><Placemark><LineString><altitudeMode>relativeToGround</altitudeMode>
<coordinates>-120.5,39.0,100 -120.4,39.1,200</coordinates></LineString></Placemark></kml>
"""
GPX = """<?xml version="1.0"?><gpx version="1.1"><trk><trkseg>
<trkpt lat="39.0" lon="-120.5"><ele>1500.5</ele><time>2014-09-17T21:30:00Z</time></trkpt>
<trkpt lat="39.1" lon="-120.4"><ele>1600</ele><time>2014-09-17T21:31:00.5Z</time></trkpt></trkseg></trk></gpx>
"""
FIRMS = "latitude,longitude,scan,track,acq_date,acq_time,confidence\n39.0,-120.5,0.4,0.4,2014-09-17,2142,n\n"
TABLE = """station,type,count,load_kg,speed_km_h,mobilise_min,cost_hour,begins,ends,status
A,engine/3,2,1900,60,5,120,2014-09-17T00:00-07:00,2014-09-19T00:00-07:00,available
A,dozer/2,1,,20,30,,,,
"""
SCENE = """run = "run"
cache = "cache"
[time]
start = 2014-09-17T21:06:00Z
frames = 48
speed = 15.0
[terrain]
photo_url = "https://a.example/{z}/{x}/{y}.png?key=${FIRETWIN_KEY_A}"
photo_credit = "a"
[tiles]
sources = ["set", "https://b.example/tileset.json"]
[[cameras]]
name = "drone"
keys = [{ latitude = 38.97, longitude = -120.57, height = 150.0, target = "head" }]
[[cameras]]
name = "space"
kind = "globe"
latitude = 38.9
longitude = -120.6
"""
STORYBOARD = """run = "."
zone = "America/Los_Angeles"
units = "us"
fps = 24
dissolve = 0.5
[[shots]]
name = "title"
picture = "card"
seconds = 5.0
caption = "Small"
[[shots]]
name = "growth"
picture = "map"
start = 2014-09-16T21:45:00.000-07:00
end = 2014-09-16T21:47:00.000-07:00
seconds = 20.0
[[shots]]
name = "place"
camera = "globe"
smoke = false
start = 2014-09-17T04:45:00Z
end = 2014-09-17T04:46:00Z
seconds = 6.0
[[omitted]]
name = "ground"
reason = "no name"
"""
SEEDS = {
    "geojson": [json.dumps(GEOJSON)],
    "kml": [KML],
    "gpx": [GPX],
    "track_kml": [TRACK_KML, LINES_KML],
    "csv": [FIRMS],
    "labels": [json.dumps({"features": [feature({"type": "Point", "coordinates": SQUARE[0]}, name="A")]})],
    "scene": ['run = "run"\n[render]\nresolution = [64, 36]\npasses = ["rgb", "thermal"]\n'],
    "storyboard": [STORYBOARD],
    "run": [
        'start = 2014-09-16T21:45:00Z\ntimes_s = [0, 60, 120]\n[source]\nmodel = "a"\nassumptions = ["b"]\n',
    ],
}
