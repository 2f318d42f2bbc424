"""Fade after cuts, and time between frames, of a running VR session."""

from __future__ import annotations

import statistics
import time
from collections import deque
from collections.abc import Callable

import bpy

_FADE = 0.3  # s of a fade from black
_TICK = 0.5  # s between looks at the session
_RATE = 72.0  # frames/s that standalone headsets ask for
_VIEWS = 2  # views of a frame

_times: deque[float] = deque(maxlen=60)  # s, begin of each frame


class _Drawing:
    """State of the drawing in the views of a session."""

    handler: object = None
    ended: Callable[[], None] | None = None
    views = 0
    cut = -1.0  # s, time of the last cut


def start(ended: Callable[[], None]) -> None:
    """Draw in the session's views until it ends, then call `ended`."""
    stop()
    _times.clear()
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
    _Drawing.views, _Drawing.cut = 0, -1.0


def fade() -> None:
    """Begin a fade from black."""
    _Drawing.cut = time.monotonic()


def frame_time() -> float | None:
    """Return the median time between frames of the session, s; None before the tenth frame."""
    steps = [after - before for before, after in zip(_times, list(_times)[1:], strict=False)]
    return statistics.median(steps) if len(steps) >= 10 else None


def describe(seconds: float | None) -> tuple[str, bool]:
    """Return a line about the frame time and whether it is too long for a headset."""
    if seconds is None:
        return "Frame time: not known yet", False
    words = f"Frame time: {1000.0 * seconds:.1f} ms; {_RATE:.0f} Hz needs {1000.0 / _RATE:.1f}"
    return words, seconds > 1.05 / _RATE


def _watch() -> float | None:
    """Redraw the panel with the frame time; at the end of the session stop drawing."""
    context = bpy.context
    if bpy.types.XrSessionState.is_running(bpy.context):
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()
        return _TICK
    ended = _Drawing.ended
    stop()
    if ended is not None:
        ended()
    return None


def _draw() -> None:
    """Note the time of each frame, and draw the fade."""
    _Drawing.views = (_Drawing.views + 1) % _VIEWS
    if _Drawing.views == 1:
        _times.append(time.monotonic())
    part = (time.monotonic() - _Drawing.cut) / _FADE
    if 0.0 <= part < 1.0:
        _draw_black(1.0 - part)


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
