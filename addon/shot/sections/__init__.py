"""Sections of a scene file: type, default, unit, bounds, choices, help and affected aspects of every key.

The scene file, its validation, the panels, the JSON Schema and the fingerprints of products derive from here.
Times are UTC, lengths metres and angles degrees. A key affects the aspect of its section unless it names
others: "camera" for everything of a camera, and in [render] "picture" (all pictures), "grain" (all but data)
and "thermal". "film" is for films only, "passes" for the lists in sidecars.
"""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

import zoneinfo
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from ..schema import Where, key
from ..schema.did_you_mean import suggestion
from . import biome_names

BANDS = {"lwir": (8.0, 14.0), "mwir": (3.4, 4.1)}  # um, of infrared cameras

LARGEST_SEED = 2**31 - 1  # upper limit in Cycles


def _zone(value: str) -> str | None:
    if not value:
        return None
    try:
        zoneinfo.ZoneInfo(value)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        if not zoneinfo.available_timezones():  # Windows has no time zone database
            return "cannot be looked up: install the Python package tzdata"
        return f'"{value}" is not a time zone' + suggestion(value, sorted(zoneinfo.available_timezones()))
    return None


def _box(value: tuple[float, ...]) -> str | None:
    if not value or (len(value) == 4 and value[0] < value[2] and -90.0 <= value[1] < value[3] <= 90.0):
        return None
    return "must be west, south, east and north in degrees, as [-121.0, 38.6, -120.2, 39.1]"


