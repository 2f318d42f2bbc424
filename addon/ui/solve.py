"""Solved smoke in place of puffs: what it costs is told, and a button accepts it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ..blender import owned
from . import working
from .job import Away, Steps

if TYPE_CHECKING:
    from ..shot.choice import Choice


def price(uid: int) -> Steps:
    """Find out what solving the smoke would take, where the scene with this `session_uid` shows puffs."""
    from . import run

    panel = owned.scene(uid).firetwin
    panel.smoke_cost = ""
    if not panel.smoke.enabled or panel.smoke.method != "puffs":
        return ""
    chosen = replace(run.choice(panel), smoke="flow")
    found = yield Away("looking what smoke would take", lambda **_: _cost(chosen))
    owned.scene(uid).firetwin.smoke_cost = found
    return found


def _cost(choice: Choice) -> str:
    """Time and room in a few words; empty where the run brings its smoke, or nothing burns."""
    from ..scene.smoke import outlook

    found = outlook.cost(choice.shot())
    return found.brief() if found else ""


class FIRETWIN_OT_solve(bpy.types.Operator):
    """Solve the air over the fire once, and show its smoke in place of the preview of puffs.

    What is solved is kept and used again. Stop ends it; it goes on where it was
    """

    bl_idname = "firetwin.solve"
    bl_label = "Solve smoke"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        from . import run

        if context.scene.firetwin.smoke.method != "puffs":
            cls.poll_message_set("The smoke is solved already, or will be when the scene is built")
            return False
        return run.ready(cls, context)

    @working.reported
    def execute(self, context: bpy.types.Context) -> set[str]:
        panel = context.scene.firetwin
        panel.smoke.method, panel.bake_smoke, panel.smoke_cost = "flow", True, ""
        bpy.ops.firetwin.build("INVOKE_DEFAULT", part="smoke" if owned.built(context.scene) else "all")
        return {"FINISHED"}


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    """The button, which names the cost, where puffs are shown."""
    if panel.run and panel.smoke.enabled and panel.smoke.method == "puffs" and panel.smoke_cost:
        text = f"{FIRETWIN_OT_solve.bl_label} ({panel.smoke_cost})"
        layout.operator(FIRETWIN_OT_solve.bl_idname, text=text, icon="MOD_FLUIDSIM")


classes = (FIRETWIN_OT_solve,)
