"""Scene properties in the .blend file: the settings of a scene file, and the panel's own state."""

from __future__ import annotations

import bpy

from ..shot.settings import Settings
from . import (
    camera_list,
    feature_panels,
    keys,
    other_runs,
    render,
    run,
    scene_file,
    sections,
    station_filter,
    station_map,
    station_selection,
    time,
)
from .viewport.panel import ViewportProperties
from .vr.session import VrProperties

_BLEND_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"}
_NOT_COPIED = ("runs", "cameras", "model_time", "station_index", "station_filter")
_SETTINGS = sections.property_annotations(sections.top_level_keys() + sections.sections(), Settings)


_BASES = (VrProperties, ViewportProperties, *feature_panels.properties)
_Settings: type = type("Settings", _BASES, {"__annotations__": _SETTINGS})


class FIRETWIN_PG_scene(bpy.types.PropertyGroup, _Settings):
    """Settings of the scene, choices of the panel, and facts about the run"""

    run: bpy.props.StringProperty(
        name="Run",
        description="Folder of the run: run.toml, and a file or a folder of files per field",
        subtype="DIR_PATH",
        options=_BLEND_RELATIVE,
        update=run.on_run_changed,
    )
    scene_file: bpy.props.StringProperty(
        name="Scene file",
        description="TOML file of the settings. Choosing a file fills the panel",
        subtype="FILE_PATH",
        options=_BLEND_RELATIVE,
        update=run.on_scene_file_changed,
    )
    cache: keys.create_property(
        Settings,
        "cache",
        description="Folder of smoke volumes, which are reused; empty: in the output folder, or "
        "in Firetwin's folder if the .blend file is not saved",
        default="",
        options=_BLEND_RELATIVE,
    )
    runs: bpy.props.CollectionProperty(type=other_runs.FIRETWIN_PG_otherrun, name="Other runs")
    cameras: bpy.props.CollectionProperty(type=camera_list.FIRETWIN_PG_camera, name="Cameras")
    camera_index: bpy.props.IntProperty(name="Camera", description="Selected camera of the list")
    output: bpy.props.StringProperty(
        name="Output",
        description="Folder for pictures and films",
        subtype="DIR_PATH",
        default="//firetwin",
        options=_BLEND_RELATIVE,
    )
    usual: bpy.props.StringProperty(options={"HIDDEN"})
    smoke_cost: bpy.props.StringProperty(options={"HIDDEN"})
    facts: bpy.props.StringProperty(options={"HIDDEN"})
    built: bpy.props.StringProperty(options={"HIDDEN"})
    landmarks: bpy.props.StringProperty(options={"HIDDEN"})
    changed: bpy.props.StringProperty(options={"HIDDEN"})
    problem: bpy.props.StringProperty(options={"HIDDEN"})
    tile_facts: bpy.props.StringProperty(options={"HIDDEN"})
    tile_credits: bpy.props.StringProperty(options={"HIDDEN"})
    bake_smoke: bpy.props.BoolProperty(
        name="Smoke of every frame",
        description="Bake the smoke of all frames during the build, which can take minutes. "
        "Off: the build is faster, and frames get their smoke when you ask for it (Smoke of frame)",
        default=True,
    )
    first_time: bpy.props.StringProperty(options={"HIDDEN"})
    seconds_per_frame: bpy.props.FloatProperty(options={"HIDDEN"})
    frames: bpy.props.IntProperty(options={"HIDDEN"})
    zone: bpy.props.StringProperty(options={"HIDDEN"})
    extent: bpy.props.FloatProperty(options={"HIDDEN"})
    height: bpy.props.FloatProperty(options={"HIDDEN"})
    model_time: bpy.props.FloatProperty(
        name="Model time",
        description="Model time that is shown, from the first frame to the last",
        subtype="FACTOR",
        min=0.0,
        max=1.0,
        get=time.position,
        set=time.go_to,
        options=set(),
    )
    go_to: bpy.props.StringProperty(
        name="Go to",
        description="Latitude and longitude (38.82 -120.55 or 38 49 12 N 120 33 0 W), a station, place or "
        "object by name, head or ignition, a date and time (2014-09-17 15:30, in the zone of the film), or "
        "text of an event",
        options={"SKIP_SAVE"},
    )
    go_smoothly: bpy.props.BoolProperty(
        name="Smooth", description="Go to a place smoothly; off: cut to it", default=True
    )
    station: bpy.props.StringProperty(options={"HIDDEN"})
    station_index: bpy.props.IntProperty(
        name="Station",
        description="Selected station of the list",
        get=station_selection.position,
        set=station_selection.choose,
    )
    station_filter: bpy.props.PointerProperty(type=station_filter.FIRETWIN_PG_stationfilter)
    station_map: bpy.props.BoolProperty(
        name="Station map", description="Show a map of the listed stations here", update=station_map.changed
    )
    camera: bpy.props.EnumProperty(name="Camera", description="Cameras to render", items=render.camera_items)
    which: bpy.props.EnumProperty(
        name="Frames",
        description="Frames to render",
        items=(
            ("frame", "This frame", "Current frame"),
            ("list", "Frame list", "A list of frames"),
            ("all", "All", "Every frame of the cameras"),
        ),
    )
    frame_list: bpy.props.StringProperty(
        name="Frames", description="Frames such as 7, 1-10, 3,5-9 or 1-48:4", default="1-10"
    )
    resume: bpy.props.BoolProperty(
        name="Keep finished",
        description="Render only pictures that are missing or have other settings",
        default=True,
    )


def copy(source: bpy.types.Scene, target: bpy.types.Scene) -> None:
    """Copy settings, choices and facts to another scene's panel, during a running task."""
    scene_file.fill(target, scene_file.read_settings(source))
    station_filter.copy(source.firetwin.station_filter, target.firetwin.station_filter)
    for name in FIRETWIN_PG_scene.__annotations__.keys() - set(_NOT_COPIED):
        setattr(target.firetwin, name, getattr(source.firetwin, name))


classes = (
    *sections.group_classes(),
    *other_runs.classes,
    *camera_list.classes,
    *station_filter.classes,
    FIRETWIN_PG_scene,
)