@dataclass(frozen=True)
class Time:
    """Model times that the frames show. Frames are spread evenly from `start` to `end`."""

    start: datetime | None = key(
        None, "model time of the first frame, with its zone; default: the first time of the run"
    )
    end: datetime | None = key(None, "model time of the last frame; default: the last time of the run")
    frames: int = key(48, "number of frames, spread evenly from start to end", at_least=1, at_most=100_000)
    fps: int = key(24, "frames per second of the films", at_least=1, at_most=240, affects=("film",))
    zone: str = key(
        "", "time zone of the clock in the films; empty: the run's zone", check=_zone, affects=("film",)
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that the end is after the start."""
        if self.start and self.end and self.end <= self.start:
            return ("end",), "time.end must be later than time.start"
        return None


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
        "orthophoto of a server: URL of tiles with {z}, {x} and {y} (or {-y}), or of WMTS capabilities",
        affects=(),
    )
    photo_layer: str = key("", "layer of the WMTS capabilities, if there are several")
    photo_level: int = key(
        19, "finest level of tiles that the server of photo_url has", at_least=0, at_most=30
    )
    photo_credit: str = key("", "credit of the orthophoto; needed with photo_url")
    photo_size: int = key(
        3072,
        "longest side of a picture of the orthophoto in the scene",
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
        choices={"elevation": "run or model", "tiles": "3-D Tiles"},
        affects=(),
    )
    globe: Path | None = key(
        None,
        "picture of the Earth for cameras in space, equirectangular; default: one colour",
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
        """Check that there is one orthophoto, and a credit for the orthophoto of a server."""
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


@dataclass(frozen=True)
class TileSettings:
    """3-D Tiles as ground: photogrammetry, terrain and buildings, chosen once for the whole shot."""

    sources: tuple[str, ...] = key(
        (),
        "tilesets: folders, tileset.json, .3tz archives or URLs; paths start at the scene file's folder",
        affects=("terrain",),
    )
    max_screen_space_error: float = key(
        2.0,
        "largest screen-space error of a tile; interactive viewers often use 16",
        unit="pixels",
        at_least=0.1,
        at_most=10_000,
        affects=("terrain",),
    )
    max_tiles: int = key(
        2000,
        "limit on tiles; beyond a limit the error grows evenly until all fits, and this is reported",
        at_least=1,
        at_most=1_000_000,
        affects=("terrain",),
    )
    max_size: int = key(
        2000,
        "limit on the content fetched for a shot",
        unit="MB",
        at_least=1,
        at_most=1_000_000,
        affects=("terrain",),
    )
    max_triangles: int = key(
        30_000_000, "limit on triangles", at_least=1, at_most=1_000_000_000, affects=("terrain",)
    )
    geoid: float | None = key(
        None,
        "height of the geoid above the WGS84 ellipsoid; default: EGM96, by a grid of this machine",
        unit="m",
        at_least=-200,
        at_most=200,
        affects=("terrain",),
    )
    vegetation: str = key(
        "scene",
        "vegetation on tiles",
        choices={"scene": "that of the tileset is flattened", "tileset": "", "scene_near_burn": ""},
        affects=("terrain", "forest"),
    )


@dataclass(frozen=True)
class Forest:
    """Trees and grass."""

    biome: str = key(
        "auto",
        'vegetation type, such as "maquis" or "boreal"; "auto" selects it by place and fuel',
        choices=biome_names.choices,
        affects=("terrain", "forest"),
    )
    greenness: float | None = key(
        None,
        "greenness of grass; 0: cured, 1: green; default: by date and hemisphere",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    shrub_cover: float | None = key(
        None,
        "smallest share of open land under shrubs, except in sierra_conifer; default: by fuel and biome",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    tree_cover: float | None = key(
        None,
        "share of open land under single trees, except in sierra_conifer; default: by biome",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    trees: bool = key(True, "draw trees where the run has canopy fuel")
    grass: bool = key(True, "draw clumps of grass where the run has surface fuel, within 400 m of a camera")
    density: str = key(
        "stand",
        "tree density",
        choices={"stand": "hundreds per hectare, by canopy fuel", "paper": "one tree per fuel cell"},
    )
    budget: int = key(
        200_000,
        "approximate limit on trees in a stand; distant trees are fewer and wider",
        at_least=1,
        at_most=10_000_000,
    )
    understorey: int = key(
        40_000,
        "limit on shrubs, logs, rocks and grass tufts near the cameras; 0: none",
        at_least=0,
        at_most=10_000_000,
    )
    draw_distance: float = key(
        12_000.0,
        "draw distance of trees from the nearest camera; beyond it the terrain's colour represents them",
        unit="m",
        at_least=0,
        at_most=1_000_000,
    )


@dataclass(frozen=True)
class FireSettings:
    """Flames, firebrands and glowing ash."""

    emitters: str = key(
        "front",
        "placement of flames",
        choices={"front": "along the front", "cells": "one per burning model cell"},
    )
    flames: bool = key(True, "draw the flames")
    flame_length: str = key(
        "auto",
        "flame length formula",
        choices={"auto": "by fuel", "thomas": "crown fire", "byram": "surface fire"},
    )
    budget: int = key(
        20_736, "limit on flames drawn at once; the nearest are drawn", at_least=0, at_most=10_000_000
    )
    embers: bool = key(True, "draw glowing spots in the ash; the thermal view shows their heat in any case")
    firebrands: int = key(
        3000,
        "limit on firebrands in the air at once, within 1.8 km of the cameras; 0: none",
        at_least=0,
        at_most=100_000,
    )
    torches: bool = key(True, "draw torching: crowns near the cameras flare up when the front reaches them")
    observed: Path | None = key(
        None,
        "observed perimeters or detections, drawn by date: .geojson, .shp, .kml, .gpkg, .csv or a folder",
        affects=(),
    )
    observed_width: float = key(
        40.0, "line width of observed perimeters and of fronts", unit="m", above=0, at_most=5000
    )
    fronts: bool = key(False, "draw the fronts of the other [[runs]] as lines on the terrain")


class SmokeMethod(NamedTuple):
    """A choice of `smoke.method`: help, and the key with the history that it needs before the first frame."""

    help: str
    history: str


SMOKE_METHODS = {
    "flow": SmokeMethod("flow solved once per shot", "spin_up"),
    "puffs": SmokeMethod("quick preview", "max_age"),
}
"""The sources of smoke that a scene file can choose; the sources themselves are in ``smoke/sources``."""


@dataclass(frozen=True)
class SmokeSettings:
    """The smoke volume."""

    enabled: bool = key(True, "draw the smoke")
    method: str = key(
        "flow",
        "smoke model for a run without smoke fields",
        choices={name: each.help for name, each in SMOKE_METHODS.items()},
    )
    spin_up: float | None = key(
        None,
        "spin-up of a flow before the first frame; default: by the size of the fire, 1800 for 15 km",
        unit="s",
        at_least=0,
        at_most=172_800,
    )
    cell_budget: float = key(
        3.0,
        "limit on flow cells solved per second of model time; more are finer and take longer",
        unit="millions",
        at_least=0.1,
        at_most=1000,
    )
    cloud_base: float = key(
        4200.0,
        "cloud base above sea level; condensation turns a flow's smoke white above it",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    voxel_size: float = key(
        0.0,
        "edge length of a voxel; 0: chosen by the distance of the nearest camera",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    max_age: float = key(5400.0, "age at which a puff is removed", unit="s", above=0, at_most=10_000_000)
    extinction: float = key(
        0.0,
        "extinction of dense smoke; smaller is faster, 0: chosen as voxel_size is",
        unit="1/m",
        at_least=0,
        at_most=10,
    )
    lighting: str = key(
        "solved",
        "illumination of solved smoke",
        choices={
            "solved": "once per frame",
            "traced": "by Cycles: noisier, sun can be moved",
        },
    )
    draw: str = key(
        "integrated",
        "volume rendering",
        choices={"integrated": "ray march of solved smoke", "volume": "by Cycles, as F12 does"},
    )
    complete: bool = key(False, "write smoke outside of all views too, and temperature and flame grids")


@dataclass(frozen=True)
class Light:
    """Haze, exposure and the light of the flames."""

    haze: float = key(1.0, "strength of haze; 0: none, 1: a dry September day", at_least=0, at_most=100)
    exposure: float | None = key(
        None,
        "exposure; default: exposure metering per camera: about 0.5 by day, up to 4 by night",
        unit="stops",
        at_least=-20,
        at_most=20,
    )
    lamps: int = key(
        48,
        "limit on lamps that light terrain and trees for the flames when the sun is low; 0: none",
        at_least=0,
        at_most=500,
    )


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
        "lines below the name (fire: when it comes)",
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


@dataclass(frozen=True)
class Thermal:
    """The infrared camera of the thermal view. By default the detector is ideal."""

    band: str = key("lwir", "wavelength band", choices={"lwir": "8 to 14 µm", "mwir": "3.4 to 4.1 µm"})
    palette: str = key(
        "white-hot",
        "colour palette of the picture",
        choices=("white-hot", "black-hot", "ironbow", "inferno"),
    )
    vapour: float = key(
        10.0,
        "absolute humidity at sea level (path attenuation); 0: no attenuation",
        unit="g/m³",
        at_least=0,
        at_most=40,
    )
    blur: float = key(
        0.0, "standard deviation of the point spread function", unit="pixels", at_least=0, at_most=20
    )
    noise: float = key(
        0.0, "noise-equivalent temperature difference (NETD) at 300 K", unit="K", at_least=0, at_most=100
    )
    saturation: float = key(
        0.0, "detector saturation temperature; 0: no limit", unit="K", at_least=0, at_most=3000
    )
    bits: int = key(
        0, "bit depth of counts in the EXR, up to saturation; 0: no counts", at_least=0, at_most=16
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that counts have an upper end."""
        if self.bits and not self.saturation:
            return ("bits",), "thermal.bits needs thermal.saturation, which fills the range of the counts"
        return None


@dataclass(frozen=True)
class SceneSettings:
    """Settings of a scene without its cameras and pictures."""

    path: Path = Path("scene.toml")  # the file itself; relative paths in it start at its folder
    notes: tuple[str, ...] = field(default=(), compare=False)  # warnings of its reader
    run: Path = key(Path("sample"), "run folder, such as `firetwin sample` writes", affects=())
    cache: Path = key(Path("cache"), "folder of smoke volumes, for reuse", affects=())
    seed: int = key(
        1,
        "random seed of trees, flames and puffs; the fire stays the same",
        at_least=0,
        at_most=LARGEST_SEED,
        affects=("terrain", "forest", "fire", "smoke"),
    )
    time: Time = key(default_factory=Time, help="model times that the frames show")
    terrain: TerrainSettings = key(
        default_factory=TerrainSettings,
        help="the run's grid, relief near the cameras and an apron to the horizon",
    )
    tiles: TileSettings = key(default_factory=TileSettings, help="3-D Tiles as ground")
    forest: Forest = key(default_factory=Forest, help="trees and grass")
    fire: FireSettings = key(default_factory=FireSettings, help="flames, firebrands and glowing ash")
    smoke: SmokeSettings = key(default_factory=SmokeSettings, help="the smoke volume")
    light: Light = key(default_factory=Light, help="haze, exposure and the light of the flames")
    labels: LabelSettings = key(
        default_factory=LabelSettings, help="labels of towns, lakes and summits in the picture"
    )
    stations: StationSettings = key(
        default_factory=StationSettings, help="stations, their buildings and routes to the fire"
    )
    thermal: Thermal = key(default_factory=Thermal, help="infrared camera of the thermal view")
