"""Choose a scene file and build its world."""

from __future__ import annotations

import bpy


class FIRETWIN_PG_project(bpy.types.PropertyGroup):
    """What the panel remembers in the .blend file."""

    scene_file: bpy.props.StringProperty(
        name="Scene file",
        description="TOML file that names the model run, the time window, the cameras and the settings",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )


class FIRETWIN_OT_build(bpy.types.Operator):
    """Build the world of the scene file, in place of the last one built"""

    bl_idname = "firetwin.build"
    bl_label = "Build scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.scene.firetwin.scene_file:
            cls.poll_message_set("Choose a scene file first")
            return False
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        import firetwin_core

        from .. import project
        from ..scene import build

        try:
            settings = project.load(bpy.path.abspath(context.scene.firetwin.scene_file))
            build.build(settings, firetwin_core.run.open(settings.run))
        except (firetwin_core.Error, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Built {settings.time.frames} frames of {settings.run.name}")
        return {"FINISHED"}


class FIRETWIN_PT_project(bpy.types.Panel):
    """Firetwin in the sidebar of the 3D view"""

    bl_label = "Firetwin"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.scene.firetwin, "scene_file")
        self.layout.operator(FIRETWIN_OT_build.bl_idname, icon="WORLD")


classes = (FIRETWIN_PG_project, FIRETWIN_OT_build, FIRETWIN_PT_project)
