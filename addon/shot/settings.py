"""Every setting once: its type, default, unit, bounds, choices and help, and what it changes.

The file, its check, the panels, the schema for editors and the fingerprints of products come from here.
Times are UTC, lengths metres and angles degrees. What a key changes is named by aspects: that of its section
unless it says otherwise, "camera" for all of a camera, and of [render] "picture" (all pictures), "grain"
(what is not data) and "thermal". "film" is what only films show, "passes" what sidecars list.
"""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

import zoneinfo
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from . import biomes, frame_list, passes, rigs
from .bounds import file_name, twice
from .nearest import suggestion
from .schema import Where, key, kind_of, one_of, parts

BANDS = {"lwir": (8.0, 14.0), "mwir": (3.4, 4.1)}  # um, of infrared cameras
MOST_RUNS = 3  # beside the first
_LARGEST_SEED = 2**31 - 1  # Cycles takes no larger one


def _zone(value: str) -> str | None:
    if not value:
        return None
    try:
        zoneinfo.ZoneInfo(value)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        if not zoneinfo.available_timezones():  # Windows has none of its own
            return "cannot be looked up: install the Python package tzdata"
        return f'"{value}" is not a time zone' + suggestion(value, sorted(zoneinfo.available_timezones()))
    return None


def _even(value: tuple[int, int] | None) -> str | None:
    if value is None or all(side % 2 == 0 for side in value):
        return None
    return "must be two even numbers of pixels (video needs even ones)"


def _at_least_one(value: tuple[str, ...]) -> str | None:
    return None if value else 'is empty; name at least one, such as "rgb"'


def _box(value: tuple[float, ...]) -> str | None:
    if not value or (len(value) == 4 and value[0] < value[2] and -90.0 <= value[1] < value[3] <= 90.0):
        return None
    return "must be west, south, east and north in degrees, as [-121.0, 38.6, -120.2, 39.1]"


@dataclass(frozen=True)
class Time:
    """Which model times the frames show; frames are spread evenly from `start` to `end`."""

    start: datetime | None = key(
        None, "model time of the first frame, with its zone; left out, the run's first"
    )
    end: datetime | None = key(None, "model time of the last frame; left out, the run's last")
    frames: int = key(48, "spread evenly from start to end", at_least=1, at_most=100_000)
    fps: int = key(24, "frames per second of the films", at_least=1, at_most=240, shows=("film",))
    zone: str = key("", "zone of the clock in the films; empty, the run's", check=_zone, shows=("film",))

    def wrong(self) -> tuple[Where, str] | None:
        """The end comes last."""
        if self.start and self.end and self.end <= self.start:
            return ("end",), "time.end must be later than time.start"
        return None


