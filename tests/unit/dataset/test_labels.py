"""Lists of places to label: accepted columns, and messages on other files."""

import json

import pytest
from firetwin.errors import InputError
from firetwin.run import labels
from firetwin.run import opening as runs

PLACES = [labels.Label("Pollock Pines", 38.7616, -120.5869), labels.Label("Loon Lake", 38.992, -120.32)]


@pytest.mark.parametrize("comma", [",", ";", "\t"])
def test_csv_by_the_names_of_its_columns(tmp_path, comma):
    path = tmp_path / "places.csv"
    rows = [("kind", "lon", "Name", "Lat"), *(("x", p.longitude, p.name, p.latitude) for p in PLACES), ("",)]
    path.write_text("\n".join(comma.join(map(str, row)) for row in rows))
    assert labels.read(path) == PLACES


def test_geojson_by_its_points(tmp_path):
    path = tmp_path / "places.geojson"
    shapes = [("Point", [p.longitude, p.latitude, 7.0]) for p in PLACES] + [("LineString", [[0, 0], [1, 1]])]
    names = [*(p.name for p in PLACES), "a road"]
    features = [
        {"type": "Feature", "properties": {"name": name}, "geometry": {"type": kind, "coordinates": at}}
        for name, (kind, at) in zip(names, shapes, strict=True)
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    assert labels.read(path) == PLACES


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("", 1, "names no column name"),
        ("name,lat\nA,1", 1, "names no column longitude"),
        ("name,lat,lon\nA,1,2\nB,north,2", 3, "latitude is 'north', not a number"),
        ("name,lat,lon\nA,91,2", 2, "latitude is 91; it goes from -90 to 90"),
        ("name,lat,lon\nA,nan,2", 2, "latitude is nan"),
        ("name,lat,lon\n,1,2", 2, "a name has 1 to 60 letters, not 0"),
        (f"name,lat,lon\n{'A' * 200_000},1,2", 0, "not a CSV file: field larger"),
        (f'{{"features": {"1" * 5000}}}', 0, "not a GeoJSON FeatureCollection"),
        (
            f'{{"features": [{{"geometry": {{"type": "Point", "coordinates": [0, {"9" * 400}]}}, '
            '"properties": {"name": "A"}}]}',
            0,
            "feature 1: latitude is 9+, not a number",
        ),
        ("{", 1, "not a JSON"),
        ('{"features": [{"geometry": {"type": "Point"}}]}', 0, "feature 1 has no name or no coordinates"),
        ("{}", 0, "not a GeoJSON FeatureCollection"),
    ],
)
def test_one_clear_error(tmp_path, text, line, reason):
    path = tmp_path / "places"
    path.write_text(text)
    with pytest.raises(InputError, match=reason) as caught:
        labels.read(path)
    assert caught.value.line == line
    assert str(path) in str(caught.value)


def test_a_missing_file(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        labels.read(tmp_path / "nowhere.csv")


def test_the_fires_own_are_those_with_published_positions(make_run):
    known = labels.known(runs.open(make_run()))
    assert PLACES[0]._replace(kind="town") in known
    assert "Nevada Point Ridge" not in {place.name for place in known}  # its position is approximate
