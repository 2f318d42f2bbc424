"""Place names: the user's list of [labels], or else the known places of the run's fire."""

from __future__ import annotations

import functools
from pathlib import Path

import bpy

from ..errors import Error
from ..run import labels
from ..shot.schema import fields
from ..shot.sections import TileSettings
from ..stations import reading
from ..stations.records import Station
from ..tiles import policies
from . import run, sections


def refusal(panel: bpy.types.PropertyGroup) -> str:
    """Why place names must not be searched beside the panel's tiles; empty: they may."""
    parts = tuple(part for part in fields(TileSettings) if part.name == "sources")
    try:
        sources = sections.take(panel.tiles, parts, TileSettings()).sources
    except Error:  # a text that is half typed
        return ""
    for place in sources:
        policy = policies.of_place(place)
        if not policy.other_geocoder:
            return f"{policy.name} allows no other gazetteer than its own; coordinates work"
    return ""


def known(panel: bpy.types.PropertyGroup) -> tuple[labels.Label, ...]:
    """All place names; empty if the user's list cannot be read, which building the labels reports.

    Also empty where a policy of tiles forbids the search (see `refusal`).
    """
    if refusal(panel):
        return ()
    if not panel.labels.file:
        places = run.read(panel.facts).get("places", ()) if panel.facts else ()
        return tuple(labels.Label(*each) for each in places)
    path = Path(bpy.path.abspath(panel.labels.file))
    try:
        return _read(path, path.stat().st_mtime_ns)
    except (Error, OSError):
        return ()


def stations(panel: bpy.types.PropertyGroup) -> tuple[Station, ...]:
    """Stations of the user's file; empty if it cannot be read, which building them reports."""
    if not panel.stations.file:
        return ()
    path = Path(bpy.path.abspath(panel.stations.file))
    try:
        return _read_stations(path, path.stat().st_mtime_ns)
    except (Error, OSError):
        return ()


@functools.lru_cache(maxsize=4)
def _read_stations(path: Path, changed: int) -> tuple[Station, ...]:
    return reading.read(path).stations


@functools.lru_cache(maxsize=4)
def _read(path: Path, changed: int) -> tuple[labels.Label, ...]:
    return tuple(labels.read(path))


def find(panel: bpy.types.PropertyGroup, text: str) -> labels.Label | Station | None:
    """The place or station of this name, or the first whose name contains it."""
    wanted = text.strip().lower()
    every: list[labels.Label | Station] = [*known(panel), *stations(panel)]
    matches = [place for place in every if wanted and wanted in place.name.lower()]
    return min(matches, key=lambda place: place.name.lower() != wanted, default=None)


class FIRETWIN_MT_named(bpy.types.Menu):
    """Point the scene's camera at a town, lake, summit or station of the list of places"""

    bl_idname = "FIRETWIN_MT_named"
    bl_label = "Look at a Place"

    def draw(self, context: bpy.types.Context) -> None:
        places = known(context.scene.firetwin)
        for place in places:
            aim = self.layout.operator("firetwin.camera_aim", text=place.name)
            aim.target, aim.place = "station", place.name
        if not places:
            self.layout.label(text="No places are known: choose a file under Labels", icon="INFO")


classes = (FIRETWIN_MT_named,)
