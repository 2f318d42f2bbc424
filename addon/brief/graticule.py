"""Grid lines of the map sheet with labels at its edges: degrees, or the US National Grid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .map_frame import MapFrame
from .sheet_options import Grid

_MINUTES = (0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0)
_METRES = (500.0, 1000.0, 2000.0, 5000.0, 10_000.0, 20_000.0, 50_000.0, 100_000.0)
_APART = 28.0  # mm, least distance of lines
_SAMPLES = 33  # points of a curved line
SPACE = 4.5
"""Space for labels around the frame, mm."""

Array = NDArray[np.float64]


def svg(frame: MapFrame, grid: Grid, size: float) -> Iterator[str]:
    """Draw lines within the frame and labels of `size` mm around it."""
    if grid == "latlong":
        yield from _degrees(frame, size)
    elif grid == "usng":
        yield from _usng(frame, size)


def interval(frame: MapFrame, grid: Grid) -> str:
    """Describe the interval of the lines: ``10 minutes``, ``5 km``."""
    if grid == "latlong":
        return f"every {_minutes(frame):g} minutes of latitude and longitude"
    return f"every {_metres(frame) / 1000.0:g} km" if grid == "usng" else "none"


def squares(frame: MapFrame) -> list[str]:
    """Name the 100 km squares of the US National Grid that the frame shows."""
    found = {
        frame.zone.square(east, north)
        for north in _steps(frame.south, frame.north, 100_000.0)
        for east in _steps(frame.west, frame.east, 100_000.0)
    }
    return sorted(found - {""})


def _steps(low: float, high: float, step: float) -> list[float]:
    """List a point in each square of a grid between two bounds."""
    lines = np.arange(np.floor(low / step) * step, high, step)
    return [float(max(each, low)) + 1e-3 for each in lines]


def _minutes(frame: MapFrame) -> float:
    least = _APART * frame.metres / 1852.0  # a minute of latitude
    return next((each for each in _MINUTES if each >= least), _MINUTES[-1])


def _metres(frame: MapFrame) -> float:
    least = 0.7 * _APART * frame.metres
    return next((each for each in _METRES if each >= least), _METRES[-1])


def _degrees(frame: MapFrame, size: float) -> Iterator[str]:
    step = _minutes(frame) / 60.0
    latitude, longitude = frame.pixels(9)
    share = np.linspace(-0.05, 1.05, _SAMPLES)
    south, north, west, east = latitude.min(), latitude.max(), longitude.min(), longitude.max()
    margin = step  # pixels' centres lie within the frame
    for value in np.arange(np.floor(south / step) * step, north + margin, step):
        line = frame.place(np.full(_SAMPLES, value), west + share * (east - west))
        yield from _line(frame, line, minutes(value, "NS"), size, upright=False)
    for value in np.arange(np.floor(west / step) * step, east + margin, step):
        line = frame.place(south + share * (north - south), np.full(_SAMPLES, value))
        yield from _line(frame, line, minutes(value, "EW"), size, upright=True)


def _usng(frame: MapFrame, size: float) -> Iterator[str]:
    step = _metres(frame)
    for value in np.arange(np.ceil(frame.south / step) * step, frame.north, step):
        line = frame.to_sheet(np.array([frame.west, frame.east]), np.full(2, value))
        yield from _line(frame, line, _principal(value, step), size, upright=False, bold=value % 1e5 == 0.0)
    for value in np.arange(np.ceil(frame.west / step) * step, frame.east, step):
        line = frame.to_sheet(np.full(2, value), np.array([frame.south, frame.north]))
        yield from _line(frame, line, _principal(value, step), size, upright=True, bold=value % 1e5 == 0.0)


def _principal(value: float, step: float) -> str:
    """Format the digits of a grid line within its 100 km square: ``85`` for 685,000 m."""
    within = value % 100_000.0 / 1000.0
    return f"{within:04.1f}" if step < 1000.0 else f"{within:02.0f}"


def minutes(value: float, signs: str) -> str:
    """Format degrees with decimal minutes, as the standard asks: ``38° 45.0′ N``."""
    value = (value + 180.0) % 360.0 - 180.0 if signs == "EW" else value
    tenths = round(abs(value) * 600.0)
    return f"{tenths // 600}° {tenths % 600 / 10:04.1f}′ {signs[0] if value >= 0.0 else signs[1]}"


def _line(
    frame: MapFrame, line: tuple[Array, Array], label: str, size: float, upright: bool, bold: bool = False
) -> Iterator[str]:
    """Draw a line, and labels where it crosses two opposite edges: top and bottom if it is upright."""
    x, y = line
    points = " ".join(f"{a:.2f},{b:.2f}" for a, b in zip(x, y, strict=True))
    width = 0.35 if bold else 0.12
    yield f'<polyline points="{points}" fill="none" stroke="#123a5c" stroke-width="{width}" opacity="0.75"/>'
    along, across = (y, x) if upright else (x, y)
    low, high = (frame.top, frame.top + frame.height) if upright else (frame.left, frame.left + frame.width)
    first, last = (frame.left, frame.left + frame.width) if upright else (frame.top, frame.top + frame.height)
    order = np.argsort(along)
    for edge, side in ((low, -1.0), (high, 1.0)):
        at, half = float(np.interp(edge, along[order], across[order])), 0.3 * size * len(label)
        if first + half <= at <= last - half:  # no labels across a corner, where two would overlap
            yield _label(at, edge, side, label, size, upright)


def _label(at: float, edge: float, side: float, text: str, size: float, upright: bool) -> str:
    away = edge + side * (0.9 if side < 0 else 0.9 + 0.75 * size)
    x, y = (at, away) if upright else (away, at)
    turn = "" if upright else f' transform="rotate(-90 {x:.2f} {y:.2f})"'
    return (
        f'<text class="graticule" x="{x:.2f}" y="{y:.2f}" font-size="{size:.2f}" text-anchor="middle"{turn}>'
        f"{text}</text>"
    )
