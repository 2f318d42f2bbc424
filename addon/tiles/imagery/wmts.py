"""Capabilities of a WMTS (OGC 07-057r7, version 1.0.0): URLs of a layer's tiles in Web Mercator.

A matrix set counts as WebMercatorQuad (GoogleMapsCompatible) if projection, corner and scales match. The
error for other sets names them.
"""

from __future__ import annotations

import math
import re
from urllib.parse import parse_qsl, quote, urlencode, urljoin
from xml.etree.ElementTree import Element

from ...errors import input_error
from ...run.observations import xml_tree
from ...run.observations.feature import finite
from .address import WORLD, TileAddress
from .mercator import DEEPEST, DENOMINATOR, HALF

MAX_BYTES = 32 << 20  # of the capabilities
_FORMATS = ("image/jpeg", "image/png", "image/jpg")
_CODES = ("3857", "900913", "102100", "102113", "3785")
_NEAR = 1.0e-3  # relative tolerance of scales and corners, which servers round
_OURS = ("service", "request", "version")
_BRACES = re.compile(r"\{([^{}]*)\}")


def address_of(data: bytes, name: str, url: str, layer: str = "") -> TileAddress:
    """Find the address of a layer's tiles.

    Parameters
    ----------
    data, name, url
        The capabilities, their name for messages, and their URL.
    layer
        Identifier of the layer; empty: the only layer.

    Raises
    ------
    InputError
        The capabilities are invalid, the layer is missing, or has no matrix set WebMercatorQuad.
    """
    remedy = "; for other tiles write {z}, {x} and {y}"
    root = xml_tree.parse(data, name, "is not WMTS capabilities", remedy)
    contents = root.find("./{*}Contents")
    if contents is None:
        raise input_error(name, "is not a WMTS: Contents is missing; name the URL of its capabilities")
    chosen = _layer(contents, name, layer)
    matrices, levels = _matrix_set(contents, chosen, name)
    if not levels:
        raise input_error(name, f'the matrix set "{matrices}" has no level')
    template = _template(chosen, name, matrices, urljoin(url, _operation(root)), url)
    names = {level: quote(each, safe="") for level, each in levels.items()}
    return TileAddress(template, min(levels), max(levels), names, _box(chosen))


def _text(element: Element | None, path: str) -> str:
    return (element.findtext(path) or "").strip() if element is not None else ""


def _layer(contents: Element, name: str, wanted: str) -> Element:
    layers = {_text(each, "./{*}Identifier"): each for each in contents.findall("./{*}Layer")}
    if wanted in layers:
        return layers[wanted]
    if len(layers) == 1 and not wanted:
        return next(iter(layers.values()))
    known = ", ".join(sorted(layers)[:8]) + (", ..." if len(layers) > 8 else "")
    if not layers:
        raise input_error(name, "has no layer")
    what = f'has no layer "{wanted}"' if wanted else f"has {len(layers)} layers; name one of them"
    raise input_error(name, f"{what}: {known} (terrain.photo_layer)")


def _matrix_set(contents: Element, layer: Element, name: str) -> tuple[str, dict[int, str]]:
    """Find the layer's WebMercatorQuad matrix set; return its identifier, and matrices' by level."""
    linked = [_text(each, "./{*}TileMatrixSet") for each in layer.findall("./{*}TileMatrixSetLink")]
    sets = {_text(each, "./{*}Identifier"): each for each in contents.findall("./{*}TileMatrixSet")}
    for each in linked:
        if each in sets and (levels := _levels(sets[each])) is not None:
            return each, levels
    sets_there = ", ".join(linked) or "no matrix set"
    reason = f"has tiles in {sets_there}; only WebMercatorQuad (GoogleMapsCompatible) is read"
    raise input_error(name, f'the layer "{_text(layer, "./{*}Identifier")}" {reason}')


