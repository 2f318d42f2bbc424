"""Live scene in the panel: builds it, and switches 3D views between it and the film's scene."""

from __future__ import annotations

import functools

import bpy

from ..blender import owned
from ..scene.live import switch
from ..shot.shot import Shot
from . import panel_state, scene_file, working
from .job import InThread, Message, Steps
from .working import Working

_PARTS = {"terrain", "forest", "fire", "smoke"}


def _is_built(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether the scene has something built; otherwise set the poll message."""
    if not working.is_editable(operator, context) or not working.is_object_mode(operator, context):
        return False
    return panel_state.require(operator, context)


class FIRETWIN_OT_live(Working, bpy.types.Operator):
    """Build the live scene, which 3D views and headsets draw fast, and show it in 3D views.

    Renders always show the film's scene
    """

    bl_idname = "firetwin.live"
    bl_label = "Build live scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _is_built(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Read the shot, solve its smoke in a worker process, and build the live scene."""
        uid, chosen = context.scene.session_uid, scene_file.shot_source(context.scene.firetwin)
        shot = yield InThread("reading the run", lambda **_: chosen.shot())
        if shot.settings.smoke.enabled:
            from ..jobs import bake

            yield InThread("smoke", functools.partial(bake.run, chosen))
        yield from steps(shot, uid)
        switch.show_live(owned.scene(uid), True)
        return "Built the live scene"


class FIRETWIN_OT_show_live(bpy.types.Operator):
    """Switch 3D views between the live scene and the film's scene; renders always show the film's"""

    bl_idname = "firetwin.show_live"
    bl_label = "Switch live scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _is_built(cls, context):
            return False
        if not switch.has_live(context.scene):
            cls.poll_message_set("Build the live scene first")
            return False
        return True

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        switch.show_live(context.scene, not switch.is_live(context.scene))
        return {"FINISHED"}


def steps(shot: Shot, uid: int) -> Steps:
    """Build the live scene of the scene with this `session_uid`."""
    from ..scene.live import build

    told: list[str] = []
    yield from build.steps(shot, owned.scene(uid), tell=told.append)
    for text in told:
        yield Message(text, "WARNING")
    return ""


def rebuild(shot: Shot, uid: int, parts: tuple[str, ...]) -> Steps:
    """Build the live scene again after parts of the film's scene that it shows were rebuilt."""
    scene = owned.scene(uid)
    if switch.has_live(scene) and _PARTS & set(parts):
        shown = switch.is_live(scene)
        yield from steps(shot, uid)
        switch.show_live(owned.scene(uid), shown)
    return ""


def draw(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    """Draw the button that builds the live scene, or that switches to it and back."""
    if not panel_state.is_built(scene):
        return
    row = layout.row(align=True)
    if not switch.has_live(scene):
        row.operator(FIRETWIN_OT_live.bl_idname, icon="SHADING_RENDERED")
        return
    live = switch.is_live(scene)
    row.operator(FIRETWIN_OT_show_live.bl_idname, text="Live", icon="SHADING_RENDERED", depress=live)
    row.operator(FIRETWIN_OT_live.bl_idname, text="", icon="FILE_REFRESH")


classes = (FIRETWIN_OT_live, FIRETWIN_OT_show_live)
