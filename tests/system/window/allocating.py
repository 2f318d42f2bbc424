"""The panel of a suggested allocation, with the stations of an exercise."""

from __future__ import annotations

import json
from collections.abc import Iterator

import bpy
from hands import FOLDER, alone, call, check, idle, picture, ready, settings, view
from mathutils import Quaternion, Vector


def allocate() -> Iterator[object]:
    """Suggest an allocation in the documented example's hours; its lines are in the 3D view."""
    yield from ready()
    panel = settings()
    panel.stations.file = str(FOLDER / "exercise.gpkg")
    panel.allocation_from, panel.allocation_hours, panel.allocation_budget = "frame", 6, 250_000.0
    yield 2
    yield idle
    call(bpy.ops.firetwin.allocate)
    yield 1
    yield idle
    yield 1
    found = json.loads(settings().allocation or "{}")
    check(bool(found), "an allocation is suggested")
    held = [each["name"] for each in found.get("divisions", ()) if each["contained_at_hour"] is not None]
    check(bool(held), f"divisions that can be held: {', '.join(held)}")
    lines = [thing for thing in bpy.context.scene.objects if thing.name.startswith("Firetwin Line")]
    check(bool(lines), f"control lines in the scene: {', '.join(thing.name for thing in lines)}")
    corners = [Vector(corner) for thing in lines for corner in thing.bound_box]
    region = view().spaces.active.region_3d
    region.view_perspective, region.view_rotation = "PERSP", Quaternion()
    region.view_location = sum(corners, Vector()) / len(corners)
    region.view_distance = 2.0 * max((corner - region.view_location).length for corner in corners)
    yield 4
    yield from alone("FIRETWIN_PT_allocation", lambda: picture("56-allocation"))
