"""QGIS styles: renderers, labels and times of layers, with colours and symbols of the NWCG standard."""

from __future__ import annotations

import base64
import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from ..imaging import map_symbols
from ..imaging.map_symbols import LineStyle
from ..run import thumbnails
from . import overlays
from .gis_geopackage import Table
from .gis_rasters import Raster

VERSION = "3.22.0-Białowieża"
_START_AND_END = "2"  # QgsVectorLayerTemporalProperties: two fields
_LABELLED = {"places": "name", "division_breaks": "name", "camera_paths": "name", "divisions": "division"}
_EVERY = 4.2  # mm between marks of a line
_BURNED = "#d40000"


def qml(parts: Sequence[ET.Element], labelled: bool = False) -> str:
    """Return the content of a QML file."""
    root = ET.Element("qgis", version=VERSION, styleCategories="AllStyleCategories")
    root.set("labelsEnabled", str(int(labelled)))
    root.extend(parts)
    return document(root)


def document(root: ET.Element) -> str:
    """Return the content of a file of QGIS."""
    return f"<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n{ET.tostring(root, 'unicode')}\n"


def is_labelled(table: Table) -> bool:
    """Check whether a table has labels on the map."""
    return table.name in _LABELLED


def of_table(table: Table) -> list[ET.Element]:
    """Make the elements of a table's style."""
    parts = [_renderer(table)]
    if "begin_time" in table.columns:
        fields = {"startField": "begin_time", "endField": "end_time", "mode": _START_AND_END}
        parts.append(ET.Element("temporal", fields | {"enabled": "1", "limitMode": "0", "accumulate": "0"}))
    if is_labelled(table):
        parts.append(_labels(_LABELLED[table.name]))
    return parts


def of_raster(raster: Raster) -> list[ET.Element]:
    """Make the elements of a raster's style: its first band by colours from low to high."""
    low, high, colours = _ramp(raster)
    pipe = ET.Element("pipe")
    renderer = ET.SubElement(
        pipe, "rasterrenderer", type="singlebandpseudocolor", band="1", opacity="0.8", alphaBand="-1",
        classificationMin=f"{low:.9g}", classificationMax=f"{high:.9g}",
    )  # fmt: skip
    shader = ET.SubElement(
        ET.SubElement(renderer, "rastershader"), "colorrampshader", colorRampType="INTERPOLATED", clip="0",
        classificationMode="1", minimumValue=f"{low:.9g}", maximumValue=f"{high:.9g}",
    )  # fmt: skip
    for k, colour in enumerate(colours):
        value = low + (high - low) * k / max(len(colours) - 1, 1)
        alpha = "0" if k == 0 and raster.no_data is None else "255"
        label = f"{value:.4g} {raster.unit}"
        ET.SubElement(shader, "item", value=f"{value:.9g}", color=colour, alpha=alpha, label=label)
    return [pipe]


def _ramp(raster: Raster) -> tuple[float, float, Sequence[str]]:
    """Choose the lowest and highest value and the colours of a raster."""
    values = next(iter(raster.bands.values()))
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    if raster.name == "burned":
        return 0.0, 1.0, ("#ffffff", _BURNED)
    colours = {"arrival": overlays.ARRIVAL, "fuel": thumbnails.FUEL, "intensity": thumbnails.INTENSITY}
    return (
        (low if raster.no_data is not None else 0.0),
        max(high, low + 1e-9),
        colours.get(raster.name, _GREYS),
    )


_GREYS = ("#ffffff", "#bdbdbd", "#737373", "#252525")


def _renderer(table: Table) -> ET.Element:
    """Make the renderer of a table."""
    edge = map_symbols.LINES["Fire Edge"]
    if table.name == "burned_area":
        fill = {"color": _rgba(edge.colour, 60), "style": "solid", "outline_style": "no"}
        return _single("fill", [("SimpleFill", fill)])
    if table.name == "fronts":
        return _single("line", _line(edge))
    if table.name == "camera_paths":
        return _single("line", _line(LineStyle("#111111", 0.4, "2 1")))
    if table.name == "divisions":
        return _categories(
            "category", {name: _line(map_symbols.LINES[name]) for name in _used(table, 1)}, "line"
        )
    if table.name in ("places", "division_breaks"):
        names = [name for name in _used(table, 1) if name in map_symbols.POINTS]
        return _categories("category", {name: [_svg(name)] for name in names}, "marker")
    arrow = {"name": "arrow", "size": "3", "size_unit": "MM", "color": "17,17,17,255"}
    return _single("marker", [("SimpleMarker", arrow)], angle="heading_deg")


def _used(table: Table, column: int) -> list[str]:
    """List the values of a column in use."""
    return sorted({str(values[column]) for _, values in table.rows})


