"""Credits of tiles over the 3D views: drawn while a scene has tiles that name somebody."""

from __future__ import annotations

from typing import Any

import bpy

_MARGIN, _SIZE = 12, 11  # pixels of a screen of scale 1
_handle: Any = None


def refresh(*_: object) -> None:
    """Draw credits if any scene has some, else not."""
    wanted = any(scene.firetwin.tile_credits for scene in bpy.data.scenes)
    if wanted and _handle is None:
        _add()
    elif not wanted:
        _remove()


def shown() -> bool:
    """Whether credits are drawn."""
    return _handle is not None


def _add() -> None:
    global _handle
    _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def _remove() -> None:
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None


def _draw() -> None:
    """Draw the credits of the view's scene at its lower left corner."""
    import blf

    context = bpy.context
    text, overlay = context.scene.firetwin.tile_credits, context.space_data.overlay
    if not text or not overlay.show_overlays:
        return
    scale = context.preferences.system.ui_scale
    blf.size(0, _SIZE * scale)
    blf.color(0, 1.0, 1.0, 1.0, 0.9)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.8)
    for number, line in enumerate(reversed(_lines(text, context.region.width - 2 * _MARGIN * scale))):
        blf.position(0, _MARGIN * scale, (_MARGIN + 1.4 * _SIZE * number) * scale, 0.0)
        blf.draw(0, line)
    blf.disable(0, blf.SHADOW)


def _lines(text: str, width: float) -> list[str]:
    """Split a text into lines that fit into a width, pixels."""
    import blf

    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and blf.dimensions(0, longer)[0] > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


@bpy.app.handlers.persistent
def _changed(*_: object) -> None:
    refresh()


_HANDLERS = ("load_post", "undo_post", "redo_post")


def register() -> None:
    """Follow files that are opened, undo and redo."""
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(_changed)


def unregister() -> None:
    """Undo `register`."""
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(_changed)
    _remove()
