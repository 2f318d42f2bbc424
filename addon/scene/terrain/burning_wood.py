"""Stumps and logs that burn on behind the front for minutes to hours, at fixed places of burned woods."""

from __future__ import annotations

import math

from ...blender import nodes
from .shading_inputs import GroundInputs

COLOUR = (1.0, 0.27, 0.028)
_CELL = 8.0  # m, cells with at most one piece of wood
_BURNS = 0.45  # fraction of the cells under dense canopy whose wood burns on (by eye)
_CANOPY = 0.1, 1.2  # kg/m2, canopy fuel from which, and up to which, dead wood becomes more frequent
_LASTS = 240.0, 10_800.0  # s, decay time of the glow, to 1/e (assumed; smouldering logs last hours)
_WIDE = 0.10, 0.35  # m, half the width of a piece
_LONG = 9.0  # greatest length over width
_PIXELS = 0.6  # least half-width of a piece in pixels; it is dimmed in proportion
_CLOSE, _DIMMED = (0.02, 0.2), 0.1
"""m, pixel sizes between which single coals blend, and factor on their light close by (by eye)."""
_FADES = 4.0, 8.0  # m, pixel sizes between which pieces blend into patches of embers
_STRENGTH = 2.0  # exponent of the strength in a number uniform in 0..1: a few pieces are bright (by eye)
_LIT = 0.05, 1.5  # light on the ground around a piece over the light of the piece (by eye), and its reach, m


def glow(tree: nodes.Tree, place: GroundInputs) -> nodes.Value:
    """Return the glow of burning wood and of the ground that it lights: 1 at a bright, fresh piece."""
    x, y, _ = tree.separate(place.position)
    inputs = {"Vector": tree.combine(x, y, 0.0), "Scale": 1.0 / _CELL}
    cells = tree.node("ShaderNodeTexVoronoi", inputs, voronoi_dimensions="2D")
    turn, size, chance = tree.separate(tree.pick(cells, "Color"))
    east, north, _ = tree.separate(
        tree.vector("SUBTRACT", tree.combine(x, y, 0.0), tree.pick(cells, "Position"))
    )
    turn = turn * (2.0 * math.pi)
    sine, cosine = tree.math("SINE", turn), tree.math("COSINE", turn)
    along, across = east * cosine + north * sine, north * cosine - east * sine
    wide = size.ramp(0.0, 1.0, *_WIDE)
    long = wide * tree.math("FRACT", size * 13.0).power(2.0).ramp(0.0, 1.0, 1.0, _LONG)
    least = place.pixel * _PIXELS
    drawn_wide, drawn_long = (tree.math("MAXIMUM", each, least) for each in (wide, long))
    long_part, wide_part, area = along / drawn_long, across / drawn_wide, wide * long
    shape = (long_part * long_part + wide_part * wide_part).smoothstep(1.0, 0.3)
    shape = shape * (area / (drawn_wide * drawn_long))
    away = along * along + across * across
    beside = area / (away + area) * (away * (-1.0 / _LIT[1] ** 2)).exp() * _LIT[0]
    often = place.canopy.smoothstep(*_CANOPY) * place.woody * _BURNS
    lasts = tree.math("POWER", _LASTS[1] / _LASTS[0], tree.math("FRACT", chance * 57.0)) * _LASTS[0]
    fading = (tree.math("MAXIMUM", place.age, 0.0) / lasts * -1.0).exp()
    bright = tree.math("FRACT", chance * 911.0).power(_STRENGTH).ramp(0.0, 1.0, 0.1, 1.0)
    coals = place.pixel.ramp(*_CLOSE, place.duff.smoothstep(-0.15, 0.25) * _DIMMED, 1.0)
    shown = (shape * coals + beside) * (bright * fading) * (chance < often)
    return shown * place.pixel.ramp(*_FADES, 1.0, 0.0)
