"""PDF and GeoPDF: programs, errors, and coordinates in the file."""

import json
import re
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pyproj
import pytest
from firetwin.brief import pdf
from firetwin.brief.map_frame import MapFrame
from firetwin.brief.map_sheet import MapSheet
from firetwin.brief.mercator import Box
from firetwin.brief.paper import Paper
from firetwin.ellipsoid import metres_per_degree
from firetwin.errors import UsageError
from PIL import Image

FRAME = MapFrame.fitted(Box(38.7, -120.7, 39.1, -120.2), (5.0, 5.0, 200.0, 150.0))


def test_a_missing_program_is_one_clear_error(monkeypatch, tmp_path):
    monkeypatch.setattr(pdf, "find_browser", lambda: None)
    monkeypatch.setattr(pdf.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(UsageError, match=r"--pdf: there is neither Chromium, .* nor WeasyPrint; install one"):
        pdf.check(tmp_path / "a.pdf", None)
    with pytest.raises(UsageError, match="--geopdf: there is no Chromium"):
        pdf.check(None, tmp_path / "a.pdf")
    monkeypatch.setattr(pdf, "find_browser", lambda: "chromium")
    monkeypatch.setattr(pdf, "_has_driver", lambda: False)
    with pytest.raises(UsageError, match="--geopdf: GDAL with its PDF driver is missing"):
        pdf.check(None, tmp_path / "a.pdf")
    with pytest.raises(UsageError, match=r"--pdf: .*a.html does not end in .pdf"):
        pdf.check(tmp_path / "a.html", None)
    pdf.check(tmp_path / "a.pdf", None)


def test_a_browser_that_fails_is_one_clear_error(monkeypatch, tmp_path):
    monkeypatch.setattr(pdf, "find_browser", lambda: "chromium")
    failed = SimpleNamespace(returncode=1, stderr=b"first\nlast words\n")
    monkeypatch.setattr(pdf.subprocess, "run", lambda *_, **__: failed)
    with pytest.raises(UsageError, match="chromium wrote no file: last words; print the page from a browser"):
        pdf.write(tmp_path / "page.html", tmp_path / "page.pdf")
    assert not (tmp_path / "page.pdf").exists()


@pytest.mark.skipif(not pdf._has_driver(), reason="GDAL has no PDF driver: pip install rasterio")
def test_corners_of_a_geopdf_are_exact_to_a_metre(tmp_path):
    sheet = MapSheet(Paper.named("a4", "landscape"), FRAME, "")
    width, height = sheet.paper.area
    Image.new("RGB", (round(10 * width), round(10 * height)), "white").save(tmp_path / "sheet.png")
    pdf.georeference(tmp_path / "sheet.png", sheet, "Title", "Author", tmp_path / "map.pdf")
    content = (tmp_path / "map.pdf").read_bytes()
    numbers = lambda key: np.array(re.search(rf"/{key} \[ ([^\]]*) \]".encode(), content)[1].split(), float)  # noqa: E731
    assert b"/EPSG 32610" in content
    found = {tuple(each) for each in numbers("GPTS").reshape(-1, 2)}
    east, north = [FRAME.west, FRAME.west, FRAME.east, FRAME.east], [FRAME.north, FRAME.south] * 2
    degree = metres_per_degree(38.9)
    for latitude, longitude in np.column_stack(FRAME.zone.inverse(east, north)):
        away = [np.hypot((a - latitude) * degree[0], (b - longitude) * degree[1]) for a, b in found]
        assert min(away) < 1.0
    points = numbers("BBox") / 72.0 * 25.4  # mm from the lower left corner
    box = [FRAME.left, height - FRAME.top - FRAME.height, FRAME.left + FRAME.width, height - FRAME.top]
    assert sorted(points) == pytest.approx(sorted(box), abs=0.1)


def _reads_geopdf():
    """Check whether the program gdalinfo is there and reads PDF."""
    if not (shutil.which("gdalinfo") and pdf._has_driver()):
        return False
    listed = subprocess.run(["gdalinfo", "--formats"], capture_output=True, text=True, check=True).stdout
    return "PDF -raster" in listed


@pytest.mark.skipif(not _reads_geopdf(), reason="gdalinfo does not read PDF: apt-get install gdal-bin")
def test_gdal_reads_the_frame_of_the_map_from_a_geopdf(tmp_path):
    """Corners and texts as GDAL reports them; the corners of the frame are computed by PROJ."""
    sheet = MapSheet(Paper.named("a4", "landscape"), FRAME, "")
    width, height = sheet.paper.area
    Image.new("RGB", (round(10 * width), round(10 * height)), "white").save(tmp_path / "sheet.png")
    pdf.georeference(tmp_path / "sheet.png", sheet, "King Fire", "A. Author", tmp_path / "map.pdf")
    command = ["gdalinfo", "-json", tmp_path / "map.pdf"]
    told = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    assert told["metadata"][""]["TITLE"] == "King Fire"
    assert told["metadata"][""]["AUTHOR"] == "A. Author"
    ring = re.findall(r"(-?[\d.]+) (-?[\d.]+)", told["metadata"][""]["NEATLINE"])
    there = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32610", always_xy=True)
    corners = {
        (left, top): FRAME.zone.inverse(*at)
        for (left, top), at in {
            (0, 0): (FRAME.west, FRAME.north),
            (1, 0): (FRAME.east, FRAME.north),
            (0, 1): (FRAME.west, FRAME.south),
            (1, 1): (FRAME.east, FRAME.south),
        }.items()
    }
    for latitude, longitude in corners.values():
        east, north = there.transform(float(longitude), float(latitude))
        assert min(np.hypot(float(a) - east, float(b) - north) for a, b in ring) < 1.0  # m
    a, across, _, d, _, down = told["geoTransform"]
    left, top = (sheet.frame.left, sheet.frame.top)
    assert a + left / width * told["size"][0] * across == pytest.approx(FRAME.west, abs=1.0)
    assert d + top / height * told["size"][1] * down == pytest.approx(FRAME.north, abs=1.0)
