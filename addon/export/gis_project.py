"""QGIS project with all layers of an export, their styles, and the time range of the temporal controller."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime

from ..geometry.utm import Zone
from . import gis_styles
from .texts import iso


@dataclass(frozen=True)
class ProjectLayer:
    """A layer of the project.

    Attributes
    ----------
    key
        Unique name of letters, digits and underscores; QGIS replaces names of fewer than 10 characters.
    source
        Path relative to the project, with the name of the table.
    geometry
        "Point", "Line" or "Polygon"; empty for a raster.
    style
        Elements of its style.
    """

    key: str
    title: str
    source: str
    geometry: str = ""
    style: list[ET.Element] = field(default_factory=list)
    labelled: bool = False
    shown: bool = True
    epsg: int = 4326


def text(
    title: str, layers: Sequence[ProjectLayer], zone: Zone, span: tuple[datetime, datetime], box: list[float]
) -> str:
    """Return the content of the project file.

    Parameters
    ----------
    layers
        Layers from the lowest on the map to the highest.
    zone
        UTM zone of the map.
    span
        First and last time of the temporal controller.
    box
        West, south, east and north of the map, degrees.
    """
    root = ET.Element("qgis", version=gis_styles.VERSION, projectname=title)
    ET.SubElement(root, "title").text = title
    _system(ET.SubElement(root, "projectCrs"), zone.epsg)
    tree = ET.SubElement(root, "layer-tree-group")
    for each in reversed(layers):
        ET.SubElement(
            tree, "layer-tree-layer", id=each.key, name=each.title, source=each.source,
            providerKey="ogr" if each.geometry else "gdal", expanded="0",
            checked="Qt::Checked" if each.shown else "Qt::Unchecked",
        )  # fmt: skip
    canvas = ET.SubElement(root, "mapcanvas", name="theMapCanvas", annotationsVisible="1")
    ET.SubElement(canvas, "units").text = "meters"
    (west, east), (south, north) = zone.forward([box[1], box[3]], [box[0], box[2]])
    extent = ET.SubElement(canvas, "extent")
    for name, value in (("xmin", west), ("ymin", south), ("xmax", east), ("ymax", north)):
        ET.SubElement(extent, name).text = f"{float(value):.3f}"
    _system(ET.SubElement(canvas, "destinationsrs"), zone.epsg)
    order = ET.SubElement(root, "layerorder")
    found = ET.SubElement(root, "projectlayers")
    for each in layers:
        ET.SubElement(order, "layer", id=each.key)
        found.append(_layer(each))
    times = ET.SubElement(
        root, "ProjectTimeSettings", frameRate="4", timeStep=f"{_step(span):g}", timeStepUnit="min",
        cumulativeTemporalRange="0",
    )  # fmt: skip
    both = ET.SubElement(times, "TemporalRange")
    for name, when in zip(("start", "end"), span, strict=True):
        ET.SubElement(both, name).text = iso(when)
    properties = ET.SubElement(root, "properties")
    ET.SubElement(ET.SubElement(properties, "Paths"), "Absolute", type="bool").text = "false"
    system = ET.SubElement(properties, "SpatialRefSys")
    ET.SubElement(system, "ProjectionsEnabled", type="int").text = "1"
    ET.indent(root, " ")
    return gis_styles.document(root)


def _layer(each: ProjectLayer) -> ET.Element:
    about = {"type": "vector" if each.geometry else "raster", "hasScaleBasedVisibilityFlag": "0"}
    if each.geometry:
        about |= {"geometry": each.geometry, "labelsEnabled": str(int(each.labelled))}
    layer = ET.Element("maplayer", about, styleCategories="AllStyleCategories")
    ET.SubElement(layer, "id").text = each.key
    ET.SubElement(layer, "datasource").text = each.source
    ET.SubElement(layer, "layername").text = each.title
    _system(ET.SubElement(layer, "srs"), each.epsg)
    provider = ET.SubElement(layer, "provider")
    provider.text = "ogr" if each.geometry else "gdal"
    if each.geometry:
        provider.set("encoding", "UTF-8")
    layer.extend(each.style)
    return layer


def _system(parent: ET.Element, epsg: int) -> None:
    system = ET.SubElement(parent, "spatialrefsys")
    ET.SubElement(system, "srsid").text = "1"  # a number of the standard systems: QGIS then reads authid
    ET.SubElement(system, "srid").text = str(epsg)
    ET.SubElement(system, "authid").text = f"EPSG:{epsg}"


def _step(span: tuple[datetime, datetime]) -> float:
    """Choose the time step of the temporal controller, minutes: at most 100 steps."""
    minutes = (span[1] - span[0]).total_seconds() / 60.0
    return next((step for step in (1, 2, 5, 10, 15, 30, 60, 120, 180, 360) if minutes / step <= 100.0), 1440)
