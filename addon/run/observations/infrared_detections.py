"""Infrared heat classes: class of a feature that an infrared flight mapped.

Classes and names follow the layers "IR Polygon" and "IR Point" of the National Interagency Fire Center
(services.arcgis.com/V6ZHFr6zdgNZuVG0, NIFC/FeatureServer/7 and /3, field FeatureCategory, after the NWCG's
standard for incidents, GSTOP): "IR Heat Perimeter", "IR Intense Heat", "IR Scattered Heat", "IR Isolated Heat
Source", "Possible IR Heat Source", "Area Covered by IR Flight" and "Cloud Cover". NIROPS of the USDA Forest
Service publishes KMZ and vector files of "areas of intense, scattered, and isolated heat". In a KMZ the class
is in the names of folders or placemarks. In shapefiles it is in FeatureCat (names have ten letters there) or
in the file's name.
"""

from __future__ import annotations

import re
from pathlib import Path

from .feature import Feature

PERIMETER, NOTHING = "perimeter", "nothing"
KINDS = ("intense", "scattered", "isolated", "possible")
"""Classes of heat, the most intense first."""

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
    """Classify a feature: one of `KINDS`, `PERIMETER`, `NOTHING` (no heat), or "" if unclassified.

    Class properties come first. Then come the names of the feature, its layer and folders, in which the word
    must occur with "heat" or "IR". The file's name comes last.
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
