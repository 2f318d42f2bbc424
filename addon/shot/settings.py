"""The scene file: TOML -> dataclasses, with every default in one place.

Times are UTC in the file and in memory, lengths are metres, angles are degrees.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path


@dataclass(frozen=True)
class Time:
    """Which model times the frames show; frames are spread evenly from `start` to `end`."""

    start: datetime | None = None  # model time of the first frame; None: the run's first
    end: datetime | None = None  # model time of the last frame; None: the run's last
    frames: int = 48
    fps: int = 24
    zone: str = "America/Los_Angeles"  # for the time burnt into video frames


@dataclass(frozen=True)
class Terrain:
    """The ground: the model's grid, finer near cameras, and an apron out to the horizon."""

    near_radius: float = 4000.0  # finer relief and ground detail within this distance of a camera, m
    near_spacing: float = 12.0  # vertex spacing there, m
    apron: float = 110_000.0  # half-width of the ground drawn round the model's domain, m


@dataclass(frozen=True)
class Forest:
    """Trees and grass."""

    trees: bool = True
    grass: bool = True
    stand_spacing: float = 13.0  # spacing of the stand drawn near cameras round Algorithm 2's trees, m
    stand_radius: float = 3400.0  # m; 0 draws Algorithm 2's trees alone
    draw_distance: float = 12_000.0  # m; trees farther than this are part of the ground's colour


@dataclass(frozen=True)
class Fire:
    """Flames, firebrands and the glowing ground."""

    emitters: str = "front"  # "front": along the fire line; "cells": Algorithm 1, one per model cell
    flames: bool = True
    flame_length: str = "thomas"  # or "byram"
    budget: int = 20_736  # most flames or emitters drawn at once, nearest first
    embers: bool = True  # spots that glow in the ash; the thermal view shows their heat in any case
    firebrands: int = 3000  # most glowing pieces in the air at once, near the cameras
    torches: bool = True  # crowns near the cameras that flare up as the front reaches them


@dataclass(frozen=True)
class Smoke:
    """The smoke volume."""

    enabled: bool = True
    voxel_size: float = 0.0  # m; 0 chooses it from the distance of the nearest camera
    max_age: float = 5400.0  # s; older smoke has left the picture
    extinction: float = 0.0  # 1/m inside fresh smoke; 0 chooses it from the camera's distance
    complete: bool = False  # write smoke that no camera sees too, and the grids "temperature" and "flame"


@dataclass(frozen=True)
class Light:
    """Sun, sky, haze, exposure and the light of the flames."""

    haze: float = 1.0  # 0 none, 1 a dry September day
    exposure: float | None = None  # stops; None: from the height of the sun
    lamps: int = 48  # at most this many light ground and trees in place of the flames, when the sun is low


@dataclass(frozen=True)
class CameraKey:
    """Where a camera is at one moment of the shot."""

    at: float = 0.0  # 0 first frame, 1 last frame
    latitude: float = 0.0
    longitude: float = 0.0
    height: float = 300.0  # above the ground, m
    target: str = "point"  # "point", "head" (the fastest part of the front) or "fire" (its middle)
    target_latitude: float = 0.0
    target_longitude: float = 0.0
    target_height: float = 0.0  # above the ground, m


@dataclass(frozen=True)
class Camera:
    """A camera; a satellite looks straight down and covers `swath` metres."""

    name: str = "drone"
    kind: str = "drone"  # "drone" (perspective) or "satellite" (orthographic, straight down)
    focal_length: float = 28.0  # mm on a 36 mm wide sensor
    swath: float = 56_000.0  # width of a satellite's picture, m
    passes: tuple[str, ...] = ()  # empty: those of [render]
    frames: str = ""  # such as "24" or "1-48:4"; empty: all
    keys: tuple[CameraKey, ...] = ()


@dataclass(frozen=True)
class Render:
    """How frames are made."""

    engine: str = "cycles"  # or "eevee"
    resolution: tuple[int, int] = (640, 360)
    samples: int = 6
    denoise: bool = True
    passes: tuple[str, ...] = ("rgb", "depth", "thermal")
    video: bool = True
    seed: int = 0
    thermal_low: float = 320.0  # K where colour begins in the thermal picture: ground in the sun has less
    thermal_high: float = 800.0  # K shown white


@dataclass(frozen=True)
class Project:
    """One scene file."""

    path: Path = Path("scene.toml")  # the file itself; relative paths start at its folder
    run: Path = Path("sample")  # the run folder
    cache: Path = Path("cache")  # smoke volumes are kept here
    seed: int = 1
    time: Time = field(default_factory=Time)
    terrain: Terrain = field(default_factory=Terrain)
    forest: Forest = field(default_factory=Forest)
    fire: Fire = field(default_factory=Fire)
    smoke: Smoke = field(default_factory=Smoke)
    light: Light = field(default_factory=Light)
    cameras: tuple[Camera, ...] = ()
    render: Render = field(default_factory=Render)


def load(path: str | Path) -> Project:
    """Read and check a scene file (see `scene_file.read`)."""
    from . import scene_file  # it imports this module

    return scene_file.read(path)
