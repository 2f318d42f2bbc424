"""Sections [stations] and [labels]: stations, routes and place names in the picture."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..schema import key


@dataclass(frozen=True)
class LabelSettings:
    """Labels of towns, lakes and summits, in the visible picture only."""

    enabled: bool = key(False, "draw the labels")
    file: Path | None = key(
        None,
        "places to label: GeoJSON, or CSV with name, latitude, longitude; default: places of the fire",
        affects=(),
    )
    size: float = key(0.035, "letter height", unit="heights of the picture", at_least=0.001, at_most=0.5)
    distance: float = key(
        60_000.0,
        "distance from the camera at which labels have faded out",
        unit="m",
        at_least=1,
        at_most=10_000_000,
    )


@dataclass(frozen=True)
class StationSettings:
    """Stations and their resources: signs and routes in the visible picture, buildings in every picture."""

    enabled: bool = key(False, "draw the stations")
    file: Path | None = key(None, "stations and their resources, .gpkg", affects=())
    signs: bool = key(True, "a sign at each station, which faces the camera")
    show: tuple[str, ...] = key(
        ("kind", "resources", "minutes"),
        "lines below the name (fire: its arrival time)",
        choices=("kind", "resources", "minutes", "fire"),
    )
    size: float = key(0.03, "letter height", unit="heights of the picture", at_least=0.001, at_most=0.5)
    detail: float = key(
        8000.0,
        "distance from the camera beyond which a sign has the name alone",
        unit="m",
        at_least=1,
        at_most=10_000_000,
    )
    distance: float = key(
        60_000.0,
        "distance from the camera at which signs have faded out",
        unit="m",
        at_least=1,
        at_most=10_000_000,
    )
    buildings: bool = key(True, "a building at each station")
    footprints: Path | None = key(
        None, "outlines of buildings; without one a station has a plain model", affects=()
    )
    routes: bool = key(False, "a straight line from each station to the ignition")
    routes_file: Path | None = key(None, "lines to draw in place of straight ones, .geojson", affects=())
    route_width: float = key(
        0.004, "width of a route", unit="heights of the picture", at_least=0.0005, at_most=0.1
    )
