"""Switches and legends of map layers, and a static map for print."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .briefing import Briefing
from .fronts import Front
from .layers import Layer, Legend
from .mercator import Box
from .text import data_uri, quote

_WIDTH = 1000  # width of the static drawing
_STILL_FRONTS = 6
_NAME, _NAMES_APART = 260, 30  # space of a name in the drawing


def bounds(layers: Sequence[Layer]) -> Box:
    """Return the bounding box of all layers."""
    box = layers[0].box
    for layer in layers[1:]:
        box = box.joined(layer.box)
    return box


def view(fronts: Sequence[Front], whole: Box) -> Box:
    """Choose the initial view: the fronts with a margin, at least an eighth of the box of the run."""
    lines = [line for front in fronts for line in front.lines]
    if not lines:
        return whole
    corners = np.concatenate(lines)
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    sides = []
    for low, high, least, most in (
        (south, north, whole.south, whole.north),
        (west, east, whole.west, whole.east),
    ):
        margin = max(0.06 * (high - low), ((most - least) / 8.0 - (high - low)) / 2.0)
        sides.append((max(float(low - margin), least), min(float(high + margin), most)))
    return Box(sides[0][0], sides[1][0], sides[0][1], sides[1][1])


def switches(briefing: Briefing) -> str:
    """Build switch, opacity and legend of each layer, topmost first."""
    made = [_drawn("front", "Front at this time", '<i style="background:#ff3b14"></i>burned by this time')]
    if briefing.observed:
        key = '<i style="background:#0b4fa8"></i>latest perimeter up to this time'
        made.append(_drawn("observed", "Observed perimeters", key))
    made += [_switch(layer) for layer in reversed(briefing.layers)]
    return "\n".join(made)


def _drawn(name: str, title: str, key: str) -> str:
    return (
        f'<div class="layer" data-layer="{name}"><label><input type="checkbox" checked>{title}</label>'
        f'<div class="legend note">{key}</div></div>'
    )


def _switch(layer: Layer) -> str:
    checked, off = (" checked", "") if layer.shown else ("", " off")
    title = quote(layer.title)
    opacity = (
        f'<label class="opacity">opacity <input type="range" min="0" max="100" '
        f'value="{100 * layer.opacity:.0f}" aria-label="Opacity of: {title}"></label>'
    )
    return (
        f'<div class="layer{off}" data-layer="{layer.name}">'
        f'<label><input type="checkbox"{checked}>{title}</label>{opacity}{_legend(layer.legend)}</div>'
    )


def _legend(legend: Legend | None) -> str:
    if legend is None:
        return ""
    share = 100.0 / len(legend.colours)
    stops = ", ".join(
        f"{colour} {k * share:.2f}% {(k + 1) * share:.2f}%" for k, colour in enumerate(legend.colours)
    )
    ticks = "".join(f'<span style="left:{100 * at:g}%">{quote(text)}</span>' for at, text in legend.ticks)
    notes = "".join(
        f'<div class="note"><i style="background:{colour}"></i>{quote(text)}</div>'
        for colour, text in legend.notes
    )
    return (
        f'<div class="legend">{quote(legend.title)}'
        f'<div class="ramp" style="background:linear-gradient(to right, {stops})"></div>'
        f'<div class="ticks">{ticks}</div>{notes}</div>'
    )


def still(briefing: Briefing) -> str:
    """Build the static map without scripts: pictures of all layers, some fronts, and places.

    The interactive map uses the same pictures, so that the page contains each of them once.
    """
    box = bounds(briefing.layers)
    wide, high = box.metres
    height = _WIDTH * high / wide
    pictures = "".join(_picture(layer, box) for layer in briefing.layers)
    drawing = "".join((*_fronts(briefing.fronts, box, height), *_places(briefing, box, height)))
    last = briefing.moments[-1]
    return (
        '<figure class="static-map"><div class="sheet" '
        f'style="aspect-ratio:{wide:.0f}/{high:.0f}">{pictures}'
        f'<svg viewBox="0 0 {_WIDTH} {height:.0f}" role="img" aria-label="Map of the fire">{drawing}</svg>'
        f"</div><figcaption>Fire arrival time over hill shading. Lines: fronts; bold: "
        f"{quote(last)}. Filled marks: burned by this time. Web Mercator, north is up.</figcaption></figure>"
    )


def _picture(layer: Layer, box: Box) -> str:
    (left, right), (bottom, top) = box.share(
        [layer.box.south, layer.box.north], [layer.box.west, layer.box.east]
    )
    place = (
        f"left:{100 * left:.3f}%;top:{100 * top:.3f}%;"
        f"width:{100 * (right - left):.3f}%;height:{100 * (bottom - top):.3f}%"
    )
    hidden = "" if layer.shown else ";display:none"
    return (
        f'<img data-layer="{layer.name}" alt="{quote(layer.title)}" '
        f'style="{place};opacity:{layer.opacity:g}{hidden}" src="{data_uri("image/png", layer.png)}">'
    )


def _fronts(fronts: Sequence[Front], box: Box, height: float) -> Iterator[str]:
    chosen = np.unique(np.linspace(0, len(fronts) - 1, _STILL_FRONTS).round().astype(int))
    for index in chosen:
        path = "".join(_path(line, box, height) for line in fronts[index].lines)
        bold = index == len(fronts) - 1
        width = 2.4 if bold else 0.8
        yield f'<path d="{path}" fill="none" stroke="#3a0a02" stroke-width="{width}" opacity="0.85"/>'


def _path(line: np.ndarray, box: Box, height: float) -> str:
    x, y = box.share(line[:, 1], line[:, 0])
    points = np.round(np.column_stack([x * _WIDTH, y * height]), 1)
    kept = points[np.r_[True, np.any(np.diff(points, axis=0) != 0.0, axis=1)]]
    return "M" + " ".join(f"{a:g},{b:g}" for a, b in kept) + "Z" if len(kept) > 2 else ""


def _places(briefing: Briefing, box: Box, height: float) -> Iterator[str]:
    """Draw marks of towns and stations, with names if there is space."""
    taken: list[tuple[float, float]] = []
    for place in briefing.points:
        x, y = box.share(place.latitude, place.longitude)
        if not (0.0 < x < 1.0 and 0.0 < y < 1.0):
            continue
        left, top = float(x) * _WIDTH, float(y) * height
        fill = "#e02b12" if place.reached.state in ("before", "reached") else "#ffffff"
        size = 6 if place.kind == "station" else 4
        spot = f'cx="{left:.1f}" cy="{top:.1f}" r="{size}"'
        yield f'<circle {spot} fill="{fill}" stroke="#111" stroke-width="2"/>'
        if all(abs(top - b) > _NAMES_APART or abs(left - a) > _NAME for a, b in taken):
            taken.append((left, top))
            aside, anchor = (-10, "end") if left > _WIDTH - _NAME else (10, "start")
            at = f'x="{left + aside:.1f}" y="{top + 5:.1f}" text-anchor="{anchor}"'
            yield f"<text {at}>{quote(place.name)}</text>"
