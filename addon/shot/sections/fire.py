"""Section [fire]: flames, firebrands and observed perimeters."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..schema import key


@dataclass(frozen=True)
class FireSettings:
    """Flames, firebrands and glowing ash."""

    flames: bool = key(True, "draw the flames")
    flame_length: str = key(
        "auto",
        "flame length formula",
        choices={"auto": "by canopy fuel", "thomas": "crown fire", "byram": "surface fire"},
    )
    budget: int = key(
        20_736, "limit on flames drawn at once; the nearest are drawn", at_least=0, at_most=10_000_000
    )
    embers: bool = key(True, "draw glowing ash on the ground; the thermal pass shows its heat in any case")
    firebrands: int = key(
        3000,
        "limit on firebrands (airborne embers) at once, within 1.8 km of the cameras; 0: none",
        at_least=0,
        at_most=100_000,
    )
    torches: bool = key(True, "draw torching: crowns near the cameras flare up when the front reaches them")
    volume_radius: float = key(
        0.0,
        "distance from the first camera to which F12 shows flames as volumes (OpenVDB); 0: billboards",
        unit="m",
        at_least=0,
        at_most=400,
    )
    observed: Path | None = key(
        None,
        "observed perimeters or detections, drawn by date: .geojson, .shp, .kml, .kmz, .gpkg, .csv, folder",
        affects=(),
    )
    observed_width: float = key(
        40.0, "line width of observed perimeters and of fronts", unit="m", above=0, at_most=5000
    )
    fronts: bool = key(False, "draw the fronts of the other [[runs]] as lines on the terrain")
