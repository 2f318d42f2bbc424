"""The briefing page: its content, escaped texts of files, and its size."""

import hashlib
import itertools
import json
import re
import shutil
import sqlite3
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import small_stations
import whole_run
from firetwin import cli, html_text
from firetwin.brief import (
    briefing,
    curve,
    facts,
    film,
    page,
    reached,
    sections,
    units,
)
from firetwin.brief.sheet_options import SheetOptions
from firetwin.data import history
from firetwin.errors import InputError, UsageError
from firetwin.imaging import map_symbols
from firetwin.render import manifest
from firetwin.run import content
from firetwin.run import opening as runs
from firetwin.run.score import report
from firetwin.stations import fire_arrival, reading
from page_parts import PageParts
from PIL import Image

HOSTILE = (
    "</script><script>alert(1)</script>\"' onload='alert(2)' <img src=x onerror=alert(3)> & \u202eabc\u2028"
)
LEAFLET = Path(page.__file__).parent / "leaflet"
PLACES = [("Alpha", 38.9, -120.6), ("Bravo", 38.905, -120.595), ("Far", 38.9, -100.0)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A fire of 6 hours at the King Fire's place and time."""
    path = tmp_path_factory.mktemp("brief") / "run"
    times = tuple(np.arange(0.0, 21601.0, 1800.0))
    return whole_run.write(path, cell=60.0, cells=100, times=times, start="2014-09-17T04:00:00Z", speed=0.1)


def change(folder, **lines):
    """Replace or add lines of run.toml."""
    toml = (folder / "run.toml").read_text().split("[units]")
    kept = [line for line in toml[0].splitlines() if line.split(" ")[0] not in lines]
    new = [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in lines.items()]
    (folder / "run.toml").write_text("\n".join([*new, *kept, "[units]"]) + toml[1], encoding="utf-8")


@pytest.fixture
def own(folder, tmp_path):
    """A copy of the run that a test may change."""
    return Path(shutil.copytree(folder, tmp_path / "own"))


def parts(scene, limit=10_000_000, **options):
    return PageParts(page.html(briefing.gather(briefing.Request(scene, **options)), limit))


@pytest.fixture
def gpkg(tmp_path):
    return small_stations.briefed(tmp_path / "stations.gpkg", PLACES)


def test_leaflet_is_the_published_one_with_its_licence():
    table = re.findall(r"\| `(\w[\w.]+)` \| `([0-9a-f]{64})` \|", (LEAFLET / "README.md").read_text())
    assert [name for name, _ in table] == ["leaflet.js", "leaflet.css", "LICENSE"]
    for name, digest in table:
        assert hashlib.sha256((LEAFLET / name).read_bytes()).hexdigest() == digest


def test_the_page_says_what_is_where_and_when(folder):
    parsed = parts(folder)
    assert (
        "16 Sep 2014 20:00 -08 to 17 Sep 2014 02:00 -08 (17 Sep 2014 04:00 to 17 Sep 2014 10:00 UTC)"
        in parsed.text
    )
    assert "times are UTC and Etc/GMT+8" in parsed.text
    run = runs.open(folder)
    acres = np.isfinite(run.fuel_arrival_time()).sum() * 3600.0 / history.SQUARE_METRES_PER_ACRE
    assert f"Burned area at the end {acres:,.0f} acres" in parsed.text
    assert [each["utc"] for each in parsed.data["times"]][:: len(parsed.data["times"]) - 1] == [
        "2014-09-17T04:00:00Z",
        "2014-09-17T10:00:00Z",
    ]
    assert len(parsed.data["fronts"]["features"]) == len(parsed.data["times"])
    layers = [attributes["data-layer"] for attributes, _ in parsed.all("img") if "data-layer" in attributes]
    assert layers == ["hillshade", "fuel", "arrival"]
    assert "synthetic" not in parsed.text
    assert "Exercise" not in parsed.text
    assert not parsed.all("input", id="search")  # nothing to search


def test_a_synthetic_run_is_called_synthetic(own):
    change(own, synthetic=True)
    assert "This run is synthetic, not the output of a fire model." in parts(own).text


@pytest.mark.parametrize(
    "about", [{"exercise": "Exercise: not operational advice"}, {"origin": "Exercise"}, {}]
)
def test_lines_of_an_exercise_mark_the_page_without_stations(own, tmp_path, about):
    change(own, synthetic=True)
    line = {"type": "LineString", "coordinates": [[-120.62, 38.9], [-120.58, 38.91]]}
    feature = {"type": "Feature", "properties": about | {"division": "A"}, "geometry": line}
    file = tmp_path / "allocation.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    parsed = parts(own, context=[("allocation", file)])
    marks = ["SYNTHETIC", "EXERCISE"] if about else ["SYNTHETIC"]
    assert parsed.data["marks"] == marks  # on the map of the screen
    assert [inside for each, inside in parsed.all("text", **{"class": "mark"})] == marks  # on the sheet
    ((_, stamp),) = parsed.all("div", **{"class": "stamp"})  # on each printed page
    assert stamp == "".join(marks)
    styles = "".join(inside for _, inside in parsed.all("style"))
    assert ("SYNTHETIC \\2f  EXERCISE" in styles) == bool(about)
    assert ("Exercise: not operational advice" in parsed.text) == bool(about)
    noted = "\n".join(page.notes(briefing.gather(briefing.Request(own, context=[("allocation", file)]))))
    assert ("Exercise: not operational advice" in noted) == bool(about)


@pytest.mark.parametrize(("order", "first", "second"), [("us", "acres", "ha"), ("metric", "ha", "acres")])
def test_units_of_the_user_come_first(folder, gpkg, order, first, second):
    parsed = parts(folder, stations=gpkg, sheet=SheetOptions(units=order))
    assert re.search(rf"Burned area at the end [\d,]+ {first} \([\d,]+ {second}\)", parsed.text)
    assert re.search(rf"^[\d,]+ {first} \(", parsed.data["times"][-1]["area"])
    axes = [inside for _, inside in parsed.all("text", **{"class": "unit end"})]
    assert axes == [first]
    far = next(each["text"] for each in parsed.data["points"] if each["name"] == "Far")
    pair = r"[\d,.]+ mi \([\d,.]+ km\)" if order == "us" else r"[\d,.]+ km \([\d,.]+ mi\)"
    assert re.search(f"nearest fire {pair}", far)
    assert ("tank at least 500 gal (1,893 l)" in parsed.text) == (order == "us")
    assert ("tank at least 1,893 l (500 gal)" in parsed.text) == (order == "metric")


def test_units_of_one_number_are_those_of_their_definition():
    mile = 5280 * 12 * 0.0254  # m
    assert units.AREA["us"].factor == pytest.approx(640.0 / mile**2)  # a square mile has 640 acres
    assert units.AREA["metric"].format(123_456.0) == "12"
    assert units.SEPARATION["us"].format(2.5 * mile) == "2.50"
    ton = 2000 * 0.45359237  # kg
    assert units.FUEL["us"].factor == pytest.approx(mile**2 / 640.0 / ton)
    assert units.FUEL["us"].factor == pytest.approx(4.4609, abs=1e-4)  # 1 kg/m2


@pytest.mark.parametrize(
    ("order", "heads", "numbers"),
    [
        ("us", ["run, acres", "seen, acres", "apart, mi"], ["247", "494", "0.50", "1.25"]),
        ("metric", ["run, ha", "seen, ha", "apart, m"], ["100", "200", "805", "2,012"]),
    ],
)
def test_score_tables_have_the_units_of_the_user(order, heads, numbers):
    names = ("sorensen", "jaccard", "kappa", "precision", "recall", "sdi", "adi")
    polygons = dict.fromkeys(names, 0.5) | {"area": 1e6, "observed_area": 2e6}
    found = {"polygons": polygons, "error": dict.fromkeys(polygons, 0.0)}
    row = {
        "time": "2014-09-17T04:00:00+00:00",
        "all": found,
        "distance": {"mean": 804.672, "hausdorff": 2011.68},
    }
    results = {
        "uses": [],
        "dates": [row],
        "zone": "UTC",
        "other_run": None,
        "arrival": None,
        "detections": [],
    }
    made = PageParts("".join(report.tables(results, units.AREA[order], units.SEPARATION[order])))
    titles = [inside for _, inside in made.all("th")]
    assert [titles[k] for k in (1, 2, -1)] == heads
    cells = [inside for _, inside in made.all("td")]
    assert [cells[1], cells[2], cells[-1]] == [
        f"{numbers[0]}± 0", f"{numbers[1]}± 0", f"{numbers[2]}most {numbers[3]}",
    ]  # fmt: skip


LINE = [[-120.62, 38.9], [-120.58, 38.91]]
ALLOCATED = [
    ("LineString", LINE, {
        "kind": "control_line", "division": "A", "hour": 3.0, "held": True, "front_m": 4023.4,
        "line_m": 2011.7, "FeatureCategory": "Planned Line",
    }),
    ("LineString", LINE, {
        "kind": "resource", "division": "A", "name": "E<b>31", "type": "engine3", "station": "Alpha",
        "arrival_min": 42.4, "line_m": 1005.8,
    }),
    ("LineString", LINE, {
        "kind": "control_line", "division": "B", "hour": 6.0, "held": False, "front_m": 804.7, "line_m": None,
        "FeatureCategory": "Line Not Held",
    }),
    ("Point", LINE[0], {"kind": "division_break", "name": "A/B", "FeatureCategory": "Division Break"}),
    ("Point", [-100.0, 38.9], {"name": "too far"}),
]  # fmt: skip


@pytest.fixture
def allocated(tmp_path):
    """A layer of `firetwin allocate`, and a point far outside of the run."""
    features = [
        {
            "type": "Feature",
            "properties": {"exercise": "Exercise: not operational advice"} | about,
            "geometry": {"type": kind, "coordinates": where},
        }
        for kind, where, about in ALLOCATED
    ]
    file = tmp_path / "allocation.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return file


def test_map_features_are_layers_of_the_interactive_map(folder, allocated):
    parsed = parts(folder, context=[("allocation", allocated)])
    assert parsed.all("div", **{"data-layer": "context-0"})
    line, sent, lost, spot = parsed.data["context"]["context-0"]  # the fifth lies outside of the map
    assert line["lines"] == [[[38.9, -120.62], [38.91, -120.58]]]
    assert (line["text"], line["colour"]) == ("Planned Line", map_symbols.LINES["Planned Line"].colour)
    assert line["dashes"] == "10 7"
    assert lost["colour"] == map_symbols.FIRE_EDGE
    assert sent["text"] == "allocation: E<b>31"
    assert (spot["text"], spot["symbol"]) == ("Division Break: A/B", "Division Break")
    assert parsed.data["symbols"] == {"Division Break": map_symbols.POINTS["Division Break"]} | {
        "Named place": map_symbols.POINTS["Named place"]
    }
    ((_, legend),) = parsed.all("div", **{"data-layer": "context-0"})
    assert "Planned Line" in legend
    assert "Line Not Held" in legend


def test_each_division_has_a_table(folder, allocated):
    made = parts(folder, context=[("allocation", allocated)])
    text = made.text
    assert "Division A, contained at hour 3, line 100 chains (2,012 m) of 200 chains (4,023 m)" in text
    assert "1 E<b>31 engine3 Alpha 42 min 50 chains (1,006 m)" in text
    assert "Division B, cannot be held by hour 6, front 40 chains (805 m)" in text
    assert len(made.all("table", **{"class": "resources division"})) == 2
    assert "Divisions" not in parts(folder).text


def test_nothing_can_be_loaded_or_sent(folder, gpkg):
    parsed = parts(folder, stations=gpkg)
    ((policy, _),) = parsed.all("meta", **{"http-equiv": "Content-Security-Policy"})
    rules = dict(rule.strip().split(" ", 1) for rule in policy["content"].split(";"))
    assert rules == {
        "default-src": "'none'",
        "img-src": "data:",
        "media-src": "data:",
        "style-src": "'unsafe-inline'",
        "script-src": "'unsafe-inline'",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    for tag, attributes, inside in parsed.elements:
        assert tag not in ("iframe", "object", "embed", "form", "base")
        assert attributes.get("src", "data:").startswith("data:")
        assert not any(name.startswith("on") for name in attributes)
        if tag == "style":
            assert "url(" not in "".join(inside)
        if tag == "link":
            assert attributes["href"] == "data:,"
        if tag == "a" and not attributes["href"].startswith("#"):
            assert attributes["href"].startswith("https://")
            assert "noreferrer" in attributes["rel"]
    assert "sourceMappingURL" not in "".join("".join(inside) for _, _, inside in parsed.elements)


def test_hostile_texts_of_files_stay_texts(own, tmp_path):
    change(own, name=HOSTILE)
    harmless = small_stations.briefed(tmp_path / "harmless.gpkg", [("Alpha", 38.9, -120.6)])
    found = reading.read(harmless)
    (station,) = found.stations
    station = replace(station, name=HOSTILE, agency=HOSTILE, kind=HOSTILE, address=HOSTILE)
    gpkg = small_stations.put(tmp_path / "hostile.gpkg", [station], found.resources, found.availability)
    with sqlite3.connect(gpkg) as base:
        base.execute(
            "UPDATE source SET name = ?, licence = ?, url = 'javascript:alert(4)'", (HOSTILE, HOSTILE)
        )
        base.execute("UPDATE resource SET name = ?, note = ?, staffing = ?, currency = ?", [HOSTILE] * 4)
        base.execute("UPDATE availability SET area = ?", [HOSTILE])
        base.execute("UPDATE resource SET type = ?", [HOSTILE])
        base.execute("UPDATE type SET code = ?, kind = ? WHERE code = 'engine/3'", [HOSTILE] * 2)
    base.close()
    plain, hostile = parts(own), parts(own, stations=gpkg)
    assert len(hostile.all("script")) == len(plain.all("script")) == 3
    assert {tag for tag, _, _ in hostile.elements} == {
        tag for tag, _, _ in parts(own, stations=harmless).elements
    }
    assert all(not name.startswith("on") for _, attributes, _ in hostile.elements for name in attributes)
    assert not any("javascript:" in attributes.get("href", "") for _, attributes, _ in hostile.elements)
    shown = HOSTILE.replace("\u202e", "\\u202e").replace("\u2028", "\\u2028")
    assert hostile.all("h1")[0][1] == shown
    assert hostile.all("button", **{"class": "name"})[0][1] == shown
    assert hostile.data["points"][0]["name"] == HOSTILE.replace("\u202e", "\\u202e")


def test_json_in_a_script_cannot_end_it():
    value = {"a": "</script><!-- &", "b": ["\u2028", 1.5, None]}
    made = html_text.script_json(value)
    assert not set("<>&\u2028") & set(made)
    assert json.loads(made) == value
    with pytest.raises(ValueError, match="JSON"):
        html_text.script_json(float("nan"))


def test_each_exercise_row_says_exercise(folder, gpkg):
    parsed = parts(folder, stations=gpkg)
    assert parsed.text.count("Exercise: not operational advice") == 2  # of the page, and of its list
    rows = [inside for attributes, inside in parsed.all("tr") if attributes.get("class") == "resource"]
    groups = [inside for attributes, inside in parsed.all("tbody") if "data-id" in attributes]
    assert len(rows) == 4
    assert len(groups) == 3
    assert all("exercise" in inside for inside in rows)
    assert all("exercise" in inside for inside in groups)
    assert parsed.text.count("source: Made up for tests") == 1  # below the caption, not in each row
    assert not any("Made up for tests" in inside for inside in groups)
    assert all(point["exercise"] for point in parsed.data["points"])
    assert "Made up for tests, data of 2026-01-01; licence: CC0-1.0" in parsed.text


def test_availability_is_that_of_the_runs_time(folder, gpkg):
    with sqlite3.connect(gpkg) as base:
        for begins, ends, status in (
            ("2014-09-16T00:00:00Z", "2014-09-17T03:59:00Z", "reserved"),
            ("2014-09-17T05:00:00Z", "2014-09-17T06:00:00Z", "committed"),
            ("2014-09-17T11:00:00Z", "2014-09-18T00:00:00Z", "reserved"),
        ):
            columns = "resource, begins, ends, status, area"
            row = 10, begins, ends, status, "Local"
            base.execute(f"INSERT INTO availability ({columns}) VALUES (?, ?, ?, ?, ?)", row)
    base.close()
    made = parts(folder, stations=gpkg)
    assert "16 Sep 2014 21:00 -08 to 16 Sep 2014 22:00 -08: committed, Local" in made.text
    assert "16 Sep 21:00-22:00 committed" in made.text  # in the printed table
    assert "Resources by station; available in local time, 2014 (Etc/GMT+8), area Local" in made.text
    assert "reserved, Local" not in made.text
    assert made.text.count("2 more periods before or after the run") == 1


def test_printed_windows_fit_a_line(folder, gpkg):
    """Times stated as unavailable and a common area of use are not repeated in each row."""
    with sqlite3.connect(gpkg) as base:
        base.execute("DELETE FROM availability")
        for resource in (10, 11):
            for begins, ends, status in (
                ("01", "05", "unavailable"),
                ("05", "07", "available"),
                ("07", "23", "unavailable"),
            ):
                row = resource, f"2014-09-17T{begins}:00:00Z", f"2014-09-17T{ends}:00:00Z", status, "North"
                if resource == 10 or status == "unavailable":
                    columns = "resource, begins, ends, status, area"
                    base.execute(f"INSERT INTO availability ({columns}) VALUES (?, ?, ?, ?, ?)", row)
    base.close()
    parsed = parts(folder, stations=gpkg)
    ((_, table),) = parsed.all("table", **{"class": "resources lines"})
    assert "(Etc/GMT+8), area North; times stated as unavailable are omitted" in table
    assert "16 Sep 21:00-23:00exercise" in table
    assert "16 Sep 17:00-21:00 unavailable; 16 Sep 23:00 to 17 Sep 15:00 unavailable" in table
    assert table.count("North") == 1
    assert table.count("unavailable") == 3
    titles = [inside for attributes, inside in parsed.all("th") if attributes["scope"] == "rowgroup"]
    assert titles == ["Alpha", "Far"]  # Bravo has no resources


def test_facts_are_called_facts_beside_the_resources_of_an_exercise(folder, tmp_path):
    made = parts(folder, stations=small_stations.briefed(tmp_path / "facts.gpkg", PLACES[1:], origin="fact"))
    tags = [
        inside for attributes, inside in made.all("span") if attributes.get("class", "").startswith("tag")
    ]
    assert sorted(tags) == ["exercise", "exercise", "fact", "fact"]
    assert "Exercise: not operational advice" in made.text


def test_stations_have_an_ordinary_link_to_a_web_map(folder, gpkg):
    made = parts(folder, stations=gpkg)
    links = [attributes for attributes, inside in made.all("a") if inside == "Open in web map"]
    assert (
        links[0]["href"]
        == "https://www.openstreetmap.org/?mlat=38.90000&mlon=-120.60000#map=14/38.90000/-120.60000"
    )
    assert links[0]["aria-label"] == "Open Alpha in web map"


def test_the_fire_reaches_a_place_between_the_times_of_the_cells_around(folder):
    run = runs.open(folder)
    arrival = run.fuel_arrival_time()
    row, column = np.unravel_index(np.nanargmax(arrival), arrival.shape)
    latitude, longitude = run.fuel_latitude[row], run.fuel_longitude[column]
    never_row, never_column = np.argwhere(np.isnan(arrival))[0]
    far = float(run.fuel_latitude[never_row]), float(run.fuel_longitude[never_column])
    arrivals = reached.find(
        run, [latitude + 1e-4, *far[:1], 10.0], [longitude - 1e-4 + 360.0, far[1], 10.0], "UTC"
    )
    assert [each.state for each in arrivals] == ["reached", "not_reached", "outside"]
    sampled = fire_arrival.sample(run, [latitude + 1e-4], [longitude - 1e-4])
    assert arrivals[0].time == sampled.time[0]
    burned = np.argwhere(np.isfinite(arrival))
    metres = whole_run.areas.metres_per_degree(38.9)
    away = np.hypot(
        (run.fuel_latitude[burned[:, 0]] - far[0]) * metres[0],
        (run.fuel_longitude[burned[:, 1]] - far[1]) * metres[1],
    ).min()
    assert arrivals[1].distance == pytest.approx(away, rel=1e-3)


def test_places_burned_before_the_run_began_are_told(folder):
    run = runs.open(folder)

    class Later:
        times = run.times[4:]

        def __getattr__(self, name):
            return getattr(run, name)

    (found,) = reached.find(Later(), [38.9], [-120.6], "UTC")
    assert (found.state, found.text.headline, found.time) == ("before", "burned before the run", None)


def test_what_a_list_says_of_a_place(folder, gpkg):
    made = parts(folder, stations=gpkg)
    states = {point["name"]: (point["state"], point["text"]) for point in made.data["points"]}
    assert states["Alpha"][0] == "reached"
    moment = r"17 Sep 04:\d\d"
    told = rf"16 Sep 2014 20:\d\d -08, {moment} UTC, at the model's cell of \d+ m"
    assert re.fullmatch(told, states["Alpha"][1])
    assert states["Far"][0] == "outside"
    assert states["Far"][1].startswith("outside the run, nearest fire ")
    assert units.distance(140.0, "metric") == "140 m (0.09 mi)"
    assert units.distance(14_000.0, "us") == "8.7 mi (14 km)"
    assert units.distance(1610.0, "us") == "1.1 mi (1.7 km)"  # rounded up, as "within" says
    assert units.length(2011.68, "us") == "100 chains (2,012 m)"


def test_named_places_of_a_known_fire_come_without_a_file(make_run):
    made = parts(make_run("npy"))  # event = "king_fire"
    known = {place.name for place in history.load("king_fire").places}
    names = [inside for attributes, inside in made.all("button") if attributes.get("class") == "name"]
    assert set(names) <= known
    assert "This run is synthetic" in made.text


def test_burned_area_stands_beside_reports(make_run):
    made = parts(make_run("npy"))
    assert "11,520" in made.text
    assert "Wikipedia (earlier revision)" in made.text
    assert "other reports are from before or after this run" in made.text


def test_the_curve_has_its_points_where_the_axes_say(folder):
    gathered = briefing.gather(briefing.Request(folder))
    reported = [{"time": gathered.fronts[-1].utc.isoformat(), "reported": 5e6, "run": 1.0, "source": "<b>"}]
    place = curve.axes(gathered.fronts, reported)
    drawn = PageParts(curve.svg(gathered.fronts, reported, gathered.zone))
    ((dot, _),) = drawn.all("circle")
    assert float(dot["cx"]) == place.x(gathered.fronts[-1].utc) == curve.WIDTH - curve.RIGHT
    assert float(dot["cy"]) == place.y(5e6)
    ((line, _),) = drawn.all("polyline")
    assert len(line["points"].split()) == len(gathered.fronts)
    assert "(<b>)" in drawn.text


def perimeter(path, folder):
    """Observation: the box of the area burned by the end of the run."""
    run = runs.open(folder)
    row, column = (np.flatnonzero(np.isfinite(run.fuel_arrival_time()).any(axis)) for axis in (1, 0))
    south, north = (float(run.fuel_latitude[i]) for i in row[[0, -1]])
    west, east = (float(run.fuel_longitude[i]) for i in column[[0, -1]])
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    feature = {"type": "Feature", "properties": {"date": "2014-09-17T09:00:00Z"}, "geometry": geometry}
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))


