"""The map sheet: its nine standard elements, scale, grid, legend and warnings."""

import io
import re
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pyproj
import pytest
import small_stations
import whole_run
from firetwin.brief import base_map, briefing, map_sheet, page, paper, sheet_map
from firetwin.brief.map_frame import MapFrame, round_ratio
from firetwin.brief.mercator import Box
from firetwin.brief.paper import Paper
from firetwin.brief.sheet_options import SheetOptions, Titles
from firetwin.imaging import map_symbols
from page_parts import PageParts
from PIL import Image

PREPARED = datetime(2014, 9, 17, 12, tzinfo=UTC)


@pytest.fixture(scope="module")
def gathered(tmp_path_factory):
    """Content of a page with stations, 6 hours of fire."""
    folder = tmp_path_factory.mktemp("sheet")
    run = whole_run.write(
        folder / "run", cell=60.0, cells=100, times=tuple(np.arange(0.0, 21601.0, 1800.0)),
        start="2014-09-17T04:00:00Z", speed=0.1,
    )  # fmt: skip
    gpkg = small_stations.briefed(
        folder / "stations.gpkg", [("Alpha", 38.9, -120.6), ("Bravo", 38.905, -120.595)]
    )
    return briefing.gather(briefing.Request(run, stations=gpkg))


def drawn(gathered, **options):
    chosen = SheetOptions(**{"prepared": PREPARED} | options)
    return map_sheet.draw(gathered, chosen, Titles.of(gathered.run, chosen, gathered.zone))


def words(sheet):
    return PageParts(sheet.svg).text


@pytest.mark.parametrize("size", list(paper.SIZES))
@pytest.mark.parametrize("orientation", ["portrait", "landscape"])
def test_a_sheet_has_the_nine_elements_of_the_standard(gathered, size, orientation):
    sheet = drawn(gathered, paper=size, orientation=orientation, author="A. Author", incident="Test Fire")
    text = words(sheet)
    assert f"Scale 1:{sheet.frame.ratio:,.0f}" in text
    assert len(re.findall('class="scale-bar"', sheet.svg)) == 2
    assert "Test Fire" in text
    assert "A. Author" in text
    assert 'class="north"' in sheet.svg
    assert "17 Sep 2014 04:00 -08" in text  # prepared
    assert "Legend" in text
    assert "Source" in text
    assert re.search(r"38° \d\d\.\d′ N", text)
    assert re.search(r"120° \d\d\.\d′ W", text)
    assert "Datum WGS 84; projection UTM" in text
    assert "EPSG:32610" in text
    width, height = sheet.paper.area
    assert f'viewBox="0 0 {width:g} {height:g}"' in sheet.svg


@pytest.mark.parametrize("size", list(paper.SIZES))
def test_the_map_fills_its_sheet(gathered, size):
    sheet = drawn(gathered, paper=size)
    width, height = sheet.paper.area
    assert sheet.frame.width * sheet.frame.height > 0.5 * width * height
    assert (sheet.paper.width > sheet.paper.height) == (map_sheet.orientation(gathered, size) == "landscape")


def test_scale_bars_are_as_long_as_they_say(gathered):
    sheet = drawn(gathered)
    for metres, inside in re.findall(r'data-metres="([\d.]+)">(.*?)</g>', sheet.svg):
        widths = [float(each) for each in re.findall(r'<rect x="[\d.]+" y="[\d.]+" width="([\d.]+)"', inside)]
        assert sum(widths) * sheet.frame.metres == pytest.approx(float(metres), rel=1e-3)


def test_metric_units_come_first_on_request(gathered):
    assert words(drawn(gathered, units="metric")).index("1 cm =") < words(
        drawn(gathered, units="metric")
    ).index("1 in =")
    assert words(drawn(gathered)).index("1 in =") < words(drawn(gathered)).index("1 cm =")


