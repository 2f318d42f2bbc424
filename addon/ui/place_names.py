"""Place names: the user's list in [labels], or else the known places of the run's fire."""

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


def explain_refusal(panel: bpy.types.PropertyGroup) -> str:
    """Explain why the tiles' policy forbids a search for place names; empty if it is allowed."""
    parts = tuple(part for part in fields(TileSettings) if part.name == "sources")
    try:
        sources = sections.take(panel.tiles, parts, TileSettings()).sources
    except Error:  # an incomplete text
        return ""
    for place in sources:
        policy = policies.for_source(place)
        if not policy.other_geocoder:
            return f"{policy.name} allows no place names from another source; type coordinates"
    return ""


def list_labels(panel: bpy.types.PropertyGroup) -> tuple[labels.Label, ...]:
    """Return all place names; empty if the user's list is invalid, which the labels' build reports.

    Also empty if a policy of tiles forbids the search (see `explain_refusal`).
    """
    if explain_refusal(panel):
        return ()
    if not panel.labels.file:
        return tuple(labels.Label(*each) for each in run.parse_facts(panel.facts)["places"])
    path = Path(bpy.path.abspath(panel.labels.file))
    try:
        return _read(path, path.stat().st_mtime_ns)
    except (Error, OSError):
        return ()


def list_stations(panel: bpy.types.PropertyGroup) -> tuple[Station, ...]:
    """Return stations of the user's file; empty if it is invalid, which building them reports."""
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


def find_place(panel: bpy.types.PropertyGroup, text: str) -> labels.Label | Station | None:
    """Return the place or station of this name, or the first whose name contains it."""
    wanted = text.strip().lower()
    every: list[labels.Label | Station] = [*list_labels(panel), *list_stations(panel)]
    matches = [place for place in every if wanted and wanted in place.name.lower()]
    return min(matches, key=lambda place: place.name.lower() != wanted, default=None)


class FIRETWIN_MT_named(bpy.types.Menu):
    """Point the scene's camera at a town, lake, summit or station of the list of places"""

    bl_idname = "FIRETWIN_MT_named"
    bl_label = "Look at a Place"

    def draw(self, context: bpy.types.Context) -> None:
        places = list_labels(context.scene.firetwin)
        for place in places:
            aim = self.layout.operator("firetwin.camera_aim", text=place.name)
            aim.target, aim.place = "station", place.name
        if not places:
            self.layout.label(text="No places are known: choose a file under Labels", icon="INFO")


classes = (FIRETWIN_MT_named,)