def test_scores_against_observations_have_their_error(own):
    assert "Scores against observations" not in parts(own).text
    perimeter(own / "observations" / "seen.geojson", own)
    made = parts(own)
    assert "Scores against observations" in made.text
    assert "±" in made.text
    assert "Observations: seen.geojson" in made.text
    assert made.data["observed"]["features"][0]["properties"]["time"] == "2014-09-17T09:00:00Z"
    assert [a["data-layer"] for a, _ in made.all("div") if "data-layer" in a][:2] == ["front", "observed"]


def rendered(out, folder, frames=5, clip=1000, **other):
    """A film's folder: pictures of one colour, a clip, and the manifest."""
    hashes = {"run.toml": "other", **content.inputs(runs.open(folder), out), **other}
    entries = {}
    for frame in range(1, frames + 1):
        path = f"drone/rgb/drone_rgb_{frame:06d}.png"
        (out / path).parent.mkdir(parents=True, exist_ok=True)
        Image.new("RGB", (1920, 1080), (10 * frame, 0, 0)).save(out / path)
        time = f"2014-09-17T0{3 + frame}:00:00+00:00"
        entries[path] = {"camera": "drone", "pass": "rgb", "frame": frame, "time": time, "settings": "a"}
    (out / "drone/drone_rgb.mp4").write_bytes(b"x" * clip)
    entries["drone/drone_rgb.mp4"] = {"camera": "drone", "pass": "rgb", "settings": "b"}
    manifest.write(out, {"a": {"run": hashes}, "b": {}}, entries)
    return out


