"""Formats of `firetwin export`: a module of this package each, with a function `write`."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .request import ExportRequest


@dataclass(frozen=True)
class Format:
    """An export format.

    Attributes
    ----------
    title
        Name for menus.
    help
        Content of the files, in one line.
    has_smoke
        True if the format has smoke volumes, which can be omitted.
    """

    title: str
    help: str
    has_smoke: bool = False


_FORMATS = {
    "usd": Format("USD", "USD stage: terrain, forest, fire, smoke, cameras", has_smoke=True),
    "gltf": Format("glTF", "glTF scene with instanced trees, and a viewer page"),
    "alembic": Format("Alembic", "Alembic: perspective cameras"),
    "gis": Format("GIS and QGIS", "GeoPackage of fronts, cameras, stations; GeoTIFFs; QGIS project"),
    "kmz": Format("Google Earth (KMZ)", "Google Earth: fronts by time, camera tours, overlays"),
    "czml": Format("Cesium (CZML)", "Cesium: clock, fronts, cameras, labels"),
}


def known() -> dict[str, Format]:
    """List the formats whose modules this installation has."""
    folder = Path(__file__).parent
    return {name: each for name, each in _FORMATS.items() if (folder / f"{name}.py").is_file()}


def writer(name: str) -> Callable[[ExportRequest], list[Path]]:
    """Return the function that writes a format into the folder of a request, and lists the main files."""
    return importlib.import_module(f".{name}", __package__).write