def _line(style: LineStyle) -> list[tuple[str, dict[str, str]]]:
    """Make the symbol layers of a line: white casing, line, and marks."""
    found = []
    if style.casing and style.width:
        found.append(_simple_line("#ffffff", style.width + 0.5, ""))
    if style.width or style.mark:
        found.append(_simple_line(style.colour, style.width or 0.2, style.dashes))
    return found


def _simple_line(colour: str, width: float, dashes: str) -> tuple[str, dict[str, str]]:
    options = {"line_color": _rgba(colour), "line_width": f"{width:g}", "line_width_unit": "MM"}
    options |= {"joinstyle": "round", "capstyle": "flat" if dashes else "round"}
    if dashes:
        options |= {"use_custom_dash": "1", "customdash": dashes.replace(" ", ";"), "customdash_unit": "MM"}
    return "SimpleLine", options


def _svg(name: str) -> tuple[str, dict[str, str]]:
    drawing = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -1 2 2">{map_symbols.POINTS[name]}</svg>'
    data = base64.b64encode(drawing.encode()).decode()
    return "SvgMarker", {"name": f"base64:{data}", "size": "5", "size_unit": "MM"}


def _single(kind: str, layers: list[tuple[str, dict[str, str]]], angle: str = "") -> ET.Element:
    renderer = ET.Element("renderer-v2", type="singleSymbol", symbollevels="0", enableorderby="0")
    _symbol(ET.SubElement(renderer, "symbols"), "0", kind, layers, angle)
    return renderer


def _categories(field: str, symbols: dict[str, list[tuple[str, dict[str, str]]]], kind: str) -> ET.Element:
    renderer = ET.Element("renderer-v2", type="categorizedSymbol", attr=field, symbollevels="0")
    categories, drawn = ET.SubElement(renderer, "categories"), ET.SubElement(renderer, "symbols")
    for number, (value, layers) in enumerate(symbols.items()):
        about = {"symbol": str(number), "value": value, "label": value, "render": "true", "type": "string"}
        ET.SubElement(categories, "category", about)
        _symbol(drawn, str(number), kind, layers)
    return renderer


def _symbol(
    parent: ET.Element, name: str, kind: str, layers: list[tuple[str, dict[str, str]]], angle: str = ""
) -> None:
    """Add a symbol; `angle` names a field that turns it, degrees clockwise."""
    symbol = ET.SubElement(parent, "symbol", type=kind, name=name, alpha="1", clip_to_extent="1")
    for class_, options in layers:
        layer = ET.SubElement(symbol, "layer", {"class": class_, "enabled": "1", "locked": "0", "pass": "0"})
        listed = ET.SubElement(layer, "Option", type="Map")
        for key, value in options.items():
            ET.SubElement(listed, "Option", name=key, type="QString", value=value)
            ET.SubElement(layer, "prop", k=key, v=value)
        if angle:
            _turn(ET.SubElement(layer, "data_defined_properties"), angle)


def _turn(parent: ET.Element, field: str) -> None:
    """Add a data-defined angle."""
    collection = ET.SubElement(parent, "Option", type="Map")
    ET.SubElement(collection, "Option", name="name", type="QString", value="")
    properties = ET.SubElement(collection, "Option", name="properties", type="Map")
    own = ET.SubElement(properties, "Option", name="angle", type="Map")
    ET.SubElement(own, "Option", name="active", type="bool", value="true")
    ET.SubElement(own, "Option", name="field", type="QString", value=field)
    ET.SubElement(own, "Option", name="type", type="int", value="2")
    ET.SubElement(collection, "Option", name="type", type="QString", value="collection")


def _labels(field: str) -> ET.Element:
    """Label features with a field, in black with a white edge."""
    labeling = ET.Element("labeling", type="simple")
    settings = ET.SubElement(labeling, "settings")
    text = {"fieldName": field, "fontSize": "9", "fontSizeUnit": "Point", "textColor": "0,0,0,255"}
    text |= {"textOpacity": "1", "fontFamily": "Sans", "fontWeight": "75"}
    style = ET.SubElement(settings, "text-style", text)
    buffer = {"bufferDraw": "1", "bufferSize": "0.8", "bufferSizeUnits": "MM", "bufferOpacity": "1"}
    ET.SubElement(style, "text-buffer", buffer | {"bufferColor": "255,255,255,255"})
    ET.SubElement(settings, "placement", dist="3", distUnits="MM", placement="6")
    return labeling


def _rgba(colour: str, alpha: int = 255) -> str:
    wide = colour if len(colour) == 7 else "#" + "".join(2 * each for each in colour[1:])
    return ",".join([*(str(int(wide[i : i + 2], 16)) for i in (1, 3, 5)), str(alpha)])
