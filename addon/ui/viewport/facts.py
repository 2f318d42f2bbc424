"""Stored facts about the scene in 3D views, so that drawing a panel counts nothing.

Counts and times change when the user measures. Reasons are read once after a change of the scene.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import bpy

from ...blender import viewport
from ...scene.live import cost, hidden_parts, switch


@dataclass
class Facts:
    """Facts about a scene: cost and seconds of a frame of the film (False) and the live (True) scene."""

    cost: dict[bool, cost.Cost] = field(default_factory=dict)
    seconds: dict[bool, float] = field(default_factory=dict)


_known: dict[int, Facts] = {}
"""Facts of scenes, by `session_uid`."""
_reasons: dict[tuple[int, int, str], list[str]] = {}
"""Reasons why parts are not drawn, by scene, frame and view layer."""


def facts(scene: bpy.types.Scene) -> Facts:
    """Return the stored facts of a scene."""
    return _known.setdefault(scene.session_uid, Facts())


def count(scene: bpy.types.Scene) -> None:
    """Measure the cost of the film scene and of the live scene."""
    found = facts(scene)
    found.cost.clear()
    for live in (False, True) if switch.has_live(scene) else (False,):
        found.cost[live] = cost.measure(scene, live)


def reasons(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> list[str]:
    """Return why 3D views of a view layer do not draw parts of the scene; it is read once after a change."""
    key = scene.session_uid, scene.frame_current, layer.name
    if key not in _reasons:
        _reasons.clear()
        _reasons[key] = hidden_parts.why_not_drawn(scene, layer)
    return _reasons[key]


def view_reasons(space: bpy.types.SpaceView3D) -> Iterator[str]:
    """Return why this view does not draw parts of the scene."""
    if space.shading.type in ("WIREFRAME", "SOLID"):
        yield "Light, sky and haze are not drawn: choose the shading Material Preview or Rendered"
    elif space.shading.type == "MATERIAL" and not space.shading.use_scene_world:
        yield "The sky is not drawn: choose the shading Rendered, or Scene World in its options"
    if space.local_view is not None:
        yield "Other objects are not drawn: this is a local view"
    if space.clip_end < 0.5 * viewport.FAR:
        yield f"Distant parts are not drawn: the view ends at {space.clip_end / 1000.0:.1f} km"


@bpy.app.handlers.persistent
def _changed(*_: object) -> None:
    """Read the reasons again when they are next shown."""
    _reasons.clear()


@bpy.app.handlers.persistent
def _opened(*_: object) -> None:
    """Forget the facts of another file."""
    _reasons.clear()
    _known.clear()


_HANDLERS = {
    "depsgraph_update_post": _changed,
    "undo_post": _changed,
    "redo_post": _changed,
    "load_post": _opened,
}


def register() -> None:
    """Follow changes of scenes."""
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Undo `register`."""
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
    _opened()
