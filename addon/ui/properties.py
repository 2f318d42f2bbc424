"""What the panel remembers in the .blend file."""

from __future__ import annotations

import bpy

from ..shot.settings import Render, Smoke
from . import keys, preferences, render, run, time

_BLEND_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"}


class FIRETWIN_PG_scene(bpy.types.PropertyGroup):
    """Choices of the panel, and what is known about the run"""

    run: bpy.props.StringProperty(
        name="Run",
        description="Folder of the model run: run.toml and a file, or a folder of files, per field",
        subtype="DIR_PATH",
        options=_BLEND_RELATIVE,
        update=run.chosen,
    )
    scene_file: bpy.props.StringProperty(
        name="Scene file",
        description="TOML file with the time window, the cameras and the settings. "
        "Without one the whole run is shown by two cameras that see all of the fire",
        subtype="FILE_PATH",
        options=_BLEND_RELATIVE,
        update=run.chosen,
    )
    shown_run: bpy.props.StringProperty(
        name="Run", description="The run that the scene file names", get=run.shown_run, options=set()
    )
    output: bpy.props.StringProperty(
        name="Output",
        description="Folder for pictures and films. "
        "Without a scene file the smoke volumes are kept here too, in cache",
        subtype="DIR_PATH",
        default="//firetwin",
        options=_BLEND_RELATIVE,
    )
    facts: bpy.props.StringProperty(options={"HIDDEN"})
    problem: bpy.props.StringProperty(options={"HIDDEN"})
    smoke: bpy.props.BoolProperty(
        name="Smoke of every frame",
        description="Write the smoke of all frames first, which can take minutes. "
        "Without it the scene is there sooner, and Render writes the smoke that it needs",
        default=True,
    )
    method: keys.prop(
        Smoke,
        "method",
        (*preferences.AS_FILE[:2], "As the scene file says; a quick preview where there is none"),
        description="How smoke is made where the run has none of its own",
    )
    first_time: bpy.props.StringProperty(options={"HIDDEN"})
    seconds_per_frame: bpy.props.FloatProperty(options={"HIDDEN"})
    frames: bpy.props.IntProperty(options={"HIDDEN"})
    zone: bpy.props.StringProperty(options={"HIDDEN"})
    extent: bpy.props.FloatProperty(options={"HIDDEN"})
    height: bpy.props.FloatProperty(options={"HIDDEN"})
    model_time: bpy.props.FloatProperty(
        name="Model time",
        description="Moment of the run that is shown, from the first frame to the last",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        get=time.position,
        set=time.go_to,
        options=set(),
    )
    engine: keys.prop(Render, "engine", preferences.AS_FILE)
    camera: bpy.props.EnumProperty(name="Camera", description="Cameras that film", items=render.camera_items)
    scene_passes: bpy.props.BoolProperty(
        name="Scene file's passes",
        description="Record what the scene file says for each camera, instead of the passes chosen here",
        default=True,
    )
    passes: keys.prop(Render, "passes", default={"rgb"})
    which: bpy.props.EnumProperty(
        name="Frames",
        description="Which frames to render",
        items=(
            ("frame", "This frame", "The frame that is shown"),
            ("list", "List", "A list of frames"),
            ("all", "All", "Every frame of the cameras"),
        ),
    )
    frame_list: bpy.props.StringProperty(
        name="Frames", description="Frames such as 7, 1-10, 3,5-9 or 1-48:4", default="1-10"
    )
    resume: bpy.props.BoolProperty(
        name="Keep finished",
        description="Render only what is missing or was made with other settings",
        default=True,
    )


def copy(source: FIRETWIN_PG_scene, target: FIRETWIN_PG_scene) -> None:
    """Give another scene's panel the same choices and facts, while a work goes on."""
    for prop in source.bl_rna.properties:
        if not prop.is_readonly and prop.identifier not in ("name", "model_time"):
            setattr(target, prop.identifier, getattr(source, prop.identifier))


classes = (FIRETWIN_PG_scene,)