def test_a_films_frames_are_made_smaller_and_its_clips_come_along(folder, tmp_path):
    parsed = parts(folder, film=rendered(tmp_path / "film", folder))
    pictures = [attributes for attributes, _ in parsed.all("img") if "data-view" in attributes]
    assert len(pictures) == film.EACH
    assert all(attributes["src"].startswith("data:image/jpeg;base64,") for attributes in pictures)
    assert "drone, rgb 16 Sep 2014 20:00 -08 (17 Sep 04:00 UTC)" in parsed.text
    assert "17 Sep 2014 00:00 -08" in parsed.text
    ((clip, _),) = parsed.all("video")
    assert clip["src"].startswith("data:video/mp4;base64,eHh4")
    shown = film.read(tmp_path / "film", {}, 10_000)
    import base64
    import io

    small = Image.open(io.BytesIO(base64.b64decode(shown.frames[0].uri.partition(",")[2])))
    assert small.size == (film.WIDTH, 540)


def test_clips_without_room_are_left_out_and_told(folder, tmp_path, monkeypatch):
    out = rendered(tmp_path / "film", folder, clip=30_000)
    assert film.read(out, {}, 39_999).left_out == [
        "drone/drone_rgb.mp4 of 30 kB: the page would be too large"
    ]
    assert film.read(out, {}, 40_000).left_out == []
    monkeypatch.setattr(film, "CLIP", 29_999)
    assert "the limit of a clip is 30 kB" in film.read(out, {}, 40_000).left_out[0]
    made = parts(folder, film=out)
    assert not made.all("video")
    assert "drone/drone_rgb.mp4" in made.text


