"""Go-to operator: moves the view to coordinates, a name or a date, smoothly or at once."""

from __future__ import annotations

import re
import time
import zoneinfo
from datetime import UTC, datetime

import bpy
from mathutils import Euler, Quaternion, Vector

from ..blender import owned
from ..escaped import escaped
from ..scene.camera import ground_raycast, read_edits
from . import coordinates, events, landmarks, place_names, working
from .navigation import can_navigate, find_view

_DATE = re.compile(r"\s*(\d{4}-\d\d-\d\d)[ T](\d\d?:\d\d)\s*(Z|UTC)?\s*", re.IGNORECASE)
_TILTS = (1.05, 0.8, 0.5, 0.2, 0.0)  # rad from straight down, tilts of views at the end of a flight
_CLEARANCE = 30.0  # m, clearance of the viewpoint above the terrain
_SHOWN = 40  # names per kind in the menu
_SECONDS, _STEP = 1.5, 1.0 / 30.0  # s of the flight, and between its redraws


def parse_time(panel: bpy.types.PropertyGroup, text: str) -> datetime | None:
    """Parse a time: date and time, or the text of a reported event."""
    if match := _DATE.fullmatch(text):
        zone = UTC if match[3] else zoneinfo.ZoneInfo(panel.zone)
        return datetime.fromisoformat(f"{match[1]} {match[2]:0>5}").replace(tzinfo=zone).astimezone(UTC)
    event = events.find_event(panel, text)
    return None if event is None else event.time


def nearest_frame(panel: bpy.types.PropertyGroup, when: datetime) -> int:
    """Return the frame of a time, or the nearest one."""
    passed = (when - datetime.fromisoformat(panel.first_time)).total_seconds()
    frame = 1 + round(passed / panel.seconds_per_frame) if panel.seconds_per_frame else 1
    return min(max(frame, 1), panel.frames)


def find_position(scene: bpy.types.Scene, text: str) -> Vector | None:
    """Return the scene position of a text: coordinates on the terrain, head or ignition, or a name.

    The name may belong to a place, a station or an object.
    """
    stage, pair = owned.stage(scene), coordinates.parse(text)
    if pair is None and (found := landmarks.find(scene.firetwin, text)):
        return found
    if pair is None and (label := place_names.find_place(scene.firetwin, text)):
        pair = label.latitude, label.longitude
    if pair:
        east, north, _ = read_edits.built_frame(stage).forward([pair[0]], [pair[1]], [0.0])[0]
        ground = ground_raycast.terrain_height(stage, (east, north))
        return None if ground is None else Vector((east, north, ground))
    wanted = text.strip().lower()
    matches = [obj for obj in scene.objects if wanted and wanted in obj.name.lower()]
    matches.sort(key=lambda obj: (obj.name.lower() != wanted, len(obj.name)))
    return matches[0].matrix_world.translation.copy() if matches else None


