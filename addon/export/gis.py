"""GIS export: a GeoPackage, cloud-optimized GeoTIFFs, QGIS styles, and a QGIS project of all layers."""

from __future__ import annotations

from pathlib import Path

from .. import files, geopackage
from ..geometry.utm import Zone
from . import gis_geopackage, gis_project, gis_rasters, gis_styles, gis_tables
from .gis_geopackage import Table
from .gis_project import ProjectLayer
from .gis_rasters import FOLDER, Raster
from .request import ExportRequest

FORMAT = {"title": "GIS and QGIS", "help": "GeoPackage of fronts, cameras, stations; GeoTIFFs; QGIS project"}
ORDER = 40
GEOPACKAGE, PROJECT, STYLES = "firetwin.gpkg", "firetwin.qgs", "styles"
_GEOMETRIES = {"POINT": "Point", "LINESTRING": "Line", "MULTILINESTRING": "Line", "MULTIPOLYGON": "Polygon"}
_HIDDEN = ("camera_frames", "burned", "fuel", "intensity", "smoke_column")


def write(request: ExportRequest) -> list[Path]:
    """Write all files.

    Raises
    ------
    Error
        rasterio is not installed.
    """
    shot, folder = request.shot, request.folder
    rasters = gis_rasters.make(shot.run, shot.settings.time.zone, shot.frames.time(request.frames[-1]))
    maps = gis_rasters.write(rasters, folder, shot.run)
    tables = gis_tables.make(request)
    styles = {
        table.name: gis_styles.qml(gis_styles.of_table(table), gis_styles.is_labelled(table))
        for table in tables
    }
    gis_geopackage.write(folder / GEOPACKAGE, tables, styles, shot.utc(request.frames[0]))
    for raster in rasters:
        styles[raster.name] = gis_styles.qml(gis_styles.of_raster(raster))
    for name, text in styles.items():
        files.write_text(folder / STYLES / f"{name}.qml", text)
    files.write_text(folder / PROJECT, _project(request, tables, rasters))
    return [folder / PROJECT, folder / GEOPACKAGE, *maps]


def _project(request: ExportRequest, tables: list[Table], rasters: list[Raster]) -> str:
    shot = request.shot
    layers = [*map(_raster_layer, reversed(rasters)), *map(_table_layer, tables)]
    fire = next((table for table in tables if table.name == "burned_area"), None)
    run = shot.run
    box = (
        geopackage.bounds(fire.points())
        if fire
        else [run.longitude.min(), run.latitude.min(), run.longitude.max(), run.latitude.max()]
    )
    place = request.georeference
    zone = Zone.at(place.latitude, place.longitude)
    span = shot.utc(request.frames[0]), shot.utc(request.frames[-1])
    return gis_project.text(run.name or "Fire", layers, zone, span, [float(each or 0.0) for each in box])


def _table_layer(table: Table) -> ProjectLayer:
    source = f"./{GEOPACKAGE}|layername={table.name}"
    return ProjectLayer(
        f"firetwin_{table.name}", table.title, source, _GEOMETRIES[table.geometry],
        gis_styles.of_table(table), gis_styles.is_labelled(table), table.name not in _HIDDEN, table.srs,
    )  # fmt: skip


def _raster_layer(raster: Raster) -> ProjectLayer:
    source = f"./{FOLDER}/{raster.name}.tif"
    return ProjectLayer(
        f"firetwin_{raster.name}", raster.title, source, style=gis_styles.of_raster(raster),
        shown=raster.name not in _HIDDEN,
    )  # fmt: skip
