"""Build the scene in the window."""

from __future__ import annotations

import bpy

from . import clock, job, run, view
from .job import Away, Steps, Working


class FIRETWIN_OT_build(Working, bpy.types.Operator):
    """Build the world of the run, in place of the last one built"""

    bl_idname = "firetwin.build"
    bl_label = "Build scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the edit mode first")
            return False
        return run.ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """The smoke in a worker process, then everything else here."""
        from .. import jobs
        from ..render import engine
        from ..scene import build

        scene, settings = context.scene, context.scene.firetwin
        chosen = run.choice(settings)
        project, opened = chosen.load()
        if settings.smoke and project.smoke.enabled:
            yield Away("smoke", lambda progress, stop: jobs.bake(chosen, progress, stop))
        yield "clearing the stage"
        gone = view.clear_startup(scene)
        yield from build.steps(project, opened, scene)
        engine.apply(project, scene)
        clock.remember(settings, project, opened)
        view.remember(settings, opened)
        view.look(context, scene)
        told = f"Built {project.time.frames} frames of {opened.name}"
        return told + ("; the startup cube, light and camera went (undo brings them back)" if gone else "")


class FIRETWIN_PT_build(bpy.types.Panel):
    """The scene made from the run"""

    bl_idname = "FIRETWIN_PT_build"
    bl_label = "Scene"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.firetwin
        row = layout.row(align=True)
        row.scale_y = 1.3
        job.button(row, FIRETWIN_OT_build, "WORLD")
        column = layout.column()
        column.enabled = job.Job.current is None
        column.prop(settings, "smoke")
        row = layout.row(align=True)
        row.operator(view.FIRETWIN_OT_view.bl_idname, text="Through camera", icon="CAMERA_DATA").whole = False
        row.operator(view.FIRETWIN_OT_view.bl_idname, text="Whole run", icon="WORLD_DATA").whole = True


classes = (FIRETWIN_OT_build, view.FIRETWIN_OT_view, FIRETWIN_PT_build)
