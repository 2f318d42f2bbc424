"""Layers of the interactive map with the features of context files, in the styles of the sheet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..imaging import map_symbols
from ..run import areas
from ..run.observations import Feature
from . import context, sheet_map
from .context import Context
from .mercator import Box

_PIXELS = 3.8  # pixels of the map for 1 mm of the sheet: 96 dpi
_LEAST = 0.5  # mm, width of a line that consists of marks on the sheet
_DIGITS = 5  # of degrees, 1 m

Array = NDArray[np.float64]


def name(number: int) -> str:
    """Name the layer of a context file."""
    return f"context-{number}"


def layers(found: Sequence[Context], around: Box) -> dict[str, list[dict[str, Any]]]:
    """Convert context files to features for the script of the page; those outside of a box are omitted."""
    return {
        name(number): [made for feature in each.features if (made := _feature(each, feature, around))]
        for number, each in enumerate(found)
    }


def drawings(found: Sequence[Context]) -> dict[str, str]:
    """Return the drawings of the point symbols in use."""
    used = {context.point_symbol(each, one) for each in found for one in each.features if len(one.points)}
    return {symbol: map_symbols.POINTS[symbol] for symbol in sorted(used)}


def key(each: Context) -> Iterator[tuple[str, str]]:
    """List text and drawing (SVG) of the styles of a file."""
    seen = {}
    for feature in each.features:
        if feature.lines or feature.polygons:
            style = context.line_style(each, feature)
            ends = np.array([[-4.0, 0.0], [4.0, 0.0]])
            seen[style] = "".join(map_symbols.line(map_symbols.LINES[style], ends, False, 1.0))
        if len(feature.points):
            symbol = context.point_symbol(each, feature)
            seen[symbol] = map_symbols.point(symbol, 0.0, 0.0, 1.6)
    for style, drawn in seen.items():
        svg = f'<svg viewBox="-4.5 -2.1 9 4.2" width="36" height="17" aria-hidden="true">{drawn}</svg>'
        yield context.style_title(each, style), svg


def _feature(each: Context, feature: Feature, around: Box) -> dict[str, Any] | None:
    middle = 0.5 * (around.west + around.east)
    lines = [_turned(line, middle) for line in feature.lines if len(line) > 1]
    polygons = [[_turned(ring, middle) for ring in polygon] for polygon in feature.polygons]
    points = _turned(feature.points, middle)
    parts = [*lines, *(polygon[0] for polygon in polygons), points]
    if not any(_overlaps(part, around) for part in parts):
        return None
    style, symbol = context.line_style(each, feature), context.point_symbol(each, feature)
    kind = symbol if len(points) else style
    style_ = map_symbols.LINES[style]
    return {
        "text": ": ".join(
            dict.fromkeys(filter(None, (context.style_title(each, kind), context.label(feature))))
        ),
        "lines": [_latlong(line) for line in lines],
        "polygons": [[_latlong(ring) for ring in polygon] for polygon in polygons],
        "points": _latlong(points),
        "symbol": symbol,
        "colour": style_.colour,
        "weight": round((style_.width or _LEAST) * _PIXELS, 1),
        "dashes": " ".join(f"{float(part) * _PIXELS:.0f}" for part in style_.dashes.split()),
        "casing": style_.casing,
        "fill": sheet_map.fill(style),
    }


def _turned(points: Array, middle: float) -> Array:
    if not len(points):
        return points
    return np.column_stack([areas.turned(points[:, 0], middle), points[:, 1]])


def _overlaps(points: Array, around: Box) -> bool:
    if not len(points):
        return False
    (west, south), (east, north) = points.min(axis=0), points.max(axis=0)
    return bool(
        west <= around.east and east >= around.west and south <= around.north and north >= around.south
    )


def _latlong(points: Array) -> list[list[float]]:
    return np.round(points[:, ::-1], _DIGITS).tolist()
