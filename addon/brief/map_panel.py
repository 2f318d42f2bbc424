"""Switches, legends and pictures of map layers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..html_text import data_uri, quote
from ..imaging import map_symbols
from ..run.fronts import Front
from . import context_layer
from .briefing import Briefing
from .context import Context
from .layers import Layer, Legend
from .mercator import Box

FRONT_EDGE, FRONT_FILL = map_symbols.FIRE_EDGE, "#ff3b14"
"""Colours of the front: on the map, on the sheet and in their legends."""


def bounds(layers: Sequence[Layer]) -> Box:
    """Return the bounding box of all layers."""
    box = layers[0].box
    for layer in layers[1:]:
        box = box.joined(layer.box)
    return box


def view(fronts: Sequence[Front], whole: Box) -> Box:
    """Choose the initial view: the fronts with a margin, at least an eighth of the box of the run."""
    box = around(fronts, whole, margin=0.06, parts=8.0)
    return Box(
        max(box.south, whole.south),
        max(box.west, whole.west),
        min(box.north, whole.north),
        min(box.east, whole.east),
    )


def around(fronts: Sequence[Front], whole: Box, margin: float, parts: float) -> Box:
    """Return the box of the fronts with a margin; the whole box without fronts.

    Parameters
    ----------
    margin
        Width of the margin on each side, as a share of the fronts' size.
    parts
        The result is at least this part of the whole box: 8 is an eighth.
    """
    lines = [line for front in fronts for line in front.lines]
    if not lines:
        return whole
    corners = np.concatenate(lines)
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    sides = []
    for low, high, size in (
        (south, north, whole.north - whole.south),
        (west, east, whole.east - whole.west),
    ):
        wider = max(margin * (high - low), (size / parts - (high - low)) / 2.0)
        sides.append((float(low - wider), float(high + wider)))
    return Box(sides[0][0], sides[1][0], sides[0][1], sides[1][1])


def switches(briefing: Briefing) -> str:
    """Build switch, opacity and legend of each layer, topmost first."""
    filled = f'<i style="background:{FRONT_FILL}66;border:2px solid {FRONT_EDGE}"></i>burned by this time'
    controls = [_drawn("front", "Front at this time", filled)]
    if briefing.observed:
        colour = map_symbols.LINES["Observed Perimeter"].colour
        key = f'<i style="border:2px dashed {colour}"></i>latest perimeter up to this time'
        controls.append(_drawn("observed", "Observed perimeters", key))
    controls += [
        _drawn(context_layer.name(number), quote(each.title), _styles(each), quote(each.file))
        for number, each in reversed(list(enumerate(briefing.context)))
    ]
    controls += [_switch(layer) for layer in reversed(briefing.layers)]
    return "\n".join(controls)


def _styles(each: Context) -> str:
    """Build the rows of the legend of a context file."""
    return "".join(f"<div>{drawn}{quote(text)}</div>" for text, drawn in context_layer.key(each))


def _drawn(name: str, title: str, key: str, file: str = "") -> str:
    title += f" <small>{file}</small>" if file else ""
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


def pictures(briefing: Briefing) -> str:
    """Build the hidden pictures of all layers, which the script shows on the map."""
    made = (
        f'<img data-layer="{layer.name}" alt="{quote(layer.title)}" src="{data_uri("image/png", layer.png)}">'
        for layer in briefing.layers
    )
    return f'<div id="pictures" hidden>{"".join(made)}</div>'
