"""Kinds of mapped land: layer, colours and width of each, and the tags of OpenStreetMap that name it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .land_drawing import CROP, MOWN, PLOUGHED, STUBBLE

LAYERS = ("soft", "hard", "water")
"""Layers from bottom to top: burnable land, unburnable land, water. Each becomes a picture."""

SOLID = 0.8  # colour strength from which no plant grows there


@dataclass(frozen=True)
class LandUseKind:
    """A kind of feature. Colours (sRGB, 0..1) and widths are by eye.

    Attributes
    ----------
    layer
        One of `LAYERS`.
    colours
        Palette; each feature takes one of them.
    width
        Width of a line, m.
    strength
        Opacity of the colour. Below `SOLID` trees and bushes may stand there.
    patterns
        Pattern of the field for each colour, of `land_drawing`; none: plain.
    """

    layer: str
    colours: tuple[tuple[float, float, float], ...]
    width: float = 3.0
    strength: float = 1.0
    patterns: tuple[str, ...] = ()


KINDS = {  # from bottom to top
    "meadow": LandUseKind(
        "soft",
        ((0.30, 0.34, 0.18), (0.35, 0.35, 0.20), (0.27, 0.33, 0.16)),
        strength=0.75,
        patterns=(MOWN,) * 3,
    ),
    "plantation": LandUseKind("soft", ((0.24, 0.20, 0.13),), strength=0.35),
    "field": LandUseKind(
        "soft",
        ((0.52, 0.46, 0.30), (0.27, 0.30, 0.17), (0.34, 0.28, 0.20), (0.47, 0.42, 0.26), (0.25, 0.285, 0.16)),
        patterns=(STUBBLE, CROP, PLOUGHED, STUBBLE, CROP),
    ),
    "hedge": LandUseKind("soft", ((0.19, 0.23, 0.11), (0.17, 0.20, 0.11)), 3.5, 0.78),
    "bare": LandUseKind("hard", ((0.43, 0.39, 0.33), (0.39, 0.35, 0.30))),
    "water": LandUseKind("water", ((0.10, 0.16, 0.17),), 4.0),
    "track": LandUseKind("hard", ((0.44, 0.38, 0.30),), 3.0),
    "road": LandUseKind("hard", ((0.27, 0.27, 0.28),), 7.0),
    "building": LandUseKind("hard", ((0.33, 0.31, 0.29),), 6.0),
}

_TRACKS = ("track", "path", "footway", "bridleway", "cycleway", "steps", "pedestrian")
_WORDS = {
    "barrier": {"hedge": "hedge"},
    "waterway": {"": "water"},
    "natural": {
        "water": "water",
        "wetland": "meadow",
        "sand": "bare",
        "scree": "bare",
        "grassland": "meadow",
        "tree_row": "hedge",
    },
    "landuse": {
        **dict.fromkeys(("farmland", "orchard", "vineyard", "allotments"), "field"),
        **dict.fromkeys(("meadow", "grass", "pasture", "village_green", "recreation_ground"), "meadow"),
        **dict.fromkeys(("reservoir", "basin"), "water"),
        **dict.fromkeys(("quarry", "construction", "landfill", "brownfield"), "bare"),
    },
}
WIDTHS = {  # m, by highway or waterway
    **{"motorway": 14.0, "trunk": 11.0, "primary": 9.0, "secondary": 8.0, "service": 4.0, "path": 1.5},
    **{
        "footway": 1.5,
        "cycleway": 2.5,
        "river": 14.0,
        "canal": 8.0,
        "stream": 2.5,
        "ditch": 1.5,
        "drain": 1.5,
    },
}


def kind_of(properties: Mapping[str, Any]) -> str | None:
    """Kind of a feature (of `KINDS`) by its tags; None if it has none of them."""
    words = {str(key).lower(): str(value).lower() for key, value in properties.items() if value is not None}
    if (own := words.get("kind", "")) in KINDS:
        return own
    if words.get("building", "no") not in ("no", ""):
        return "building"
    if words.get("plantation", "no") not in ("no", ""):
        return "plantation"
    if highway := words.get("highway"):
        return "track" if highway in _TRACKS else "road"
    for key, known in _WORDS.items():
        if key in words:
            return known.get(words[key], known.get(""))
    return None
