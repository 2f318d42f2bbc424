"""What infrared flights map inside of a fire: the class of a feature, from what its file says.

Classes and their names are those of the layers "IR Polygon" and "IR Point" of the National Interagency Fire
Center (services.arcgis.com/V6ZHFr6zdgNZuVG0, NIFC/FeatureServer/7 and /3, field FeatureCategory, after the
NWCG's standard for incidents, GSTOP): "IR Heat Perimeter", "IR Intense Heat", "IR Scattered Heat", "IR
Isolated Heat Source", "Possible IR Heat Source", "Area Covered by IR Flight" and "Cloud Cover". NIROPS of the
USDA Forest Service gives KMZ and vector files of "areas of intense, scattered, and isolated heat"; in a KMZ
the names of folders or placemarks say the class, in shapefiles FeatureCat (names have ten letters there) or
the file's own name.
"""

from __future__ import annotations

import re
from pathlib import Path

from .feature import Feature

PERIMETER, NOTHING = "perimeter", "nothing"
KINDS = ("intense", "scattered", "isolated", "possible")
"""Of heat, the strongest first."""

_KEYS = ("featurecategory", "featurecat", "feature_ca", "heat_type", "heattype", "category", "class", "type")
_PLACES = ("folder", "layer", "name")
_WORDS = (
    ("nothing", r"covered|cloud|no[ _-]*data|obscured|flight[ _-]*(area|path|line|box)"),
    ("possible", r"possible"),
    ("isolated", r"isolated"),
    ("scattered", r"scattered"),
    ("intense", r"intense"),
    ("perimeter", r"perim"),
)
_GATE = r"heat|(^|[^a-z])ir([^a-z]|$)|cloud[ _-]*cover|no[ _-]*data"


def kind(path: Path, feature: Feature) -> str:
    """One of `KINDS`, `PERIMETER`, `NOTHING` (no heat), or "" of what nothing says a class of.

    Properties that hold a class are asked first, then the names of a feature, its layer and folders, in which
    the word must stand with "heat" or "IR", and at last the file's.
    """
    known = {name.lower(): str(value) for name, value in feature.properties.items() if value is not None}
    for name in _KEYS:
        if found := _kind(known.get(name, "")):
            return found
    for text in [*(known.get(name, "") for name in reversed(_PLACES)), path.stem]:
        if re.search(_GATE, text.lower()) and (found := _kind(text)):
            return found
    words = re.split(r"[^a-z]+", path.stem.lower())
    return next((each for each in KINDS if each in words), "")


def _kind(text: str) -> str:
    return next((name for name, words in _WORDS if re.search(words, text.lower())), "")
