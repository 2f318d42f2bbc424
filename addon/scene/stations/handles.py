"""Handles of stations: empties that a click in the 3D view selects; they are not rendered."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ...blender import owned
from ...shot.shot import Shot
from ...shot.stations.station_signs import Sign

STATION = "firetwin_station"
"""Property of a handle: number and name of its station, as in `listing.station_key`."""

_RADIUS = 60.0  # m


def build(shot: Shot, collection: bpy.types.Collection, shown: Sequence[Sign]) -> None:
    """Build "Firetwin Station <name>" for each sign."""
    if not shown:
        return
    position = shot.ground.point([each.latitude for each in shown], [each.longitude for each in shown])
    for sign, place in zip(shown, position, strict=True):
        obj = owned.add(collection, f"Station {sign.name}", None)
        obj.empty_display_type, obj.empty_display_size = "SPHERE", _RADIUS
        obj.show_in_front, obj.location = True, place
        obj[STATION] = f"{sign.id} {sign.name}"
