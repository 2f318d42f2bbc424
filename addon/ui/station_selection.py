"""Selected station, shared by the list, the map and the 3D view.

Handles in the 3D view store number and name of their station, so the selection survives undo, saving and a
change of the Blender version. The active selected handle defines the selected station; as undo restores the
selection of objects, it also restores the station.
"""

from __future__ import annotations

import bpy

from ..blender import owned
from ..scene.stations.handles import STATION
from . import station_list, station_sync, working


def position(panel: bpy.types.PropertyGroup) -> int:
    """Return the row of the selected station (getter of a property)."""
    return station_list.place(panel)


def choose(panel: bpy.types.PropertyGroup, index: int) -> None:
    """Select the station of a row (setter of a property)."""
    for key, row in station_list.shown().place.items():
        if row == index:
            select(panel.id_data, key)


def select(scene: bpy.types.Scene, key: str) -> None:
    """Select a station, and its handle in the 3D view if it has one."""
    scene.firetwin.station = key
    _select_handle(scene, key)
    station_list.describe(scene.firetwin)
    station_sync.wake()


def handles(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return the handles of the built stations."""
    if not owned.has_data(scene):
        return []
    return [obj for obj in owned.stage(scene).objects_of("Stations") if STATION in obj]


def _select_handle(scene: bpy.types.Scene, key: str) -> None:
    """Select only the handle of a station; deselect all handles if it has none."""
    context = bpy.context
    layer = context.view_layer if context.scene == scene else scene.view_layers[0]
    active, built = layer.objects.active, handles(scene)
    if active is not None and active.mode != "OBJECT":
        return
    match = next((obj for obj in built if obj[STATION] == key and obj.name in layer.objects), None)
    for obj in [*layer.objects.selected] if match is not None else built:
        if obj.name in layer.objects:
            obj.select_set(False, view_layer=layer)
    if match is not None:
        match.select_set(True, view_layer=layer)
        layer.objects.active = match
    elif active in built:
        layer.objects.active = None


@bpy.app.handlers.persistent
def follow(scene: bpy.types.Scene, graph: bpy.types.Depsgraph | None = None) -> None:
    """Select the station of the active selected handle after a change in the 3D view."""
    if graph is None or graph.mode != "VIEWPORT" or not hasattr(scene, "firetwin"):
        return
    layer, panel = graph.view_layer, scene.firetwin
    obj = layer.objects.active
    key = None if obj is None else obj.get(STATION)
    if not isinstance(key, str) or key == panel.station or not obj.select_get(view_layer=layer):
        return
    panel.station = key
    station_list.describe(panel)
    station_sync.wake()
    working.redraw()


def register() -> None:
    """Follow the 3D view in every file."""
    bpy.app.handlers.depsgraph_update_post.append(follow)


def unregister() -> None:
    """Stop following the 3D view."""
    if follow in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(follow)
