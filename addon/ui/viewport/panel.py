"""Panel Viewport: switches film and live scene, and shows reasons, cost against the budget, and times."""

from __future__ import annotations

import bpy

from ...scene.live import build, switch
from .. import frame_clock, navigation, panel_state, working
from ..sidebar import SidebarPanel
from ..text import draw_paragraph
from . import facts, redraws

_NO_LIVE = "There is no live scene: Scene > Build live scene makes one"
_ROWS = {
    "Triangles": lambda cost: f"{cost.triangles:,}",
    "Instances": lambda cost: f"{cost.instances:,}",
    "Draw batches": lambda cost: f"{cost.batches:,}",
    "Textures": lambda cost: f"{cost.texture_bytes / 1e6:.0f} MB",
    "Volumes": lambda cost: f"{cost.volume_bytes / 1e6:.0f} MB",
}


class ViewportProperties:
    """Properties of the scene that the panel Viewport shows."""

    viewport_overlay: bpy.props.BoolProperty(
        name="Cost in view",
        description="Show the measured cost over the 3D views, and the time between frames during playback",
        default=False,
    )


class FIRETWIN_OT_viewport_measure(bpy.types.Operator):
    """Count triangles and textures of both scenes, and time frames of the scene that is shown"""

    bl_idname = "firetwin.viewport_measure"
    bl_label = "Measure viewport"
    bl_description = (
        "Count triangles, batches and textures of the film scene and the live scene, and time up to ten "
        "frames of the scene that is shown, in about three seconds"
    )
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return navigation.can_navigate(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene = context.scene
        facts.count(scene)
        seconds = redraws.frame_seconds(context)
        if seconds is None:
            self.report({"INFO"}, "Counted; frames are timed only in a 3D view")
            return {"FINISHED"}
        facts.facts(scene).seconds[switch.is_live(scene)] = seconds
        self.report({"INFO"}, frame_clock.describe(seconds, " per frame"))
        return {"FINISHED"}


class FIRETWIN_PT_viewport(SidebarPanel, bpy.types.Panel):
    """Scene in the 3D views, hidden parts with reasons, and the cost of a frame"""

    bl_idname = "FIRETWIN_PT_viewport"
    bl_label = "Viewport"
    bl_parent_id = "FIRETWIN_PT_render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.is_built(context.scene)

    def draw(self, context: bpy.types.Context) -> None:
        layout, scene = self.layout, context.scene
        live = switch.is_live(scene)
        layout.label(text="The live scene is shown" if live else "The film scene is shown", icon="HIDE_OFF")
        text = "Show film scene" if live else "Show live scene"
        layout.operator("firetwin.show_live", text=text, icon="SHADING_RENDERED")
        if not switch.has_live(scene):
            draw_paragraph(context, layout.column(align=True), _NO_LIVE, "INFO")
        column = layout.column(align=True)
        for reason in (*facts.view_reasons(context.space_data), *facts.reasons(scene, context.view_layer)):
            draw_paragraph(context, column, reason, "HIDE_ON")
        layout.operator("firetwin.viewport_measure", icon="TIME")
        _draw_cost(layout, facts.facts(scene))
        layout.prop(scene.firetwin, "viewport_overlay")


def _draw_cost(layout: bpy.types.UILayout, scene_facts: facts.Facts) -> None:
    """Draw a table of the measured cost: a column for the film scene and one for the live scene."""
    if not scene_facts.cost:
        return
    table = layout.column(align=True)
    shown = sorted(scene_facts.cost)
    _draw_row(table, "", ["Live" if live else "Film" for live in shown])
    for name, text in _ROWS.items():
        _draw_row(table, name, [text(scene_facts.cost[live]) for live in shown])
    times = [
        f"{1000.0 * scene_facts.seconds[live]:.1f} ms" if live in scene_facts.seconds else "-"
        for live in shown
    ]
    _draw_row(table, "Frame", times)
    if True in scene_facts.cost:
        table.label(text=f"Budget: {build.TRIANGLES:,} triangles", icon="INFO")
    if any(frame_clock.is_slow(seconds) for seconds in scene_facts.seconds.values()):
        needed = f"{frame_clock.HEADSET:.0f} Hz needs {1000.0 / frame_clock.HEADSET:.1f} ms"
        table.label(text=needed, icon="INFO")


def _draw_row(table: bpy.types.UILayout, name: str, values: list[str]) -> None:
    row = table.split(factor=0.4)
    row.label(text=name)
    cells = row.row(align=True)
    for value in values:
        cells.label(text=value)


classes = (FIRETWIN_OT_viewport_measure, FIRETWIN_PT_viewport)
