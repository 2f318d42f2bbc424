"""Map of the listed stations, as an image and in the sidebar; a timer draws it while it is visible."""

from __future__ import annotations

import functools
from collections.abc import Iterator

import bpy
import bpy.utils.previews
import numpy as np

from ..blender import owned, text
from ..run import times
from ..stations import listing, picture
from ..stations.records import EXERCISE
from . import station_filter, station_list, station_selection, station_sync, working

IMAGE = "Firetwin Stations Map"
NO_MAP = "No station file has been read"
_SIZE, _EDGE = 22, 6  # pixels: size of the text on the map, and margin around it

_drawn: tuple[object, ...] | None = None
_kept: list[bpy.utils.previews.ImagePreviewCollection] = []


def changed(panel: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Schedule an update after the map was shown or hidden in the sidebar (update callback)."""
    station_sync.wake()


def icon() -> int:
    """Return the icon number of the picture in the sidebar; 0: not drawn."""
    return _kept[0]["map"].icon_id if _kept else 0


def image() -> bpy.types.Image | None:
    """Return the image of the map, if there is one."""
    found = bpy.data.images.get(IMAGE)
    return found if found is not None and owned.is_ours(found) else None


def editors() -> Iterator[bpy.types.Area]:
    """Iterate over the image editors that show the map."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and _shows(area.spaces.active):
                yield area


def update(scene: bpy.types.Scene, always: bool = False) -> None:
    """Draw the map if it is visible and its content has changed."""
    global _drawn
    panel, now = scene.firetwin, station_list.shown()
    seen = (panel.station_map, next(editors(), None) is not None)
    if not (always or any(seen)) or now.loaded is None or now.loaded.plan is None:
        return
    time = model_time(panel, now.loaded)
    state = (now.stamp, panel.station, time, seen, None if (held := image()) is None else held.session_uid)
    if state == _drawn and not always:
        return
    _drawn = state
    stations = [each.station for each in now.rows]
    origins = ["exercise" if each.exercise else each.station.origin for each in now.rows]
    place = station_list.place(panel)
    pixels = picture.draw(
        now.loaded.plan,
        time,
        [each.latitude for each in stations],
        [each.longitude for each in stations],
        origins,
        place if place >= 0 else None,
    )
    if "exercise" in origins:
        _mark_exercise(pixels)
    if held is not None:
        held.pixels.foreach_set(pixels.ravel())
        held.update()
    if panel.station_map:
        _preview(pixels)


def model_time(panel: bpy.types.PropertyGroup, loaded: station_list.Loaded) -> float:
    """Return the model time of the current frame, s; before a build, the end of the run."""
    if loaded.run is None:
        return 0.0
    shown = station_filter.shown_time(panel)
    return float(loaded.run.times[-1]) if shown is None else times.seconds(loaded.run, shown)


def station_at(up: float, along: float) -> str | None:
    """Return the key of the listed station nearest to a point of the map, 0 to 1; None without stations."""
    now = station_list.shown()
    if now.loaded is None or now.loaded.plan is None:
        return None
    stations = [each.station for each in now.rows]
    row = now.loaded.plan.nearest(
        [each.latitude for each in stations], [each.longitude for each in stations], (up, along)
    )
    return None if row is None else listing.station_key(stations[row])


def clear() -> None:
    """Free the picture in the sidebar."""
    global _drawn
    _drawn = None
    while _kept:
        bpy.utils.previews.remove(_kept.pop())


def _mark_exercise(pixels: np.ndarray) -> None:
    """Write that the map is an exercise on a dark strip at its lower left, south first."""
    opacity = _exercise_text()[::-1, :, None]
    strip = pixels[: opacity.shape[0], : opacity.shape[1], :3]
    strip *= 0.2
    strip += opacity * (np.array(picture.COLOURS["exercise"], np.float32) - strip)


@functools.cache
def _exercise_text() -> np.ndarray:
    """Draw the sentence that maps of an exercise carry, as opacity (h, w)."""
    width = round(text.measure_width(EXERCISE, _SIZE)) + 2 * _EDGE
    return text.draw_lines([text.Line(EXERCISE, _SIZE, _EDGE, 1.5 * _EDGE)], width, _SIZE + 2 * _EDGE)


def _shows(space: bpy.types.Space) -> bool:
    return space.image is not None and space.image.name == IMAGE and owned.is_ours(space.image)


def _preview(pixels: np.ndarray) -> None:
    """Copy the picture to the icon in the sidebar."""
    if not _kept:
        _kept.append(bpy.utils.previews.new())
        _kept[0].new("map")
    held = _kept[0]["map"]
    held.image_size = held.icon_size = pixels.shape[1::-1]
    held.image_pixels_float.foreach_set(pixels.ravel())
    held.icon_pixels_float.foreach_set(pixels.ravel())


def _can_show(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    loaded = station_list.shown().loaded
    if loaded is None or loaded.plan is None:
        cls.poll_message_set(NO_MAP)
        return False
    return working.is_editable(cls, context)


class FIRETWIN_OT_station_map(bpy.types.Operator):
    """Show the map of stations in an open image editor, or in a new window"""

    bl_idname = "firetwin.station_map"
    bl_label = "Show station map"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _can_show(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        if (held := image()) is None:
            held = owned.mark(bpy.data.images.new(IMAGE, picture.SIDE, picture.SIDE, alpha=True))
            held.name = IMAGE
        if not bpy.app.background and context.window is not None:
            self._show(context, held)
        update(context.scene, always=True)
        return {"FINISHED"}

    def _show(self, context: bpy.types.Context, held: bpy.types.Image) -> None:
        """Show the image in an editor."""
        areas = [area for area in context.screen.areas if area.type == "IMAGE_EDITOR"]
        if not areas:
            bpy.ops.wm.window_new()
            area = context.window_manager.windows[-1].screen.areas[0]
            area.type = "IMAGE_EDITOR"
            areas = [area]
        areas[0].spaces.active.image = held


class FIRETWIN_OT_station_pick(bpy.types.Operator):
    """Select a station with a click on the map; Esc cancels"""

    bl_idname = "firetwin.station_pick"
    bl_label = "Pick station on map"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _can_show(cls, context):
            return False
        if context.screen is None or not any(area in list(editors()) for area in context.screen.areas):
            cls.poll_message_set("Show the map in an image editor of this window first")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        context.window_manager.modal_handler_add(self)
        context.window.cursor_modal_set("CROSSHAIR")
        context.workspace.status_text_set("Click a station on the map    Esc cancels")
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in ("ESC", "RIGHTMOUSE"):
            self._end(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"}
        point = _under(context.screen, event.mouse_x, event.mouse_y)
        key = None if point is None else station_at(*point)
        if key is None:
            return {"PASS_THROUGH"}
        self._end(context)
        station_selection.select(context.scene, key)
        working.redraw()
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """End picking, as another file is opened or Blender quits."""
        self._end(context)

    def _end(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


def _under(screen: bpy.types.Screen, x: int, y: int) -> tuple[float, float] | None:
    """Return the point of the map (up, along), 0 to 1, under the pointer; None outside of the map."""
    for area in screen.areas:
        if area.type != "IMAGE_EDITOR" or not _shows(area.spaces.active):
            continue
        for region in area.regions:
            inside = 0 <= x - region.x < region.width and 0 <= y - region.y < region.height
            if region.type == "WINDOW" and inside:
                along, up = region.view2d.region_to_view(x - region.x, y - region.y)
                if 0.0 <= along <= 1.0 and 0.0 <= up <= 1.0:
                    return up, along
    return None


classes = (FIRETWIN_OT_station_map, FIRETWIN_OT_station_pick)