def test_a_film_of_another_run_is_refused(folder, tmp_path):
    out = rendered(tmp_path / "film", folder, **{"elevation.npy": "0"})
    with pytest.raises(InputError, match=r"shows another run \(.* has other elevation.npy"):
        parts(folder, film=out)


def test_a_folder_without_pictures_is_refused(folder, tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="has no finished pictures"):
        parts(folder, film=tmp_path / "empty")


def test_a_manifest_cannot_bring_files_from_elsewhere(folder, tmp_path):
    (tmp_path / "secret.mp4").write_bytes(b"secret")
    out = rendered(tmp_path / "film", folder)
    kept = manifest.read(out)
    entry = {"camera": "drone", "pass": "rgb", "settings": "b"}
    manifest.write(out, kept["settings"], {**kept["files"], "../secret.mp4": entry})
    assert len(film.read(out, {}, 10_000).clips) == 1


def test_what_burns_after_the_run_ends_is_never_reached_in_it(folder):
    run = runs.open(folder)

    class Shorter:
        times = run.times[:3]

        def __getattr__(self, name):
            return getattr(run, name)

    arrival = run.fuel_arrival_time()
    late = np.argwhere(arrival > run.times[4])[0]
    at = [run.fuel_latitude[late[0]]], [run.fuel_longitude[late[1]]]
    (whole,), (short,) = reached.find(run, *at, "UTC"), reached.find(Shorter(), *at, "UTC")
    assert (whole.state, short.state) == ("reached", "not_reached")
    assert short.distance > 60.0