class FIRETWIN_OT_go(bpy.types.Operator):
    """Move this view to coordinates, a name, a date or a reported event"""

    bl_idname = "firetwin.go"
    bl_label = "Go to place or time"
    bl_options = {"REGISTER", "UNDO_GROUPED"}  # views have no undo, but the frame has
    bl_undo_group = "Frame Change"

    text: bpy.props.StringProperty(name="Where", description="Place, date or event; empty: the text of Go to")
    smooth: bpy.props.BoolProperty(
        name="Smooth", description="Move the view smoothly; off: cut to it", default=True
    )
    distance: bpy.props.FloatProperty(
        name="Distance", description="Distance from the place", default=2500.0, min=1.0, unit="LENGTH"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_navigate(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.text or context.scene.firetwin.go_to:
            return self.execute(context)
        return context.window_manager.invoke_props_dialog(self)  # from F3: ask where

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, text = context.scene, self.text or context.scene.firetwin.go_to
        where, when = find_position(scene, text), None
        if where is None and (when := parse_time(scene.firetwin, text)) is not None:
            scene.frame_set(nearest_frame(scene.firetwin, when))
            self.report({"INFO"}, f"Frame {scene.frame_current}, the nearest to {when:%d %b %Y %H:%M} UTC")
            event = events.find_event(scene.firetwin, text)
            where = find_position(scene, event.place) if event and event.place else None
        if where is None and when is None:
            self.report({"WARNING"}, _explain_unknown(scene.firetwin, text))
            return {"CANCELLED"}
        shown = find_view(context)
        if where is not None and shown is not None:
            _fly_view(context, shown.region_3d, where, self.distance, self.smooth and not bpy.app.background)
        return {"FINISHED"}


def _explain_unknown(panel: bpy.types.PropertyGroup, text: str) -> str:
    """Explain why a text is not a destination."""
    words = f'"{escaped(text)}" is not a known name, nor coordinates on the terrain'
    why = place_names.explain_refusal(panel)
    return f"{words}. {why}" if why else words


def _fly_view(
    context: bpy.types.Context,
    region: bpy.types.RegionView3D,
    where: Vector,
    distance: float,
    smooth: bool,
) -> None:
    """Move the view to a point, keeping its distance and direction."""
    if region.view_perspective == "CAMERA":
        camera = context.scene.camera.matrix_world
        region.view_perspective, region.view_distance = "PERSP", distance
        region.view_rotation = camera.to_quaternion()
        region.view_location = camera.translation - camera.col[2].to_3d() * distance
    start = region.view_location.copy(), region.view_rotation.copy(), region.view_distance
    bearing = region.view_rotation.to_euler().z
    end = where, view_from_above(owned.stage(context.scene), where, bearing, distance), distance
    if not smooth:
        _flight_point(region, start, end, 1.0)
        return
    began = time.monotonic()  # a slow window draws fewer frames in the same time

    def step() -> float | None:
        part = min((time.monotonic() - began) / _SECONDS, 1.0)
        try:
            _flight_point(region, start, end, part * part * (3.0 - 2.0 * part))
        except ReferenceError:  # the window was closed, or another file opened
            return None
        return _STEP if part < 1.0 else None

    bpy.app.timers.register(step)


def view_from_above(stage: owned.Stage, where: Vector, bearing: float, distance: float) -> Quaternion:
    """Return the rotation of a view that looks at a point from above the terrain, as flat as possible."""
    for tilt in _TILTS:
        turn = Euler((tilt, 0.0, bearing)).to_quaternion()
        eye = where + turn @ Vector((0.0, 0.0, distance))
        ground = ground_raycast.terrain_height(stage, eye)
        if ground is None or eye.z > ground + _CLEARANCE:
            break
    return turn


def _flight_point(
    region: bpy.types.RegionView3D,
    start: tuple[Vector, Quaternion, float],
    end: tuple[Vector, Quaternion, float],
    part: float,
) -> None:
    """Return a point of the flight at a fraction of its path, which arcs upwards for orientation."""
    region.view_location = start[0].lerp(end[0], part)
    region.view_rotation = start[1].slerp(end[1], part)
    over = 0.5 * (end[0] - start[0]).length * 4.0 * part * (1.0 - part)
    region.view_distance = start[2] + (end[2] - start[2]) * part + over


class FIRETWIN_MT_go(bpy.types.Menu):
    """Go to the head of the fire, the ignition, a station, a place, or the time of an event"""

    bl_idname = "FIRETWIN_MT_go"
    bl_label = "Go to Place"

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        groups = (
            ("FORCE_TURBULENCE", landmarks.list_names(panel)),
            ("HOME", [each.name for each in place_names.list_stations(panel)[:_SHOWN]]),
            ("BOOKMARKS", [each.name for each in place_names.list_labels(panel)[:_SHOWN]]),
            ("TIME", [each.words for each in events.list_events(panel)][:_SHOWN]),
        )
        for icon, names in groups:
            for name in names:
                pressed = layout.operator(FIRETWIN_OT_go.bl_idname, text=name, icon=icon)
                pressed.text, pressed.smooth = name, panel.go_smoothly
            if names:
                layout.separator()
        layout.prop(panel, "go_smoothly")


classes = (FIRETWIN_OT_go, FIRETWIN_MT_go)