def _levels(matrices: Element) -> dict[int, str] | None:
    """List matrices by level; None if any is not of WebMercatorQuad."""
    if not _text(matrices, "./{*}SupportedCRS").endswith(_CODES):
        return None
    identifiers: dict[int, str] = {}
    for each in matrices.findall("./{*}TileMatrix"):
        scale, side = (finite(_text(each, f"./{{*}}{key}")) for key in ("ScaleDenominator", "TileWidth"))
        corner = [finite(part) for part in _text(each, "./{*}TopLeftCorner").split()]
        if not scale or not side or scale <= 0.0 or side <= 0.0 or None in corner or len(corner) != 2:
            return None
        level = math.log2(DENOMINATOR * 256.0 / (scale * side))
        square = finite(_text(each, "./{*}TileHeight")) == side
        x, y = (abs(part or 0.0) / HALF for part in corner)
        if not square or abs(level - round(level)) > _NEAR or abs(x - 1.0) > _NEAR or abs(y - 1.0) > _NEAR:
            return None
        if 0 <= round(level) <= DEEPEST:
            identifiers[round(level)] = _text(each, "./{*}Identifier")
    return identifiers


def _template(layer: Element, name: str, matrices: str, operation: str, url: str) -> str:
    """Make the template of a layer's tiles with {z}, {x} and {y}; other variables are filled in.

    `operation` is the address of GetTile by keys and values, `url` the address of the capabilities.
    """
    styles = layer.findall("./{*}Style")
    style = next((each for each in styles if each.get("isDefault") == "true"), styles[0] if styles else None)
    chosen = {"style": _text(style, "./{*}Identifier"), "tilematrixset": matrices}
    for each in layer.findall("./{*}Dimension"):
        chosen[_text(each, "./{*}Identifier").lower()] = _text(each, "./{*}Default")
    resources = {
        each.get("format", ""): each.get("template", "")
        for each in layer.findall("./{*}ResourceURL")
        if each.get("resourceType") == "tile"
    }
    if found := next((resources[kind] for kind in _FORMATS if resources.get(kind)), ""):
        return urljoin(url, _fill_template(found, chosen, name))
    return _by_key_and_value(layer, name, chosen, operation)


def _fill_template(template: str, chosen: dict[str, str], name: str) -> str:
    places = {"tilematrix": "{z}", "tilecol": "{x}", "tilerow": "{y}"}
    places |= {key: quote(value, safe="") for key, value in chosen.items()}

    def value(found: re.Match[str]) -> str:
        if (text := places.get(found[1].lower())) is None:
            raise input_error(
                name, f"its tiles need a {found[1][:60]!r}, which the capabilities do not define"
            )
        return text

    return _BRACES.sub(value, template)


def _by_key_and_value(layer: Element, name: str, chosen: dict[str, str], url: str) -> str:
    """Make the template of GetTile by keys and values."""
    formats = [(each.text or "").strip() for each in layer.findall("./{*}Format")]
    kind = next((each for each in _FORMATS if each in formats), "")
    if not kind:
        reason = f"has pictures of {', '.join(formats) or 'no format'}; PNG and JPEG are read"
        raise input_error(name, f'the layer "{_text(layer, "./{*}Identifier")}" {reason}')
    fixed = {
        "service": "WMTS",
        "request": "GetTile",
        "version": "1.0.0",
        "layer": _text(layer, "./{*}Identifier"),
        "format": kind,
        **chosen,
    }
    start, _, query = url.partition("?")
    own = [(key, value) for key, value in parse_qsl(query) if key.lower() not in _OURS]
    return f"{start}?{urlencode([*own, *fixed.items()])}&tilematrix={{z}}&tilerow={{y}}&tilecol={{x}}"


def _operation(root: Element) -> str:
    """Find the address of GetTile by keys and values; empty without one."""
    for each in root.findall("./{*}OperationsMetadata/{*}Operation[@name='GetTile']//{*}Get"):
        encodings = [(value.text or "").upper() for value in each.findall(".//{*}Value")]
        if not encodings or "KVP" in encodings:
            return next((value for key, value in each.items() if key.endswith("href")), "")
    return ""


def _box(layer: Element) -> tuple[float, float, float, float]:
    """Read the bounds of a layer, degrees; by default the world."""
    box = layer.find("./{*}WGS84BoundingBox")
    corners = [
        finite(each) for key in ("LowerCorner", "UpperCorner") for each in _text(box, f"./{{*}}{key}").split()
    ]
    known = [each for each in corners if each is not None]
    if len(known) != 4 or len(corners) != 4 or not (known[0] < known[2] and known[1] < known[3]):
        return WORLD
    return known[0], max(known[1], WORLD[1]), known[2], min(known[3], WORLD[3])