def test_a_file_that_is_none_of_places_is_one_clear_error(folder, tmp_path):
    (tmp_path / "notes.gpkg").write_text("notes " * 100)
    with pytest.raises(
        InputError, match=r"notes.gpkg: is not a station file; make one: firetwin stations import"
    ):
        parts(folder, stations=tmp_path / "notes.gpkg")


def test_resources_say_what_is_known_of_them(gpkg):
    station_file = reading.read(gpkg)
    engine, crew = station_file.resources_of[1]
    assert facts.facts(station_file, engine, "metric") == (
        "tank at least 1,893 l (500 gal), pump at least 568 l/min (150 gal/min), people at least 3, "
        "speed 60 km/h (37.3 mph), "
        "mobilises in 5 min, cost 210 USD per hour, mode attack, works at night"
    )
    assert "tank at least 500 gal (1,893 l), pump" in facts.facts(station_file, engine, "us")
    assert "people at least 18" in facts.facts(station_file, crew)


@pytest.mark.parametrize("odd", [{"cells": 1}, {"cells": 2}, {"times": (0.0,)}, {"arrival": False}], ids=str)
def test_small_runs_have_a_page_too(tmp_path, odd):
    made = parts(whole_run.write(tmp_path / "run", **({"cells": 20} | odd)))
    assert len(made.data["times"]) == len(made.data["fronts"]["features"]) >= 1


