"""Fade after cuts, and time between frames, of a running VR session."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import bpy
from mathutils import Vector

from .. import frame_clock, working
from ..frame_clock import FrameClock

_BLUE = (0.4, 0.6, 0.9, 1.0)
_RING = 0.03  # radius / distance of the mark at the end of a ray
_FADE = 0.3  # s of a fade from black
_TICK = 0.5  # s between looks at the session
_VIEWS = 2  # views of a frame

_clock = FrameClock()


class _Drawing:
    """State of the drawing in the views of a session."""

    handler: object = None
    ended: Callable[[], None] | None = None
    views = 0
    is_cut = False  # the next frame is the first one after a cut
    cut = 0.0  # s, time of this frame
    black = 0.0  # opacity of black in this frame
    ray: tuple[Vector, Vector] | None = None  # from a controller to the ground


def start(ended: Callable[[], None]) -> None:
    """Draw in the session's views until it ends, then call `ended`."""
    stop()
    _clock.clear()
    _Drawing.ended = ended
    _Drawing.handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "XR", "POST_VIEW")
    bpy.app.timers.register(_watch, first_interval=_TICK, persistent=True)


def stop() -> None:
    """Stop drawing."""
    if _Drawing.handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_Drawing.handler, "XR")
    if bpy.app.timers.is_registered(_watch):
        bpy.app.timers.unregister(_watch)
    _Drawing.handler, _Drawing.ended = None, None
    _Drawing.views, _Drawing.is_cut, _Drawing.black = 0, False, 0.0
    _Drawing.ray = None


def fade() -> None:
    """Begin a fade from black with the next frame, which is black even if it takes long to draw."""
    _Drawing.is_cut = True


def show_ray(ray: tuple[Vector, Vector] | None) -> None:
    """Show a ray from a controller to a point on the ground; None: show it no longer."""
    _Drawing.ray = ray


def frame_time() -> float | None:
    """Return the median time between frames of the session, s; None before the tenth frame."""
    return _clock.median()


def describe(seconds: float | None) -> tuple[str, bool]:
    """Return a line about the frame time and whether it is too long for a headset."""
    if seconds is None:
        return "Frame time: not known yet", False
    return f"Frame time: {frame_clock.describe(seconds)}", frame_clock.is_slow(seconds)


def remedy(live: bool, shading: str) -> str:
    """Return how to make the frames of a headset shorter.

    Parameters
    ----------
    live
        The live scene is shown.
    shading
        Type of shading of the 3D view.
    """
    if not live:
        return "Too slow for a headset: show the live scene (Scene > Live)"
    if shading in ("MATERIAL", "RENDERED"):
        return "Too slow for a headset: choose the shading Solid, or hide smoke or trees in the outliner"
    return "Too slow for a headset: hide smoke or trees in the outliner"


def _watch() -> float | None:
    """Redraw the panel with the frame time; at the end of the session stop drawing."""
    if bpy.types.XrSessionState.is_running(bpy.context):
        working.redraw()
        return _TICK
    ended = _Drawing.ended
    stop()
    if ended is not None:
        ended()
    return None


def _draw() -> None:
    """Note the time of each frame, and draw the fade."""
    if not _is_mirror():
        _Drawing.views = (_Drawing.views + 1) % _VIEWS
        if _Drawing.views == 1:
            _begin_frame(time.monotonic())
    if _Drawing.ray is not None:
        _draw_ray(*_Drawing.ray)
    if _Drawing.black > 0.0:
        _draw_black(_Drawing.black)


def _is_mirror() -> bool:
    """Return whether a 3D view is drawn that mirrors the session."""
    import gpu

    region = bpy.context.region
    return region is not None and (region.width, region.height) == tuple(gpu.state.viewport_get()[2:])


def _begin_frame(now: float) -> None:
    """Note a frame that begins at this time (s), and choose its opacity of black."""
    _clock.note()
    if _Drawing.is_cut:
        _Drawing.is_cut, _Drawing.cut = False, now
        _Drawing.black = 1.0
    elif _Drawing.black > 0.0:
        _Drawing.black = max(1.0 - (now - _Drawing.cut) / _FADE, 0.0)


def _draw_black(alpha: float) -> None:
    """Cover the view with black of this opacity."""
    from gpu_extras.batch import batch_for_shader
    from mathutils import Matrix

    import gpu

    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    corners = [(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (-1.0, 1.0, 0.0), (1.0, 1.0, 0.0)]
    batch = batch_for_shader(shader, "TRI_STRIP", {"pos": corners})
    depth = gpu.state.depth_test_get()
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_matrix(Matrix.Identity(4))
        gpu.matrix.load_projection_matrix(Matrix.Identity(4))
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("ALPHA")
        shader.uniform_float("color", (0.0, 0.0, 0.0, alpha))
        batch.draw(shader)
    gpu.state.blend_set("NONE")
    gpu.state.depth_test_set(depth)


def _draw_ray(start: Vector, end: Vector) -> None:
    """Draw a line to a point, and a ring around it."""
    from gpu_extras.batch import batch_for_shader

    import gpu

    radius = _RING * (end - start).length
    turns = [math.tau * step / 32 for step in range(33)]
    ring = [end + radius * Vector((math.cos(turn), math.sin(turn), 0.0)) for turn in turns]
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    for line in ([start, end], ring):
        batch = batch_for_shader(shader, "LINE_STRIP", {"pos": line})
        shader.uniform_float("color", _BLUE)
        shader.uniform_float("lineWidth", 4.0)
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        batch.draw(shader)
    gpu.state.blend_set("NONE")
