"""Operators and panel of stories, with the functions of `firetwin story`.

The list of shots mirrors the storyboard of the folder, which every change reads and writes again. It belongs
to the window manager, as the file, not the scene, has the shots. Operators read files; drawing reads none.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import bpy.utils.previews

from .. import output
from ..errors import Error
from ..shot.settings import scene_file as file
from ..ui import job as task
from ..ui import run, scene_file, working
from ..ui.job import InThread, Steps
from ..ui.menu_entries import MenuEntry
from ..ui.sidebar import SidebarPanel
from ..ui.working import Working
from . import film, story_file
from . import job as story_job
from .job import StoryRequest
from .quality import QUALITIES
from .scenes import FOLDER
from .storyboard import CARD, Storyboard, StoryShot

NO_FOLDER = "Save the .blend file or choose a folder for the story first"
NO_SHOTS = "Make or read a story first"
_LINE = "\\n"
"""Line break of a caption in a field of one line."""
_thumbnails: list[bpy.utils.previews.ImagePreviewCollection] = []
"""The collection of thumbnails, once there are any."""


def _folder(scene: bpy.types.Scene) -> Path:
    """Return the folder of the story.

    Raises
    ------
    Error
        There is none.
    """
    folder = scene_file.resolve_path(scene.firetwin.story_folder)
    if not folder:
        raise Error(NO_FOLDER)
    return Path(folder)


def _thumbnail(folder: Path, shot: str) -> int:
    """Load the middle one of a shot's pictures, and return its icon; 0 without any."""
    paths = sorted((folder / FOLDER / shot).glob("*/*.png"))
    if not paths:
        return 0
    path = paths[len(paths) // 2]
    key = f"{path} {path.stat().st_mtime_ns}"
    if not _thumbnails:
        _thumbnails.append(bpy.utils.previews.new())
    icons = _thumbnails[0]
    return int((icons.get(key) or icons.load(key, str(path), "IMAGE")).icon_id)


def _free_thumbnails() -> None:
    while _thumbnails:
        bpy.utils.previews.remove(_thumbnails.pop())


def show(story: Storyboard | None) -> None:
    """Fill the list with the shots of a storyboard; None: with none."""
    panel = bpy.context.window_manager.firetwin_story
    chosen = panel.shots[panel.index].name if panel.index < len(panel.shots) else ""
    panel.shots.clear()
    _free_thumbnails()
    for shot in story.shots if story else ():
        item = panel.shots.add()
        item.name, item.picture, item.seconds = shot.name, shot.picture, shot.seconds
        item.caption = shot.caption.replace("\n", _LINE)
        item.icon = _thumbnail(story.path.parent, shot.name) if story else 0
    panel.index = max(panel.shots.find(chosen), 0)
    working.redraw()


def on_folder_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Show the storyboard of another folder (update callback)."""
    if task.Job.current is not None:
        return
    path = Path(scene_file.resolve_path(settings.story_folder), story_file.NAME)
    try:
        show(story_file.read(path) if settings.story_folder and path.is_file() else None)
    except Error as error:
        show(None)
        settings.problem = task.describe_error(error)


class FIRETWIN_PG_storyshot(bpy.types.PropertyGroup):
    """A shot of the story"""

    picture: bpy.props.StringProperty()
    seconds: bpy.props.FloatProperty()
    caption: bpy.props.StringProperty()
    icon: bpy.props.IntProperty()


class FIRETWIN_PG_story(bpy.types.PropertyGroup):
    """Shots of the story in the panel's folder"""

    shots: bpy.props.CollectionProperty(type=FIRETWIN_PG_storyshot, name="Shots")
    index: bpy.props.IntProperty(name="Shot", description="Selected shot of the list")


class StoryProperties:
    """Properties of the scene that this panel shows."""

    story_folder: bpy.props.StringProperty(
        name="Folder",
        description="Folder of the story: storyboard, pictures, project and film",
        subtype="DIR_PATH",
        default="//firetwin_story",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        update=on_folder_changed,
    )
    story_quality: bpy.props.EnumProperty(
        name="Quality",
        description="Size and number of the pictures",
        items=tuple(
            (name, name.capitalize(), f"{each.resolution[0]} x {each.resolution[1]} pixels")
            for name, each in QUALITIES.items()
        ),
    )


class FIRETWIN_UL_story(bpy.types.UIList):
    """Shots of the story, in the order of the film"""

    bl_idname = "FIRETWIN_UL_story"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
    ) -> None:
        row = layout.row(align=True)
        kind = "FONT_DATA" if item.picture == CARD else "IMAGE_DATA"
        shown = {"icon_value": item.icon} if item.icon else {"icon": kind}
        row.label(text=item.name, **shown)
        length = row.row()
        length.alignment = "RIGHT"
        length.label(text=f"{item.seconds:g} s")