def test_a_place_on_the_other_side_of_the_antimeridian_is_drawn_beside_the_run(tmp_path):
    run = whole_run.write(tmp_path / "run", cells=60, at=(52.0, 179.999))
    parsed = parts(run, stations=small_stations.briefed(tmp_path / "p.gpkg", [("Alpha", 52.0, -179.9995)]))
    (point,) = parsed.data["points"]
    assert point["longitude"] == pytest.approx(180.0005)
    assert point["state"] != "outside"
    (_, west), (_, east) = parsed.data["bounds"]
    assert west < 180.0005 < east
    assert "mlon=-179.99950" in next(a["href"] for a, text in parsed.all("a") if text == "Open in web map")


def test_the_page_says_its_size_and_has_a_limit(folder):
    gathered = briefing.gather(briefing.Request(folder))
    text = page.html(gathered, 10_000_000)
    assert len(text.encode()) < 1_000_000  # of a small run: Leaflet is 0.16 MB of it
    told = f"This page is a single file of {html_text.size(len(text.encode()))} and loads no other files."
    assert told in PageParts(text).text
    with pytest.raises(UsageError, match=r"the page has \d+ kB, above the limit of 100 kB; .* --limit"):
        page.html(gathered, 100_000)


def test_sources_and_licences_are_all_named(folder, gpkg):
    found = replace(briefing.gather(briefing.Request(folder, gpkg)), inputs=[("Elevation model", "a<b.tif")])
    made = PageParts(sections.sources(found))
    for words in ("Leaflet 1.9.4", "BSD 2-Clause License", "GPL-3.0-or-later", "a<b.tif", "© OpenStreetMap"):
        assert words in made.text
    assert "Volodymyr Agafonkin" in made.text


