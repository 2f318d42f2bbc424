"""Sections of a scene file: type, default, unit, bounds, choices, help and affected aspects of every key.

The scene file, its validation, the panels, the JSON Schema and the fingerprints of products derive from here.
Times are UTC, lengths metres and angles degrees. A key affects the aspect of its section unless it names
others: "camera" for everything of a camera, and in [render] "picture" (all pictures), "grain" (all but data),
"colour" (rgb) and "thermal". "film" is for films only, "sidecar" for the lists in sidecars.
"""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ..schema import key
from .fire import FireSettings
from .forecast import ForecastSettings
from .forest import Forest
from .light import Light
from .smoke import SmokeSettings
from .stations import LabelSettings, StationSettings
from .terrain import TerrainSettings
from .thermal import Thermal
from .tiles import TileSettings
from .time import Time

LARGEST_SEED = 2**31 - 1  # upper limit in Cycles


@dataclass(frozen=True)
class SceneSettings:
    """Settings of a scene without its cameras and pictures."""

    path: Path = Path("scene.toml")  # the file itself; relative paths in it start at its folder
    notes: tuple[str, ...] = field(default=(), compare=False)  # warnings of its reader
    run: Path = key(Path("sample"), "run folder, such as `firetwin sample` writes", affects=())
    cache: Path = key(Path("cache"), "folder of smoke volumes, for reuse", affects=())
    seed: int = key(
        1,
        "random seed of trees, flames and smoke; the fire stays the same",
        at_least=0,
        at_most=LARGEST_SEED,
        affects=("terrain", "forest", "fire", "smoke"),
    )
    time: Time = key(default_factory=Time, help="model times that the frames show")
    terrain: TerrainSettings = key(
        default_factory=TerrainSettings,
        help="the run's grid, relief near the cameras and an apron to the horizon",
    )
    tiles: TileSettings = key(default_factory=TileSettings, help="3D Tiles as ground")
    forest: Forest = key(default_factory=Forest, help="trees and grass")
    fire: FireSettings = key(default_factory=FireSettings, help="flames, firebrands and glowing ash")
    forecast: ForecastSettings = key(
        default_factory=ForecastSettings, help="other members of the forecast, in the forecast pass"
    )
    smoke: SmokeSettings = key(default_factory=SmokeSettings, help="the smoke volume")
    light: Light = key(default_factory=Light, help="haze, exposure and the light of the flames")
    labels: LabelSettings = key(
        default_factory=LabelSettings, help="labels of towns, lakes and summits in the picture"
    )
    stations: StationSettings = key(
        default_factory=StationSettings, help="stations, their buildings and routes to the fire"
    )
    thermal: Thermal = key(default_factory=Thermal, help="simulated infrared camera of the thermal passes")
