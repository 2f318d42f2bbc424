"""Build operators: build the scene, rebuild parts of it, and remove it."""

from __future__ import annotations

import functools
from pathlib import Path

import bpy

from ..blender import owned
from ..errors import Error
from ..scene.build import PARTS
from ..shot.cameras import camera_warnings
from ..shot.shot import Shot
from ..shot.source import ShotSource
from ..shot.stations import station_signs
from ..shot.stations.station_signs import MovingPoints
from . import (
    auto_framing,
    camera_edits,
    changed_settings,
    job,
    keys,
    live,
    panel_state,
    preferences,
    quality,
    run,
    scene_file,
    smoke_volumes,
    solve,
    target_scene,
    tile_facts,
    view,
    working,
)
from .job import InThread, Message, Steps
from .sidebar import SidebarPanel
from .text import draw_paragraph, labelled_row
from .working import Working

ALL = "all"
_CHOICES = (
    (ALL, "All", "All parts of the scene"),
    *((name, keys.label(name), f"Only the {name}; other parts do not change") for name in PARTS),
)


def _can_build(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether a scene can be built; otherwise set the poll message."""
    return working.is_object_mode(operator, context) and run.is_ready(operator, context)


class FIRETWIN_OT_build(Working, bpy.types.Operator):
    """Build the scene of the run and replace the previous build"""

    bl_idname = "firetwin.build"
    bl_label = "Build scene"
    bl_options = {"REGISTER", "UNDO"}

    part: bpy.props.EnumProperty(
        name="Part", description="What to build", items=_CHOICES, default=ALL, options={"SKIP_SAVE"}
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        if properties.part == ALL:
            return (
                "Build the scene of the run and replace the previous build. "
                "If the Blender scene has other content, Firetwin adds a new scene"
            )
        return f"Rebuild the {properties.part}; manual changes to other parts remain"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _can_build(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Build smoke in a worker process, then all other parts in this one."""
        return (yield from steps(context, self.part))


class FIRETWIN_OT_solve(Working, bpy.types.Operator):
    """Solve the flow of air and smoke once, and replace the preview.

    Solved snapshots are cached and reused; a stopped solution resumes from them
    """

    bl_idname = solve.OPERATOR
    bl_label = "Solve smoke"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not solve.replaced_method(context.scene.firetwin):
            cls.poll_message_set("The smoke is already solved, or Build scene solves it")
            return False
        return _can_build(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Select the solver, and build the smoke, or all parts of an empty scene."""
        panel = context.scene.firetwin
        panel.smoke.method, panel.bake_smoke = solve.replaced_method(panel), True
        return (yield from steps(context, "smoke" if owned.has_data(context.scene) else ALL))


def steps(context: bpy.types.Context, part: str) -> Steps:
    """Build one part of the scene, or all parts."""
    from ..jobs import bake
    from ..jobs.tiles import imagery, selection
    from ..scene import build

    uid, settings = context.scene.session_uid, context.scene.firetwin
    parts = tuple(PARTS) if part == ALL else (part,)
    for text in camera_edits.read_camera_edits(context.scene):
        yield Message(text, "WARNING")
    yield from auto_framing.reframe(uid)
    settings = owned.scene(uid).firetwin
    then = changed_settings.compute_digests(settings)
    chosen, smoke = scene_file.shot_source(settings), settings.bake_smoke and "smoke" in parts
    if settings.tiles.sources:
        yield InThread("tiles", functools.partial(selection.prepare, chosen))
    shot, moving = yield InThread("reading the run", lambda **_: _read_shot(chosen, part == ALL))
    if smoke and shot.settings.smoke.enabled:
        yield InThread("smoke", functools.partial(bake.run, chosen, volumes=True))
        yield InThread("removing old smoke", lambda **_: _limit_cache())
    if shot.settings.terrain.photo_url and "terrain" in parts:
        yield InThread("orthophoto", functools.partial(imagery.prepare, chosen, ()))
    yield "removing the previous build"
    if bpy.context.mode != "OBJECT":
        raise Error("leave the edit mode, then build again")
    new = not owned.has_data(owned.scene(uid))
    before, (uid, words) = uid, target_scene.prepare(owned.scene(uid), part=part != ALL)
    new = new or uid != before
    told: list[str] = []
    yield from build.steps(shot, owned.scene(uid), parts, told.append)
    yield from live.rebuild(shot, uid, parts)
    changed_settings.store_digests(owned.scene(uid).firetwin, then, parts)
    _finish_build(owned.scene(uid), shot, moving, parts, new)
    if "smoke" in parts:
        smoke_volumes.store(owned.scene(uid), shot, chosen)
    yield from solve.estimate_cost(uid)
    for text in (*shot.warnings(), *camera_warnings.mono_vr(shot.settings.cameras), *told):
        yield Message(text, "WARNING")
    what = f"{shot.frames.count} frames" if part == ALL else f"the {part}"
    return f"Built {what} of {shot.run.name}" + (f"; {words}" if words else "")


def _limit_cache() -> None:
    """Remove the smoke that was unused for longest beyond the limit of the preferences."""
    from ..jobs import cache

    limit = preferences.cache_limit()
    folder = Path(bpy.path.abspath(preferences.cache_folder()))
    if limit is not None and folder.is_dir():
        cache.prune(cache.by_last_use([folder]), limit)


def _read_shot(chosen: ShotSource, whole: bool) -> tuple[Shot, MovingPoints | None]:
    """Return the shot and, for a build of all parts, the ignition and the head's positions."""
    shot = chosen.shot()
    return shot, station_signs.find_moving_points(shot) if whole else None


def _finish_build(
    scene: bpy.types.Scene, shot: Shot, moving: MovingPoints | None, parts: tuple[str, ...], new: bool
) -> None:
    """Set engine and view layers of Firetwin's scene, the panel's state, and the clipping of the 3D views."""
    from ..blender import devices
    from ..render import credits, engine, layers

    here = owned.stage(scene)
    if here.is_own and (new or len(parts) == len(PARTS)):
        layers.build(shot.settings, here)
        engine.apply(shot.settings, scene)
        engine.set_metadata(shot.run, scene)
        credits.stamp(here)
        devices.follow_preferences(shot.settings.render.device, scene)
    else:
        layers.complete(shot.settings, here, parts)
    panel_state.store(scene, shot, moving)
    if "terrain" in parts:
        tile_facts.remember(scene.firetwin, shot)
    if new:
        view.align_views(scene)
    else:
        view.extend_clipping(scene)


class FIRETWIN_OT_remove(bpy.types.Operator):
    """Remove what Firetwin built in this scene; other objects remain"""

    bl_idname = "firetwin.remove"
    bl_label = "Remove scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not working.is_editable(cls, context):
            return False
        if not owned.has_data(context.scene):
            cls.poll_message_set("Firetwin has built nothing in this scene")
            return False
        return working.is_object_mode(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_confirm(
            self,
            event,
            title="Remove what Firetwin built?",
            message="Manual changes to it are removed too. Settings remain, and undo restores everything",
            confirm_text="Remove",
        )

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene = context.scene
        view.restore_clipping(scene)
        panel_state.clear(scene)
        tile_facts.forget(scene.firetwin)
        changed_settings.clear(scene.firetwin)
        target_scene.remove(scene)
        smoke_volumes.refresh()
        self.report({"INFO"}, "Removed what Firetwin built")
        return {"FINISHED"}


class FIRETWIN_MT_parts(bpy.types.Menu):
    """Rebuild one part, or remove all parts"""

    bl_idname = "FIRETWIN_MT_parts"
    bl_label = "Rebuild Parts"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        for name, label, _ in _CHOICES[1:]:
            layout.operator(FIRETWIN_OT_build.bl_idname, text=f"Rebuild {label}").part = name
        layout.separator()
        layout.operator(FIRETWIN_OT_remove.bl_idname, text="Remove all parts", icon="TRASH")


def draw_rebuild_button(layout: bpy.types.UILayout, part: str, due: bool = False) -> None:
    """Draw a rebuild button in a panel's header, highlighted if the part is out of date."""
    row = layout.row(align=True)
    row.enabled, row.alert = job.Job.current is None, due
    row.operator(FIRETWIN_OT_build.bl_idname, text="", icon="FILE_REFRESH", emboss=due).part = part
    row.label(text="", icon="BLANK1")


class FIRETWIN_PT_build(SidebarPanel, bpy.types.Panel):
    """Scene built from the run"""

    bl_idname = "FIRETWIN_PT_build"
    bl_label = "Scene"
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.firetwin
        row = layout.row(align=True)
        row.scale_y = 1.3
        working.draw_button(row, FIRETWIN_OT_build, "WORLD")
        if job.Job.current is None:
            row.menu(FIRETWIN_MT_parts.bl_idname, text="", icon="DOWNARROW_HLT")
        if settings.changed:
            names = ", ".join(map(keys.section_title, settings.changed.split()))
            draw_paragraph(context, layout.column(align=True), f"Changed since the build: {names}", "INFO")
        column = layout.column()
        column.enabled = job.Job.current is None
        quality.draw(column, settings)
        column.prop(settings, "bake_smoke")
        solve.draw(column, settings)
        smoke_volumes.draw(context, layout)
        live.draw(column, context.scene)
        labelled_row(column, "Seed").prop(settings, "seed", text="")
        row = layout.row(align=True)
        row.operator(view.FIRETWIN_OT_view.bl_idname, text="Through camera", icon="CAMERA_DATA").whole = False
        row.operator(view.FIRETWIN_OT_view.bl_idname, text="Whole run", icon="WORLD_DATA").whole = True
        working.draw_messages(context, layout, FIRETWIN_OT_build)


classes = (
    FIRETWIN_OT_build,
    FIRETWIN_OT_solve,
    FIRETWIN_OT_remove,
    *view.classes,
    *live.classes,
    FIRETWIN_MT_parts,
    FIRETWIN_PT_build,
)