@dataclass(frozen=True)
class Ground:
    """The model's grid, as fine as cameras see it, and an apron out to the horizon."""

    near_radius: float = key(
        4000.0,
        "ridges and gullies finer than the grid within this distance of a camera's path",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    error: float = key(
        0.05,
        "how far the mesh may be above or below what cameras see; more is coarser",
        unit="pixels",
        at_least=0.001,
        at_most=1000,
    )
    elevation: Path | None = key(
        None,
        "elevation model, a GeoTIFF in any projection; where it has heights they are the ground's",
        shows=(),
    )
    photo: Path | None = key(
        None,
        "orthophoto, a GeoTIFF, or a PNG or JPEG with a world file in degrees: the ground's unburned colour",
        shows=(),
    )
    photo_extent: tuple[float, ...] = key(
        (),
        "west, south, east and north of a PNG or JPEG without a world file",
        unit="degrees",
        check=_box,
        shows=(),
    )
    land_use: Path | None = key(
        None,
        "fields, tracks, roads, water and buildings to draw, a .geojson or .gpkg of polygons and lines",
        shows=(),
    )
    apron: float = key(
        110_000.0,
        "half-width of the ground drawn round the run; smaller shows the edge of the world",
        unit="m",
        at_least=0,
        at_most=1_000_000,
    )


@dataclass(frozen=True)
class Forest:
    """Trees and grass."""

    biome: str = key(
        "auto",
        'kind of land, such as "maquis" or "boreal": its plants and colours; "auto" goes by place and fuel',
        choices=biomes.choices,
        shows=("ground", "forest"),
    )
    greenness: float | None = key(
        None,
        "0 is dry grass, 1 green; left out, by date and hemisphere",
        at_least=0,
        at_most=1,
        shows=("ground", "forest"),
    )
    shrub_cover: float | None = key(
        None,
        "part of open land under bushes, at least, outside of the Sierra; left out, by fuel and biome",
        at_least=0,
        at_most=1,
        shows=("ground", "forest"),
    )
    tree_cover: float | None = key(
        None,
        "part of open land under lone trees, outside of the Sierra; left out, the biome's",
        at_least=0,
        at_most=1,
        shows=("ground", "forest"),
    )
    trees: bool = key(True, "where there is canopy fuel")
    grass: bool = key(True, "clumps where there is surface fuel")
    density: str = key(
        "stand",
        "how many trees",
        choices={"stand": "hundreds a hectare, by canopy fuel", "paper": "one for each fuel cell"},
    )
    budget: int = key(
        200_000,
        "about the most trees of a stand; far ones are fewer and wider",
        at_least=1,
        at_most=10_000_000,
    )
    understorey: int = key(
        40_000,
        "most bushes, logs, rocks and tufts of grass near the cameras; 0: none",
        at_least=0,
        at_most=10_000_000,
    )
    draw_distance: float = key(
        12_000.0,
        "trees farther than this from every camera are part of the ground's colour",
        unit="m",
        at_least=0,
        at_most=1_000_000,
    )


@dataclass(frozen=True)
class Fire:
    """Flames, firebrands and the glowing ground."""

    emitters: str = key(
        "front",
        "where flames stand",
        choices={"front": "along the fire line", "cells": "one for each burning model cell"},
    )
    flames: bool = key(True, "draw the flames")
    flame_length: str = key(
        "auto",
        "formula for the flames' length",
        choices={"auto": "by the fuel", "thomas": "crown fire", "byram": "surface fire"},
    )
    budget: int = key(20_736, "most flames drawn at once, nearest first", at_least=0, at_most=10_000_000)
    embers: bool = key(True, "spots that glow in the ash; the thermal view shows their heat in any case")
    firebrands: int = key(
        3000,
        "most glowing pieces in the air at once, within 1.8 km of the cameras; 0: none",
        at_least=0,
        at_most=100_000,
    )
    torches: bool = key(True, "crowns near the cameras that flare up as the front reaches them")
    observed: Path | None = key(
        None,
        "perimeters or detections to draw by date, a .geojson, .shp, .kml, .gpkg, .csv or a folder of them",
        shows=(),
    )
    observed_width: float = key(40.0, "of these lines and of fronts", unit="m", above=0, at_most=5000)
    fronts: bool = key(False, "where the fire of the other [[runs]] is, as lines on the ground")


@dataclass(frozen=True)
class Smoke:
    """The smoke volume."""

    enabled: bool = key(True, "draw the smoke")
    method: str = key(
        "flow",
        "where the run has none",
        choices={"flow": "air solved once per shot", "puffs": "a quick preview"},
    )
    spin_up: float | None = key(
        None,
        "how long before the first frame a flow begins; left out, by the fire's size, 1800 for 15 km",
        unit="s",
        at_least=0,
        at_most=172_800,
    )
    cell_budget: float = key(
        3.0,
        "most cells of air solved for each second of the fire; more are finer and take longer",
        unit="millions",
        at_least=0.1,
        at_most=1000,
    )
    cloud_base: float = key(
        4200.0,
        "from this height above the sea vapour turns rising smoke white, in a flow",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    voxel_size: float = key(
        0.0,
        "edge of a voxel; 0 chooses it from the distance of the nearest camera",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    max_age: float = key(5400.0, "older puffs have left the picture", unit="s", above=0, at_most=10_000_000)
    extinction: float = key(
        0.0,
        "in thick smoke; less is faster, 0 chooses it like the voxels",
        unit="1/m",
        at_least=0,
        at_most=10,
    )
    lighting: str = key(
        "solved",
        "of a flow's smoke",
        choices={
            "solved": "once a frame",
            "traced": "by Cycles: grainier, follows a moved sun",
        },
    )
    draw: str = key(
        "integrated",
        "in rendered frames",
        choices={"integrated": "solved smoke along camera rays", "volume": "by Cycles, as F12 does"},
    )
    complete: bool = key(False, "also smoke that no camera sees, and its temperature and flames as grids")


@dataclass(frozen=True)
class Light:
    """Sun, sky, haze, exposure and the light of the flames."""

    haze: float = key(1.0, "how strong it is; 0: none, 1: a dry September day", at_least=0, at_most=100)
    exposure: float | None = key(
        None,
        "brighter or darker; left out, from what the camera sees: about 0.5 by day, up to 4 by night",
        unit="stops",
        at_least=-20,
        at_most=20,
    )
    lamps: int = key(
        48,
        "most lamps that light ground and trees in place of the flames when the sun is low; 0: none",
        at_least=0,
        at_most=500,
    )


@dataclass(frozen=True)
class Places:
    """Labels of towns, lakes and summits, in the visible picture alone."""

    enabled: bool = key(False, "draw the labels")
    file: Path | None = key(
        None,
        "places to label, a GeoJSON or a CSV with name, latitude and longitude; left out, the fire's own",
        shows=(),
    )
    size: float = key(
        0.035, "height of the letters", unit="heights of the picture", at_least=0.001, at_most=0.5
    )
    distance: float = key(
        60_000.0, "from the camera to where labels have faded out", unit="m", at_least=1, at_most=10_000_000
    )


@dataclass(frozen=True)
class Thermal:
    """The infrared camera of the thermal view, ideal unless it is given flaws."""

    band: str = key(
        "lwir", "wavelengths that it sees", choices={"lwir": "8 to 14 µm", "mwir": "3.4 to 4.1 µm"}
    )
    palette: str = key(
        "white-hot",
        "colours of the picture",
        choices=("white-hot", "black-hot", "ironbow", "inferno"),
    )
    vapour: float = key(
        10.0,
        "water in the air at sea level, which dims what is far; 0: clear",
        unit="g/m³",
        at_least=0,
        at_most=40,
    )
    blur: float = key(0.0, "standard deviation of its point spread", unit="pixels", at_least=0, at_most=20)
    noise: float = key(0.0, "its NETD, at 300 K", unit="K", at_least=0, at_most=100)
    saturation: float = key(
        0.0, "the hottest that it can tell; 0: no limit", unit="K", at_least=0, at_most=3000
    )
    bits: int = key(0, "of counts in its EXR, up to saturation; 0: none", at_least=0, at_most=16)

    def wrong(self) -> tuple[Where, str] | None:
        """Counts end somewhere."""
        if self.bits and not self.saturation:
            return ("bits",), "thermal.bits needs thermal.saturation, which fills the range of the counts"
        return None


@dataclass(frozen=True)
class Camera:
    """A camera: what it records, and how it is set up and moved (its rig, the kind of camera)."""

    name: str = key("drone", "names its folder and files", check=file_name, shows=())
    rig: Any = one_of(rigs.kinds, "kind of camera", tag="kind", usual=rigs.USUAL)
    passes: tuple[str, ...] = key(
        (), 'such as ["rgb"]; empty: those of [render]', choices=passes.helps, shows=("passes",)
    )
    frames: str = key("", 'such as "24" or "1-48:4"; empty: all')
    resolution: tuple[int, int] | None = key(
        None,
        "of its pictures, both even; left out, as [render] says",
        unit="pixels",
        at_least=16,
        at_most=16384,
        check=_even,
    )

    @property
    def kind(self) -> str:
        """Name of the kind of camera."""
        rig = next(part for part in parts(Camera) if part.name == "rig")
        return kind_of(rig.key, self.rig)

    def wrong(self) -> tuple[Where, str] | None:
        """What its rig finds."""
        found = self.rig.wrong()
        return (found[0], f'camera "{self.name}" {found[1]}') if found else None


@dataclass(frozen=True)
class OtherRun:
    """Another run of the same place and time, seen by the same cameras."""

    name: str = key(
        "what-if", 'what it is called; camera "drone" is drone@what-if in it', check=file_name, shows=()
    )
    path: Path = key(Path("what-if"), "folder of this other run", shows=())


@dataclass(frozen=True)
class Render:
    """How frames are made."""

    engine: str = key(
        "cycles",
        "what renders",
        choices={"cycles": "light is traced", "eevee": "faster, needs OpenGL"},
        shows=("picture",),
    )
    device: str = key(
        "auto",
        "what Cycles renders on",
        choices={"auto": "a GPU if there is one", "cpu": "the processor", "gpu": ""},
        shows=(),
    )
    resolution: tuple[int, int] = key(
        (640, 360),
        "width and height, both even",
        unit="pixels",
        at_least=16,
        at_most=16384,
        check=_even,
        shows=("picture",),
    )
    samples: int = key(
        6,
        "rays per pixel; 3 for a quick film, 12 to 24 for a final picture",
        at_least=1,
        at_most=65536,
        shows=("grain",),
    )
    denoise: bool = key(True, "the picture only; depth and temperatures never are", shows=("grain",))
    passes: tuple[str, ...] = key(
        ("rgb", "depth", "thermal"),
        "what cameras record",
        choices=passes.helps,
        check=_at_least_one,
        shows=("passes",),
    )
    video: bool = key(True, "a film of every camera with more than one frame, rgb and thermal", shows=())
    seed: int = key(
        0, "another number gives other grain", at_least=0, at_most=_LARGEST_SEED, shows=("grain",)
    )
    skip: bool = key(
        True,
        "leave out what no camera sees, and draw what is far more coarsely; false is for comparison",
        shows=("ground", "forest", "fire", "smoke"),
    )
    chunk: int = key(
        480,
        "films are built so many frames at a time, which bounds memory; 0: all at once",
        at_least=0,
        at_most=_LARGEST_SEED,
        shows=("ground", "forest", "fire"),
    )
    thermal_low: float | None = key(
        None,
        "where the thermal picture's palette begins; left out, the moment's coldest ground",
        unit="K",
        above=0,
        at_most=10_000,
        shows=("thermal",),
    )
    thermal_high: float = key(800.0, "where it ends", unit="K", shows=("thermal",), above=0, at_most=10_000)

    def wrong(self) -> tuple[Where, str] | None:
        """The thermal picture's colours have a range."""
        if self.thermal_low is not None and self.thermal_high <= self.thermal_low:
            return ("thermal_high",), "render.thermal_high must be above render.thermal_low"
        return None


@dataclass(frozen=True)
class Settings:
    """All settings of one scene file."""

    path: Path = Path("scene.toml")  # the file itself; relative paths in it start at its folder
    run: Path = key(Path("sample"), "run folder, such as `firetwin sample` writes", shows=())
    cache: Path = key(Path("cache"), "smoke volumes are kept here and used again", shows=())
    seed: int = key(
        1,
        "another number gives other trees, flames and puffs in the same fire",
        at_least=0,
        at_most=_LARGEST_SEED,
        shows=("ground", "forest", "fire", "smoke"),
    )
    time: Time = key(default_factory=Time, help="which moments of the run the frames show")
    ground: Ground = key(default_factory=Ground, help="its grid, as fine as cameras see it")
    forest: Forest = key(default_factory=Forest, help="trees and grass")
    fire: Fire = key(default_factory=Fire, help="flames, firebrands and the glowing ground")
    smoke: Smoke = key(default_factory=Smoke, help="the smoke volume")
    light: Light = key(default_factory=Light, help="sun, haze, exposure and the light of the flames")
    places: Places = key(default_factory=Places, help="labels of towns, lakes and summits in the picture")
    thermal: Thermal = key(default_factory=Thermal, help="the infrared camera of the thermal view")
    render: Render = key(default_factory=Render, help="how frames are made")
    runs: tuple[OtherRun, ...] = key((), "another run beside the first, same cameras and clock; at most 3")
    cameras: tuple[Camera, ...] = key((), "a camera and what it records", shows=("camera",))

    def wrong(self) -> tuple[Where, str] | None:
        """Names of cameras differ, and their frames are among those of the scene."""
        i = twice([camera.name for camera in self.cameras])
        if i is not None:
            reason = (
                f'a second camera is named "{self.cameras[i].name}"; names must differ, not by capitals alone'
            )
            return ("cameras", i, "name"), reason
        for i, camera in enumerate(self.cameras):
            try:
                frame_list.parse(camera.frames, self.time.frames)
            except ValueError as error:
                return ("cameras", i, "frames"), f"cameras.frames: {error}"
        return self._leaderless() or self._impossible() or self._alone()

    def _alone(self) -> tuple[Where, str] | None:
        """What is wrong with the other runs, or asked of them and there are none."""
        names = [each.name for each in self.runs]
        i = twice(names)
        if i is not None:
            reason = f'a second run is named "{names[i]}"; names must differ, not by capitals alone'
            return ("runs", i, "name"), reason
        if len(names) > MOST_RUNS:
            reason = f"runs has {len(names)} tables; beside the first run at most {MOST_RUNS}"
            return ("runs", MOST_RUNS), reason
        for where, listed in (
            (("render", "passes"), self.render.passes),
            *((("cameras", i, "passes"), camera.passes) for i, camera in enumerate(self.cameras)),
        ):
            if not names and (found := [name for name in listed if passes.known()[name].compares]):
                return where, f'passes has "{found[0]}", which compares runs; add [[runs]] or leave it out'
        return None

    def _impossible(self) -> tuple[Where, str] | None:
        """What is asked of cameras and cannot be."""
        for i, camera in enumerate(self.cameras):
            width, height = camera.resolution or self.render.resolution
            if camera.rig.around and self.render.engine != "cycles":
                reason = f'camera "{camera.name}" sees all round, which EEVEE cannot; render it with Cycles'
                return ("cameras", i, "kind"), reason
            for each in passes.of_camera(self, camera):
                if reason := passes.refused(each, camera, self.render.engine):
                    return ("cameras", i, "passes") if camera.passes else ("render", "passes"), reason
            if camera.rig.around and width != height:
                reason = (
                    f'camera "{camera.name}" needs a square resolution, such as [2048, 2048]: two pictures '
                    f"one above the other, each twice as wide as high; it has {width} x {height}"
                )
                return ("cameras", i, "resolution"), reason
        return None

    def _leaderless(self) -> tuple[Where, str] | None:
        for i, camera in enumerate(self.cameras):
            name = getattr(camera.rig, "follows", "")
            if name and camera.rig.leader(self.cameras) is None:
                others = [each.name for each in self.cameras if not hasattr(each.rig, "follows")]
                reason = f'camera "{camera.name}" follows "{name}", and no other camera has this name'
                return ("cameras", i, "follows"), reason + suggestion(name, others)
        return None
