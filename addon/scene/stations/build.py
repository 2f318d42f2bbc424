"""Stations: signs and routes in "Firetwin Stations", visible to cameras only, and solid buildings."""

from __future__ import annotations

from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.stations import station_signs
from . import buildings, handles, routes, signs


def build(shot: Shot, stage: Stage) -> None:
    """Build signs, buildings, handles and routes; nothing if stations are off."""
    settings = shot.settings.stations
    written, walls = stage.part("Stations"), stage.part("Buildings")
    shown = station_signs.make_signs(shot)
    if shown and settings.signs:
        signs.build(shot, written, shown)
    if shown and settings.buildings:
        buildings.build(shot, stage, walls, shown)
    handles.build(shot, written, shown)
    routes.build(shot, written, station_signs.make_routes(shot, shown))
