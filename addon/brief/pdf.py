"""Page and map sheet as PDF, through a browser of this machine or WeasyPrint, and as GeoPDF through GDAL."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from .. import extras, output
from ..errors import UsageError
from .map_sheet import MapSheet

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
"""Programs that print a page without a window."""
_PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
_SECONDS = 300  # time limit of a browser
_DPI = 200  # of the map sheet as a picture
_CSS_DPI = 96.0
_INCH = 25.4  # mm


def find_browser() -> str | None:
    """Find a browser for `BROWSERS`; None without one."""
    found = (shutil.which(name) for name in BROWSERS)
    return next((each for each in (*found, *filter(os.path.isfile, _PLACES)) if each), None)


def check(pdf: Path | None, geopdf: Path | None) -> None:
    """Check before the work that the requested files can be written.

    Raises
    ------
    UsageError
        A name does not end in .pdf, or a program is missing.
    """
    for option, path in (("--pdf", pdf), ("--geopdf", geopdf)):
        if path and path.suffix.lower() != ".pdf":
            raise UsageError(f"{option}: {path} does not end in .pdf; name a .pdf file")
    browser = find_browser()
    if pdf and not browser and importlib.util.find_spec("weasyprint") is None:
        raise UsageError(
            "--pdf: there is neither Chromium, Chrome or Edge nor WeasyPrint; install one "
            f"({extras.install_packages('weasyprint')}), or print the page from a browser"
        )
    if geopdf and not browser:
        raise UsageError("--geopdf: there is no Chromium, Chrome or Edge to draw the sheet; install one")
    if geopdf and not _has_driver():
        raise UsageError(
            f"--geopdf: GDAL with its PDF driver is missing; install it: {extras.install('raster')}"
        )


def write(page: Path, path: Path, overwrite: bool = False) -> None:
    """Print a page to a PDF.

    Raises
    ------
    UsageError
        The browser fails.
    """
    if browser := find_browser():
        output.write(
            path,
            lambda part: _browse(browser, page, part, "--no-pdf-header-footer", f"--print-to-pdf={part}"),
            overwrite,
        )
        return
    import weasyprint

    output.write(path, lambda part: weasyprint.HTML(filename=str(page)).write_pdf(str(part)), overwrite)


def write_geopdf(sheet: MapSheet, title: str, author: str, path: Path, overwrite: bool = False) -> None:
    """Write the map sheet as a picture in a PDF with coordinates.

    Raises
    ------
    UsageError
        The browser fails.
    """
    browser = find_browser()
    assert browser is not None
    width, height = (round(side / _INCH * _CSS_DPI) for side in sheet.paper.area)
    with tempfile.TemporaryDirectory() as folder:
        page, picture = Path(folder) / "sheet.html", Path(folder) / "sheet.png"
        style = "html, body { margin: 0 } svg { display: block; width: 100vw; height: 100vh }"
        drawn = sheet.svg.replace("<svg ", '<svg preserveAspectRatio="none" ', 1)
        page.write_text(
            f"<!DOCTYPE html><meta charset='utf-8'><style>{style}</style>{drawn}", encoding="utf-8"
        )
        scale = _DPI / _CSS_DPI
        options = (f"--window-size={width},{height}", f"--force-device-scale-factor={scale:.6f}")
        _browse(browser, page, picture, "--hide-scrollbars", *options, f"--screenshot={picture}")
        georeference(picture, sheet, title, author, path, overwrite)


def georeference(
    picture: Path, sheet: MapSheet, title: str, author: str, path: Path, overwrite: bool = False
) -> None:
    """Write a picture of the sheet as a GeoPDF (ISO 32000); the neat line is the frame of the map."""
    import numpy as np
    import rasterio
    import rasterio.shutil
    from PIL import Image

    pixels = np.asarray(Image.open(picture).convert("RGB"))
    rows, columns = pixels.shape[:2]
    frame = sheet.frame
    across, down = (
        side * frame.metres / count for side, count in zip(sheet.paper.area, (columns, rows), strict=True)
    )
    west, north = frame.west - frame.left * frame.metres, frame.north + frame.top * frame.metres
    transform = rasterio.Affine(across, 0.0, west, 0.0, -down, north)
    corners = (
        (frame.west, frame.north),
        (frame.east, frame.north),
        (frame.east, frame.south),
        (frame.west, frame.south),
    )
    ring = ", ".join(f"{east:.3f} {up:.3f}" for east, up in (*corners, corners[0]))
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "sheet.tif"
        profile = {"driver": "GTiff", "count": 3, "dtype": "uint8", "width": columns, "height": rows}
        with rasterio.open(plain, "w", crs=f"EPSG:{frame.zone.epsg}", transform=transform, **profile) as made:
            made.write(np.moveaxis(pixels, -1, 0))
            made.update_tags(
                TITLE=title, AUTHOR=author, CREATOR="Firetwin"
            )  # rasterio writes options in capitals
        options = {"dpi": round(columns / sheet.paper.area[0] * _INCH), "neatline": f"POLYGON(({ring}))"}

        def put(part: Path) -> None:
            rasterio.shutil.copy(
                str(plain),
                str(part),
                driver="PDF",
                geo_encoding="ISO32000",
                compress="DEFLATE",
                **options,
            )

        output.write(path, put, overwrite)


def _has_driver() -> bool:
    """Check whether rasterio's GDAL writes PDF."""
    try:
        from rasterio.env import Env
    except ImportError:
        return False
    with Env() as gdal:
        return "PDF" in gdal.drivers()


def _browse(browser: str, page: Path, pdf_file: Path, *options: str) -> None:
    """Run a browser without a window or a network, and with an empty profile."""
    with tempfile.TemporaryDirectory() as profile:
        common = [
            "--headless",
            "--disable-gpu",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--user-data-dir={profile}",
        ]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            common.append("--no-sandbox")  # Chromium refuses to run its sandbox as root
        command = [browser, *common, *options, page.resolve().as_uri()]
        try:
            done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
        except subprocess.TimeoutExpired:
            raise UsageError(
                f"{browser} does not finish in {_SECONDS} s; print the page from a browser"
            ) from None
    if done.returncode or not pdf_file.is_file():
        words = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["no message"]
        raise UsageError(f"{browser} wrote no file: {words[0]}; print the page from a browser")