def _selected(context: bpy.types.Context) -> FIRETWIN_PG_storyshot | None:
    panel = context.window_manager.firetwin_story
    return panel.shots[panel.index] if 0 <= panel.index < len(panel.shots) else None


def _has_folder(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether there is a folder and no task is running; otherwise set the poll message."""
    if not scene_file.resolve_path(context.scene.firetwin.story_folder):
        cls.poll_message_set(NO_FOLDER)
        return False
    return working.is_free(cls)


def _has_shot(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether a shot is selected and no task is running; otherwise set the poll message."""
    if _selected(context) is None:
        cls.poll_message_set(NO_SHOTS)
        return False
    return _has_folder(cls, context)


class FIRETWIN_OT_story_make(Working, bpy.types.Operator):
    """Choose the shots of one film that tells the fire of the run, or read the storyboard of the folder"""

    bl_idname = "firetwin.story_make"
    bl_label = "Make or read story"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return run.is_ready(cls, context) and _has_folder(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Write the scene file of the story, and choose its shots in a thread."""
        out = _folder(context.scene)
        source = out / "scene.toml"
        if not (out / story_file.NAME).exists():
            output.write_text(source, file.text(scene_file.read_settings(context.scene, source)))
        work = functools.partial(story_job.run, StoryRequest(source, out, film=False))
        paths = yield InThread("choosing the shots", work)
        show(story_file.read(paths[0]))
        return f"The story is in {out}"


class FIRETWIN_OT_story_render(Working, bpy.types.Operator):
    """Render the missing pictures of the story, its project and its film. Finished pictures remain"""

    bl_idname = "firetwin.story_render"
    bl_label = "Render story"
    bl_options = {"REGISTER"}

    shot: bpy.props.StringProperty(
        name="Shot", description="Name of the only shot to render; empty: the film", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _has_shot(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Render in worker processes."""
        out = _folder(context.scene)
        request = StoryRequest(
            out, out, only=self.shot, quality=context.scene.firetwin.story_quality, resume=True
        )
        try:
            paths = yield InThread("rendering the story", functools.partial(story_job.run, request))
        finally:
            show(story_file.read(out / story_file.NAME))
        return f"Wrote {paths[-1]}" if self.shot else f"Wrote {out / film.FILM}"


def _change(context: bpy.types.Context, change: Callable[[list[StoryShot], int], None]) -> set[str]:
    """Change the selected shot in the file, which may have changed since it was read."""
    story = story_file.read(_folder(context.scene) / story_file.NAME)
    shots, chosen = list(story.shots), _selected(context)
    names = [shot.name for shot in shots]
    if chosen is None or chosen.name not in names:
        show(story)
        raise Error(f"{story.path} has changed: it has no such shot; the list is read again")
    change(shots, names.index(chosen.name))
    story = replace(story, shots=tuple(shots))
    story_file.write(story, overwrite=True)
    show(story)
    return {"FINISHED"}


class FIRETWIN_OT_story_move(bpy.types.Operator):
    """Move the selected shot of the story to another place in the film"""

    bl_idname = "firetwin.story_move"
    bl_label = "Move shot of story"
    bl_options = {"REGISTER"}

    by: bpy.props.IntProperty(name="By", description="Places to move it; -1: earlier", default=-1)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _has_shot(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        by = self.by
        return _change(context, lambda shots, at: shots.insert(max(at + by, 0), shots.pop(at)))


class FIRETWIN_OT_story_edit(bpy.types.Operator):
    """Change the length and the caption of the selected shot of the story"""

    bl_idname = "firetwin.story_edit"
    bl_label = "Edit shot of story"
    bl_options = {"REGISTER"}

    seconds: bpy.props.FloatProperty(
        name="Length", description="Length of the shot in the film", min=0.5, max=600.0, unit="TIME_ABSOLUTE"
    )
    caption: bpy.props.StringProperty(
        name="Caption", description=f"Caption of the shot; {_LINE} is a line break"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _has_shot(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the present values in a dialog."""
        chosen = _selected(context)
        if chosen is not None:
            self.seconds, self.caption = chosen.seconds, chosen.caption
        return context.window_manager.invoke_props_dialog(self, width=500)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        values: dict[str, Any] = {}
        if self.properties.is_property_set("seconds"):
            values["seconds"] = round(self.seconds, 3)
        if self.properties.is_property_set("caption"):
            values["caption"] = self.caption.replace(_LINE, "\n")

        def change(shots: list[StoryShot], at: int) -> None:
            shots[at] = replace(shots[at], **values)

        return _change(context, change)


class FIRETWIN_OT_story_open(bpy.types.Operator):
    """Open the project of the story in the Video Sequencer, in place of this file"""

    bl_idname = "firetwin.story_open"
    bl_label = "Open story in Video Sequencer"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _has_folder(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask before changes of the open file are lost."""
        if bpy.data.is_dirty:
            return context.window_manager.invoke_confirm(self, event, message="Changes of this file are lost")
        return self.execute(context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        path = _folder(context.scene) / film.BLEND
        if not path.is_file():
            raise Error(f"there is no {path}; press {FIRETWIN_OT_story_render.bl_label} first")
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
        from .sequencer import SCENE_NAME

        for window in bpy.context.window_manager.windows:
            window.scene = bpy.data.scenes[SCENE_NAME]
            area = max(window.screen.areas, key=lambda each: each.width * each.height)
            area.type = "SEQUENCE_EDITOR"
            area.spaces.active.view_type = "SEQUENCER_PREVIEW"
        return {"FINISHED"}


class FIRETWIN_PT_story(SidebarPanel, bpy.types.Panel):
    """One film that tells the fire of the run"""

    bl_idname = "FIRETWIN_PT_story"
    bl_label = "Story"
    bl_parent_id = "FIRETWIN_PT_render"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = 3

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel, chosen = self.layout, context.scene.firetwin, _selected(context)
        column = working.settings_column(layout)
        column.prop(panel, "story_folder")
        column.prop(panel, "story_quality")
        working.draw_button(layout.row(align=True), FIRETWIN_OT_story_make, "FILE_MOVIE")
        working.draw_messages(context, layout, FIRETWIN_OT_story_make)
        if chosen is None:
            return
        row, story = layout.row(), context.window_manager.firetwin_story
        row.template_list(FIRETWIN_UL_story.bl_idname, "", story, "shots", story, "index", rows=5)
        column = row.column(align=True)
        move, edit = FIRETWIN_OT_story_move.bl_idname, FIRETWIN_OT_story_edit.bl_idname
        column.operator(move, text="", icon="TRIA_UP").by = -1
        column.operator(move, text="", icon="TRIA_DOWN").by = 1
        column.operator(edit, text="", icon="GREASEPENCIL")
        if chosen.icon:
            layout.template_icon(icon_value=chosen.icon, scale=6.0)
        if chosen.picture != CARD and task.Job.current is None:
            text, render = f"Render {chosen.name}", FIRETWIN_OT_story_render.bl_idname
            layout.operator(render, text=text, icon="RENDER_STILL", translate=False).shot = chosen.name
        working.draw_button(layout.row(align=True), FIRETWIN_OT_story_render, "RENDER_ANIMATION")
        layout.operator(FIRETWIN_OT_story_open.bl_idname, icon="SEQUENCE")
        working.draw_messages(context, layout, FIRETWIN_OT_story_render)


def register() -> None:
    """Add the list of shots to the window manager."""
    bpy.types.WindowManager.firetwin_story = bpy.props.PointerProperty(type=FIRETWIN_PG_story)


def unregister() -> None:
    """Remove the list of shots, and free its thumbnails."""
    _free_thumbnails()
    del bpy.types.WindowManager.firetwin_story


classes = (
    FIRETWIN_PG_storyshot,
    FIRETWIN_PG_story,
    FIRETWIN_UL_story,
    FIRETWIN_OT_story_make,
    FIRETWIN_OT_story_render,
    FIRETWIN_OT_story_move,
    FIRETWIN_OT_story_edit,
    FIRETWIN_OT_story_open,
    FIRETWIN_PT_story,
)
properties = StoryProperties
menu = {
    "Render": (
        MenuEntry("story_make", icon="FILE_MOVIE"),
        MenuEntry("story_render", icon="RENDER_ANIMATION"),
        MenuEntry("story_move", "Move shot of story earlier", "TRIA_UP"),
        MenuEntry("story_edit", "Edit shot of story...", "GREASEPENCIL"),
        MenuEntry("story_open", icon="SEQUENCE"),
    )
}
