"""Cost of a frame, drawn over the 3D views at the lower left."""

from __future__ import annotations

from typing import Any

import bpy

from ...scene.live import switch
from .. import frame_clock, panel_state
from ..frame_clock import FrameClock
from .facts import Facts, facts

_MARGIN, _SIZE, _ABOVE = 12, 11, 4  # pixels of a screen of scale 1; lines below, for credits of tiles
_clock = FrameClock()  # while the film plays
_handle: Any = None


def lines(known: Facts, live: bool, playing: float | None) -> list[str]:
    """Return the text: the scene and its cost, and the time of a frame as measured and while it plays."""
    name = "Live scene" if live else "Film scene"
    text = [f"{name}: {known.cost[live].text()}" if live in known.cost else name]
    if live in known.seconds:
        text.append(frame_clock.describe(known.seconds[live], " per frame, measured"))
    if playing is not None:
        text.append(frame_clock.describe(playing, " between frames"))
    return text


def _draw() -> None:
    """Draw the lines in a view whose scene asks for them."""
    import blf

    context = bpy.context
    scene, overlay = context.scene, context.space_data.overlay
    if not scene.firetwin.viewport_overlay or not overlay.show_overlays or not panel_state.is_built(scene):
        return
    if not context.screen.is_animation_playing:
        _clock.clear()
    elif context.area == next(area for area in context.screen.areas if area.type == "VIEW_3D"):
        _clock.note()
    scale = context.preferences.system.ui_scale
    blf.size(0, _SIZE * scale)
    blf.color(0, 1.0, 1.0, 1.0, 0.9)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.8)
    shown = lines(facts(scene), switch.is_live(scene), _clock.median())
    for number, line in enumerate(reversed(shown), _ABOVE):
        blf.position(0, _MARGIN * scale, (_MARGIN + 1.4 * _SIZE * number) * scale, 0.0)
        blf.draw(0, line)
    blf.disable(0, blf.SHADOW)


def register() -> None:
    """Draw over the 3D views."""
    global _handle
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister() -> None:
    """Undo `register`."""
    global _handle
    bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
    _handle = None
    _clock.clear()