def test_places_lie_where_proj_has_them():
    frame = MapFrame.fitted(Box(38.7, -120.7, 39.1, -120.2), (5.0, 7.0, 200.0, 150.0))
    there = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32610", always_xy=True)
    east, north = there.transform(-120.5, 38.9)
    x, y = frame.place(38.9, -120.5)
    assert x == pytest.approx(5.0 + (east - frame.west) * 1000.0 / frame.ratio)
    assert y == pytest.approx(7.0 + (frame.north - north) * 1000.0 / frame.ratio)
    latitude, longitude = frame.pixels(500)
    east = frame.west + 250.5 / 500 * (frame.east - frame.west)
    exact = frame.zone.inverse(east, frame.north - 0.5 / 375 * (frame.north - frame.south))
    assert latitude[0, 250] == pytest.approx(float(exact[0]), abs=1e-5)
    assert longitude[0, 250] == pytest.approx(float(exact[1]), abs=1e-5)
    assert latitude.shape == (375, 500)


def test_scales_are_those_of_common_maps():
    assert [round_ratio(each) for each in (23_500.0, 24_500.0, 31_000.0, 63_360.0, 81_000.0, 130_000.0)] == [
        24_000.0, 25_000.0, 31_680.0, 63_360.0, 100_000.0, 150_000.0,
    ]  # fmt: skip


def test_the_national_grid_names_its_squares(gathered):
    text = words(drawn(gathered, grid="usng"))
    assert "US National Grid (USNG/MGRS) every" in text
    assert "10S GJ" in text
    assert "′ N" not in text
    assert "graticule" not in drawn(gathered, grid="none").svg


def test_the_legend_has_what_the_map_has_and_no_more(gathered):
    content = sheet_map.draw(gathered, drawn(gathered).frame, 1.0)
    assert [text for text in content.legend if "Observed" in text or "Road" in text] == []
    edge = next(text for text in content.legend if text.startswith("Simulated fire edge, "))
    for each in (content.legend[edge], "".join(content.lines)):
        assert map_symbols.FIRE_EDGE in each
    assert "Station, burned by the end" in content.legend
    assert all(
        sheet_map.BURNED in each for each in (content.legend["Station, burned by the end"], content.points[0])
    )
    assert set(base_map.colours()) <= set(re.findall("#[0-9a-f]{6}", drawn(gathered).svg))


def test_invented_content_is_marked_in_large_letters(gathered):
    marks = lambda sheet: [inside for each, inside in PageParts(sheet.svg).all("text", **{"class": "mark"})]  # noqa: E731
    assert gathered.marks == ("EXERCISE",)
    sheet = drawn(gathered)
    assert marks(sheet) == ["EXERCISE"]
    size = float(re.search(r'class="mark" x="[\d.]+" y="[\d.]+" font-size="([\d.]+)"', sheet.svg)[1])
    assert size * len("EXERCISE") * 0.6 > 0.4 * sheet.frame.width
    assert marks(drawn(replace(gathered, station_file=None, points=[]))) == []


def test_header_and_footer_cannot_end_their_rule():
    style = paper.style(Paper.named("letter", "landscape"), {"top-left": 'a"; } </style><script> \\'})
    assert "size: 279.4mm 215.9mm" in style
    assert "<" not in style
    assert r'content: "a\22 \3b  \7d  \3c \2f style' in style


@pytest.mark.parametrize("size", ["a4", "letter"])
@pytest.mark.parametrize("name", ["King", "North Complex " * 12, "W" * 120])
def test_header_and_footer_fit_next_to_each_other(gathered, size, name):
    period = (
        "Wednesday, 17 September 2014 06:00 Pacific Daylight Time to 18 September 2014 06:00 Pacific Time"
    )
    titles = Titles(
        name, "", period, "17 Sep 2014 04:00 PDT", "16 Sep 2014 22:00 PDT (start of the run)", "9 h"
    )
    sheet = Paper.named(size, "portrait")
    style = paper.style(sheet, page._running(gathered, titles))
    width = {}
    for box, text in re.findall(r'@([a-z]+-[a-z]+) { content: "((?:[^"])*)"; ', style):
        plain = re.sub(r"\\([0-9a-f]+) ", lambda each: chr(int(each[1], 16)), text)
        lines = plain.split("\n")
        assert len(lines) * 1.15 * 6.5 * 25.4 / 72.0 < paper.HEAD
        width[box] = max(map(paper.measure, lines))
    assert width["top-left"] + width["top-right"] < sheet.area[0]
    side = 0.5 * (sheet.area[0] - width["bottom-center"])
    assert max(width["bottom-left"], paper.measure("Page 100 of 100")) < side