def test_the_methods_are_a_paragraph_for_a_paper(folder, own):
    text = PageParts(sections.method(briefing.gather(briefing.Request(folder)))).text
    assert "on 100 x 100 cells of 60 m" in text
    assert "The run is not compared with observations." in text
    assert "rendered" not in text
    change(own, name=HOSTILE)
    assert "<script>" not in sections.method(briefing.gather(briefing.Request(own)))


def test_the_command_writes_the_file_and_tells_what_to_know(folder, gpkg, tmp_path, capsys):
    out = tmp_path / "made" / "page.html"
    assert cli.main(["brief", str(folder), "--out", str(out), "--stations", str(gpkg)]) == 0
    told = capsys.readouterr()
    assert told.out.strip() == str(out)
    assert "Exercise: not operational advice" in told.err
    assert "kB, which loads no other files" in told.err
    assert out.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_the_command_wants_an_html_file(folder, tmp_path, capsys):
    assert cli.main(["brief", str(folder), "--out", str(tmp_path / "page.txt")]) == 2
    assert "name an .html file" in capsys.readouterr().err


def test_a_limit_below_any_page_is_refused_before_the_work(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(briefing, "gather", lambda _: pytest.fail("the work began"))
    assert cli.main(["brief", str(folder), "--out", str(tmp_path / "page.html"), "--limit", "10KB"]) == 2


def test_controls_and_tables_have_names_and_the_page_a_language(folder, gpkg):
    parsed = parts(folder, stations=gpkg)
    assert parsed.all("html")[0][0]["lang"] == "en"
    labelled = "".join(inside for _, inside in parsed.all("label"))
    for tag in ("input", "select", "button", "video"):
        for attributes, inside in parsed.all(tag):
            named = attributes.get("aria-label") or inside.strip() or attributes.get("type") == "checkbox"
            assert named, (tag, attributes)
    assert all(title in labelled for title in ("Front at this time", "Fire arrival time", "Fuel load"))
    assert all(attributes["alt"] for attributes, _ in parsed.all("img"))
    assert all(attributes["scope"] in ("col", "rowgroup") for attributes, _ in parsed.all("th"))
    assert len(parsed.all("caption")) == len(parsed.all("table")) == 3
    ((_, title),) = parsed.all("h1")
    assert title
    levels = [int(tag[1]) for tag, _, _ in parsed.elements if re.fullmatch("h[1-6]", tag)]
    assert all(b - a <= 1 for a, b in itertools.pairwise(levels))
    assert not any(int(attributes.get("tabindex", 0)) > 0 for _, attributes, _ in parsed.elements)
    ids = [attributes["id"] for _, attributes, _ in parsed.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
