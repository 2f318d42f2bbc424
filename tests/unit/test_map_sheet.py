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
def found(tmp_path_factory):
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


def drawn(found, **options):
    chosen = SheetOptions(**{"prepared": PREPARED} | options)
    return map_sheet.draw(found, chosen, Titles.of(found.run, chosen, found.zone))


def words(sheet):
    return PageParts(sheet.svg).text


@pytest.mark.parametrize("size", list(paper.SIZES))
@pytest.mark.parametrize("orientation", ["portrait", "landscape"])
def test_a_sheet_has_the_nine_elements_of_the_standard(found, size, orientation):
    sheet = drawn(found, paper=size, orientation=orientation, author="A. Author", incident="Test Fire")
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
def test_the_map_fills_its_sheet(found, size):
    sheet = drawn(found, paper=size)
    width, height = sheet.paper.area
    assert sheet.frame.width * sheet.frame.height > 0.5 * width * height
    assert (sheet.paper.width > sheet.paper.height) == (map_sheet.orientation(found, size) == "landscape")


def test_scale_bars_are_as_long_as_they_say(found):
    sheet = drawn(found)
    for metres, inside in re.findall(r'data-metres="([\d.]+)">(.*?)</g>', sheet.svg):
        widths = [float(each) for each in re.findall(r'<rect x="[\d.]+" y="[\d.]+" width="([\d.]+)"', inside)]
        assert sum(widths) * sheet.frame.metres == pytest.approx(float(metres), rel=1e-3)


def test_metric_units_come_first_on_request(found):
    assert words(drawn(found, units="metric")).index("1 cm =") < words(drawn(found, units="metric")).index(
        "1 in ="
    )
    assert words(drawn(found)).index("1 in =") < words(drawn(found)).index("1 cm =")


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


def test_the_national_grid_names_its_squares(found):
    text = words(drawn(found, grid="usng"))
    assert "US National Grid (USNG/MGRS) every" in text
    assert "10S GJ" in text
    assert "′ N" not in text
    assert "graticule" not in drawn(found, grid="none").svg


def test_the_legend_has_what_the_map_has_and_no_more(found):
    content = sheet_map.draw(found, drawn(found).frame, 1.0)
    assert [text for text in content.legend if "Observed" in text or "Road" in text] == []
    edge = next(text for text in content.legend if text.startswith("Simulated fire edge, "))
    for each in (content.legend[edge], "".join(content.lines)):
        assert map_symbols.FIRE_EDGE in each
    assert "Station, burned by the end" in content.legend
    assert all(
        sheet_map.BURNED in each for each in (content.legend["Station, burned by the end"], content.points[0])
    )
    assert set(base_map.colours()) <= set(re.findall("#[0-9a-f]{6}", drawn(found).svg))


def test_invented_content_is_marked_in_large_letters(found):
    marks = lambda sheet: [inside for each, inside in PageParts(sheet.svg).all("text", **{"class": "mark"})]  # noqa: E731
    assert found.marks == ("EXERCISE",)
    sheet = drawn(found)
    assert marks(sheet) == ["EXERCISE"]
    size = float(re.search(r'class="mark" x="[\d.]+" y="[\d.]+" font-size="([\d.]+)"', sheet.svg)[1])
    assert size * len("EXERCISE") * 0.6 > 0.4 * sheet.frame.width
    assert marks(drawn(replace(found, station_file=None, points=[]))) == []


def test_header_and_footer_cannot_end_their_rule():
    style = paper.style(Paper.named("letter", "landscape"), {"top-left": 'a"; } </style><script> \\'})
    assert "size: 279.4mm 215.9mm" in style
    assert "<" not in style
    assert r'content: "a\22 \3b  \7d  \3c \2f style' in style


@pytest.mark.parametrize("size", ["a4", "letter"])
@pytest.mark.parametrize("name", ["King", "North Complex " * 12, "W" * 120])
def test_header_and_footer_fit_next_to_each_other(found, size, name):
    period = (
        "Wednesday, 17 September 2014 06:00 Pacific Daylight Time to 18 September 2014 06:00 Pacific Time"
    )
    titles = Titles(
        name, "", period, "17 Sep 2014 04:00 PDT", "16 Sep 2014 22:00 PDT (start of the run)", "9 h"
    )
    sheet = Paper.named(size, "portrait")
    style = paper.style(sheet, page._running(found, titles))
    width = {}
    for box, text in re.findall(r'@([a-z]+-[a-z]+) { content: "((?:[^"])*)"; ', style):
        plain = re.sub(r"\\([0-9a-f]+) ", lambda each: chr(int(each[1], 16)), text)
        lines = plain.split("\n")
        assert len(lines) * 1.15 * 6.5 * 25.4 / 72.0 < paper.HEAD
        width[box] = max(map(paper.measure, lines))
    assert width["top-left"] + width["top-right"] < sheet.area[0]
    side = 0.5 * (sheet.area[0] - width["bottom-center"])
    assert max(width["bottom-left"], paper.measure("Page 100 of 100")) < side


def test_what_lies_outside_the_run_is_in_the_legend(found):
    middle = MapFrame.fitted(Box(38.895, -120.605, 38.905, -120.595), (0.0, 0.0, 100.0, 100.0))
    beyond = MapFrame.fitted(Box(38.6, -120.8, 39.2, -120.4), (0.0, 0.0, 100.0, 100.0))
    for frame, outside in ((middle, False), (beyond, True)):
        assert base_map.reaches_outside(found.run, frame) == outside
        assert (sheet_map.OUTSIDE in sheet_map.draw(found, frame, 1.0).legend) == outside
    picture = Image.open(io.BytesIO(base_map.picture(found.run, found.elevation, beyond))).convert("L")
    corner = np.asarray(picture)[:40, -40:]
    assert corner.max() - corner.min() > 30  # hatched


def test_the_age_of_a_forecast(found):
    options = SheetOptions(prepared=PREPARED, issued=datetime(2014, 9, 17, 6, 30, tzinfo=UTC))
    assert Titles.of(found.run, options, "UTC").age == "5.5 h"
    assert (
        Titles.of(found.run, replace(options, prepared=datetime(2014, 9, 29, 6, 30, tzinfo=UTC)), "UTC").age
        == "12 days"
    )