def test_what_lies_outside_the_run_is_in_the_legend(gathered):
    middle = MapFrame.fitted(Box(38.895, -120.605, 38.905, -120.595), (0.0, 0.0, 100.0, 100.0))
    beyond = MapFrame.fitted(Box(38.6, -120.8, 39.2, -120.4), (0.0, 0.0, 100.0, 100.0))
    for frame, outside in ((middle, False), (beyond, True)):
        assert base_map.reaches_outside(gathered.run, frame) == outside
        assert (sheet_map.OUTSIDE in sheet_map.draw(gathered, frame, 1.0).legend) == outside
    picture = Image.open(io.BytesIO(base_map.picture(gathered.run, gathered.elevation, beyond))).convert("L")
    corner = np.asarray(picture)[:40, -40:]
    assert corner.max() - corner.min() > 30  # hatched


def test_a_sheet_has_one_abbreviation_of_local_time(gathered):
    zone = "America/Los_Angeles"
    november = Titles.of(gathered.run, SheetOptions(prepared=datetime(2026, 11, 27, 8, 53, tzinfo=UTC)), zone)
    assert november.period == "16 Sep 2014 21:00 PDT to 17 Sep 2014 03:00 PDT"
    assert november.prepared == "27 Nov 2026 08:53 UTC"  # 00:53 PST
    assert november.issued == "16 Sep 2014 21:00 PDT (start of the run)"
    june = Titles.of(gathered.run, SheetOptions(prepared=datetime(2026, 6, 27, 8, 53, tzinfo=UTC)), zone)
    assert june.prepared == "27 Jun 2026 01:53 PDT"
    night = datetime(2014, 11, 2, 6, tzinfo=UTC), datetime(2014, 11, 2, 12, tzinfo=UTC)
    changed = Titles.of(gathered.run, SheetOptions(prepared=night[1], period=night), zone)
    assert changed.period == "1 Nov 2014 23:00 PDT to 2 Nov 2014 04:00 PST"
    assert changed.prepared == "2 Nov 2014 04:00 PST"


def test_labels_of_the_grid_do_not_overlap_at_corners(gathered):
    for grid in ("latlong", "usng"):
        sheet = drawn(gathered, grid=grid)
        frame, boxes = sheet.frame, []
        for each, inside in PageParts(sheet.svg).all("text", **{"class": "graticule"}):
            x, y, size = (float(each[name]) for name in ("x", "y", "font-size"))
            half = 0.3 * size * len(inside)
            low, high, at = (
                (frame.top, frame.top + frame.height, y)
                if "transform" in each
                else (frame.left, frame.left + frame.width, x)
            )
            assert low <= at - half + 1e-6 <= at + half <= high + 1e-6
            boxes.append(inside)
        assert len(boxes) >= 4


def test_a_town_at_its_station_is_drawn_once(gathered):
    content = sheet_map.Content(drawn(gathered).frame, 1.0)
    content.point("Station", 38.9, -120.6, "Station", ["Exercise base Camino", "not reached"])
    content.point("Named place", 38.9, -120.6, "Named place", ["Camino", "not reached"])
    assert len(content.points) == 1
    assert "Named place" not in content.legend
    content.point("Named place", 38.9, -120.6, "Named place", ["Pollock Pines", "not reached"])
    assert len(content.points) == 2


def test_a_point_has_its_name_if_there_is_no_space_for_more(gathered):
    content = sheet_map.Content(drawn(gathered).frame, 1.0)
    _, y = (float(each) for each in content.frame.place(38.9, -120.6))
    content.taken += [(0.0, 0.0, 1e3, y - 3.0), (0.0, y + 2.0, 1e3, 1e3)]
    content.point("Station", 38.9, -120.6, "Station", ["Alpha", "not reached, nearest fire 0.1 mi (160 m)"])
    assert [re.sub("<[^>]+>", "", each) for each in content.labels] == ["Alpha", "Alpha"]  # halo and text


def test_the_age_of_a_forecast(gathered):
    options = SheetOptions(prepared=PREPARED, issued=datetime(2014, 9, 17, 6, 30, tzinfo=UTC))
    assert Titles.of(gathered.run, options, "UTC").age == "5.5 h"
    assert (
        Titles.of(
            gathered.run, replace(options, prepared=datetime(2014, 9, 29, 6, 30, tzinfo=UTC)), "UTC"
        ).age
        == "12 days"
    )
