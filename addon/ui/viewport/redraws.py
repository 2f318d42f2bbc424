"""Time of a frame in a 3D view: change to the next frame, and redraw the view."""

from __future__ import annotations

import statistics
import time

import bpy

_MOST, _SECONDS = 10, 3.0  # frames that are timed, and time after which no other one begins


def find_view(context: bpy.types.Context) -> dict[str, object] | None:
    """Return the context of a 3D view that shows the scene; None without a window."""
    for window in () if bpy.app.background else context.window_manager.windows:
        areas = sorted(window.screen.areas, key=lambda area: area != context.area)
        area = next((area for area in areas if area.type == "VIEW_3D"), None)
        if area is not None and window.scene == context.scene:
            region = next(region for region in area.regions if region.type == "WINDOW")
            return {"window": window, "area": area, "region": region}
    return None


def frame_seconds(context: bpy.types.Context) -> float | None:
    """Return the median time to change the frame and redraw a view, s; None without a view.

    The frames after the current one are drawn, at least one. The first redraw, which may compile shaders, is
    not timed.
    """
    found, scene = find_view(context), context.scene
    if found is None:
        return None
    current = scene.frame_current
    steps: list[float] = []
    with context.temp_override(**found):
        _redraw()
        began = time.perf_counter()
        while len(steps) < _MOST and (not steps or time.perf_counter() - began < _SECONDS):
            before = time.perf_counter()
            scene.frame_set(next_frame(scene))
            _redraw()
            steps.append(time.perf_counter() - before)
        scene.frame_set(current)
    return statistics.median(steps)


def next_frame(scene: bpy.types.Scene) -> int:
    """Return the frame that playing shows next."""
    return scene.frame_start if scene.frame_current >= scene.frame_end else scene.frame_current + 1


def _redraw() -> None:
    """Redraw the region of the context, and wait until it is shown."""
    bpy.ops.wm.redraw_timer(type="DRAW_SWAP", iterations=1)
