"""Section [terrain]: relief, mesh tolerance, elevation model, orthophoto, land use and globe."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..schema import Where, key


def _box(value: tuple[float, ...]) -> str | None:
    if not value or (len(value) == 4 and value[0] < value[2] and -90.0 <= value[1] < value[3] <= 90.0):
        return None
    return "must be west, south, east and north in degrees, as [-121.0, 38.6, -120.2, 39.1]"


@dataclass(frozen=True)
class TerrainSettings:
    """The run's terrain with relief near the cameras, and an apron to the horizon."""

    near_radius: float = key(
        4000.0,
        "distance from a camera's path within which relief finer than the run's grid is added",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    error: float = key(
        0.05,
        "mesh tolerance: largest vertical error seen by a camera; larger is coarser",
        unit="pixels",
        at_least=0.001,
        at_most=1000,
    )
    elevation: Path | None = key(
        None,
        "digital elevation model, a GeoTIFF in any projection; overrides heights of the run",
        affects=(),
    )
    photo: Path | None = key(
        None,
        "orthophoto of unburned terrain: a GeoTIFF, or a PNG or JPEG with a world file in degrees",
        affects=(),
    )
    photo_extent: tuple[float, ...] = key(
        (),
        "bounds of a PNG or JPEG without a world file: west, south, east, north",
        unit="degrees",
        check=_box,
        affects=(),
    )
    photo_url: str = key(
        "",
        "orthophoto from a tile server: URL with {z}, {x} and {y} (or {-y}), or of WMTS capabilities",
        affects=(),
    )
    photo_layer: str = key("", "layer of the WMTS capabilities, if there are several")
    photo_level: int = key(19, "highest zoom level of the tile server of photo_url", at_least=0, at_most=30)
    photo_credit: str = key("", "credit of the orthophoto; needed with photo_url")
    photo_size: int = key(
        3072,
        "longest side of an image of the orthophoto in the scene",
        unit="pixels",
        at_least=64,
        at_most=6144,
    )
    land_use: Path | None = key(
        None,
        "fields, tracks, roads, water and buildings: polygons and lines, .geojson or .gpkg",
        affects=(),
    )
    buildings: Path | None = key(
        None,
        "footprints of buildings, every polygon one: .geojson, .gpkg, .kml or .shp",
        affects=(),
    )
    height_source: str = key(
        "elevation",
        "source of ground heights",
        choices={"elevation": "run or model", "tiles": "3D Tiles"},
        affects=(),
    )
    globe: Path | None = key(
        None,
        "picture of the Earth for cameras in space, equirectangular; default: NASA's Blue Marble",
        affects=(),
    )
    globe_credit: str = key("", "credit of that picture, which pictures show", affects=())
    apron: float = key(
        110_000.0,
        "half-width of the terrain drawn around the run; a small one shows its edge",
        unit="m",
        at_least=0,
        at_most=1_000_000,
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that there is one orthophoto, and a credit for an orthophoto from a tile server."""
        if self.photo_url and self.photo:
            return ("photo_url",), "terrain.photo_url and terrain.photo are both there; leave one out"
        if self.photo_url and not self.photo_credit.strip():
            return (
                ("photo_url",),
                "terrain.photo_url needs terrain.photo_credit: the line that the server's terms ask for",
            )
        if self.photo_layer and not self.photo_url:
            return ("photo_layer",), "terrain.photo_layer needs a terrain.photo_url"
        return None
