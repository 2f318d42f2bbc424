"""Context of the map from files of the user: roads, water, boundaries, evacuation zones, values at risk.

A feature whose property "FeatureCategory" (or "category", "kind", "type") names a symbol of the NWCG standard
has that symbol, whatever the name of its file; so has an export of the National Incident Feature Service.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import UsageError, input_error
from ..imaging import map_symbols
from ..run import observations
from ..run.observations import Detections, Feature

PRIORITY = ("water", "boundaries", "roads", "zones", "values")
"""Names with a known style, lowest first; others are drawn above roads."""
TITLES = {
    "water": "Water",
    "boundaries": "Boundary",
    "roads": "Road",
    "zones": "Evacuation zone",
    "values": "Value at risk",
}
"""Texts of the legend."""
_CATEGORY = ("featurecategory", "category", "kind", "type")
_LABEL = ("label", "name", "zone", "zone_id", "zone_name", "fullname", "ref")
_LONGEST = 40  # characters of a label
NUMBER = "number in the tables of divisions"
"""Property of a resource that a layer of `firetwin allocate` sends to a division."""
_SUFFIXES = (".gpkg", ".geojson", ".json", ".kml", ".kmz", ".shp")


@dataclass(frozen=True)
class Context:
    """Features of a file and the name of their style."""

    name: str
    file: str
    features: tuple[Feature, ...]

    @property
    def style(self) -> str:
        """Style of features without a category: the name, or "other"."""
        return self.name if self.name in PRIORITY else "other"

    @property
    def title(self) -> str:
        """Text in the legend."""
        return TITLES.get(self.name, self.name)

    @property
    def exercise(self) -> bool:
        """True if a feature has the property "exercise" of `firetwin allocate`, or the origin "exercise"."""
        return any(_is_exercise(feature) for feature in self.features)


def read(named: Sequence[tuple[str, Path]]) -> list[Context]:
    """Read files in the order in which they are drawn.

    Raises
    ------
    InputError
        A file cannot be read, or has no features.
    """
    contexts = []
    for name, path in sorted(named, key=lambda each: _rank(each[0])):
        if path.suffix.lower() not in _SUFFIXES:
            raise input_error(
                path, f"is not a file of map features; name one that ends in {', '.join(_SUFFIXES)}"
            )
        features = observations.features(path)
        if isinstance(features, Detections) or not features:
            raise input_error(path, "has no features; export points, lines or polygons")
        contexts.append(Context(name, path.name, tuple(features)))
    return _number_resources(contexts)


def _number_resources(contexts: Sequence[Context]) -> list[Context]:
    """Add numbers to the resources of divisions, from 1 in the order of their tables."""
    features = [feature for each in contexts for feature in each.features]
    sent = [each for each in features if each.properties.get("kind") == "resource"]
    sent = [each for each in sent if each.properties.get("division")]
    sent.sort(key=lambda each: str(each.properties["division"]))
    numbers = {id(each): number for number, each in enumerate(sent, 1)}

    def numbered(feature: Feature) -> Feature:
        if id(feature) not in numbers:
            return feature
        return replace(feature, properties={**feature.properties, NUMBER: numbers[id(feature)]})

    return [replace(each, features=tuple(map(numbered, each.features))) for each in contexts]


def parse(text: str) -> tuple[str, Path]:
    """Parse ``NAME=FILE``.

    Raises
    ------
    UsageError
        The text has another form.
    """
    name, equals, file = text.partition("=")
    if not equals or not name.strip() or not file:
        known = ", ".join(PRIORITY)
        raise UsageError(f"--context: {text!r} is not NAME=FILE; write for example roads=FILE.gpkg ({known})")
    return name.strip(), Path(file)


def category(feature: Feature) -> str:
    """Return the category of a feature; empty without one."""
    return _property(feature, _CATEGORY)


def label(feature: Feature) -> str:
    """Return the label of a feature; empty without one."""
    return _property(feature, _LABEL)[:_LONGEST]


def point_symbol(context: Context, feature: Feature) -> str:
    """Choose the symbol of a point."""
    named = map_symbols.find(category(feature), map_symbols.POINTS)
    return named or ("Value at risk" if context.name == "values" else "Named place")


def line_style(context: Context, feature: Feature) -> str:
    """Choose the name of the style of a line or an outline."""
    return map_symbols.find(category(feature), map_symbols.LINES) or context.style


def style_title(context: Context, style: str) -> str:
    """Return the text of the legend for a style or a symbol of a file."""
    plain = (*PRIORITY, "other", "Named place", "Value at risk")
    return context.title if style in plain else style


def _is_exercise(feature: Feature) -> bool:
    lower = {str(name).lower(): value for name, value in feature.properties.items()}
    marked = str(lower.get("exercise") or "").strip().lower() not in ("", "0", "false", "no", "none", "null")
    return marked or str(lower.get("origin") or "").strip().lower() == "exercise"


def _property(feature: Feature, names: Sequence[str]) -> str:
    lower = {str(name).lower(): value for name, value in feature.properties.items()}
    found = (" ".join(str(lower[name]).split()) for name in names if isinstance(lower.get(name), str | int))
    return next(filter(None, found), "")


def _rank(name: str) -> float:
    return PRIORITY.index(name) if name in PRIORITY else PRIORITY.index("roads") + 0.5
