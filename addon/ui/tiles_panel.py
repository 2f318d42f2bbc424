"""Panel of tiles: what the sources hold, a preview in the 3D view, numbers and credits."""

from __future__ import annotations

import functools
from typing import Any

import bpy

from ..blender import owned
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress
from ..shot.source import ShotSource
from ..shot.tiles.tile_cut import TileCut
from . import job, run, scene_file, target_scene, tile_facts, view, working
from .job import InThread, Steps
from .sidebar import SidebarPanel
from .text import draw_paragraph, labelled_row
from .working import Working

_NO_SOURCE = "Name a tileset in Sources: a folder, a .3tz archive or a URL"


def _ready(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether there are a run and a source; else the tooltip says what is missing."""
    if not context.scene.firetwin.tiles.sources:
        operator.poll_message_set(_NO_SOURCE)
        return False
    return working.is_object_mode(operator, context) and run.is_ready(operator, context)


class FIRETWIN_OT_tiles_preview(Working, bpy.types.Operator):
    """Show the bounding boxes of the tiles at once, then coarse tiles (64 pixels, at most 200 MB).

    The tiles of the film are fetched meanwhile; Build scene shows them
    """

    bl_idname = "firetwin.tiles_preview"
    bl_label = "Preview tiles"
    bl_options = {"REGISTER", "UNDO"}

    boxes: bpy.props.BoolProperty(
        name="Only boxes",
        description="Show only the bounding boxes: no tile is fetched",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        if properties.boxes:
            return "Show the bounding boxes of the tiles. No tile is fetched"
        return (
            "Show the bounding boxes of the tiles at once, then coarse tiles (64 pixels, at most 200 MB). "
            "The tiles of the film are fetched meanwhile; Build scene shows them"
        )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Read and fetch in processes of their own; show in this one."""
        return (yield from steps(context, self.boxes))


def steps(context: bpy.types.Context, only_boxes: bool) -> Steps:
    """Show boxes and coarse tiles, and fetch the tiles of the film."""
    from ..jobs.tiles import bounding_boxes
    from ..scene.tiles import preview

    uid, chosen = context.scene.session_uid, scene_file.shot_source(context.scene.firetwin)
    boxes = yield InThread("reading the tilesets", functools.partial(bounding_boxes.run, chosen))
    yield "drawing the boxes"
    new = not owned.has_data(owned.scene(uid))
    uid, _ = target_scene.prepare(owned.scene(uid), part=True)
    scene, corners = owned.scene(uid), preview.join([each["corners"] for each in boxes])
    preview.show_boxes(owned.stage(scene), corners)
    if new and len(corners):
        view.look_at_points(scene, corners.reshape(-1, 3))
    tile_facts.remember_boxes(scene.firetwin, boxes)
    count = sum(each["tiles"] for each in boxes)
    if only_boxes:
        return f"{count:,} tiles in the root documents of {len(boxes)} tilesets"
    cut = yield InThread("fetching coarse tiles", functools.partial(_cut, chosen, coarse=True))
    yield "showing coarse tiles"
    scene = owned.scene(uid)
    preview.show_tiles(owned.stage(scene), cut)
    tile_facts.remember_cut(scene.firetwin, cut, "Preview")
    cut = yield InThread("fetching the tiles of the film", functools.partial(_cut, chosen, coarse=False))
    tile_facts.remember_cut(owned.scene(uid).firetwin, cut, "Film")
    return f"{len(cut.tiles):,} tiles are ready: Build scene shows them"


def _cut(
    chosen: ShotSource, progress: Progress, tell: MessageCallback, stop: Stop, coarse: bool
) -> TileCut | None:
    """Prepare a choice of tiles in a process, and read it."""
    from ..jobs.tiles import selection
    from ..shot.tiles import tile_cut

    selection.prepare(chosen, (), progress, tell, stop, preview=coarse)
    shot = chosen.shot()
    return tile_cut.of_shot(selection.coarse_shot(shot) if coarse else shot)


class FIRETWIN_OT_tiles_clear(working.Editable, bpy.types.Operator):
    """Remove the preview of tiles; tiles that were built stay"""

    bl_idname = "firetwin.tiles_clear"
    bl_label = "Remove tile preview"
    bl_options = {"REGISTER", "UNDO"}

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..scene.tiles import build, preview

        if not owned.has_data(context.scene):
            return {"CANCELLED"}
        stage = owned.stage(context.scene)
        preview.remove(stage)
        if not stage.objects_of(build.PART):
            tile_facts.forget(context.scene.firetwin)
        if not owned.has_data(context.scene):
            view.restore_clipping(context.scene)
        return {"FINISHED"}


class FIRETWIN_PT_tiles(SidebarPanel, bpy.types.Panel):
    """Sources of tiles, their preview, numbers and credits"""

    bl_idname = "FIRETWIN_PT_tiles"
    bl_label = "Tile Preview"
    bl_parent_id = "FIRETWIN_PT_section_tiles"

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        row = layout.row(align=True)
        working.draw_button(row, FIRETWIN_OT_tiles_preview, "MESH_GRID")
        if job.Job.current is None:
            row.operator(FIRETWIN_OT_tiles_preview.bl_idname, text="", icon="CUBE").boxes = True
            row.operator(FIRETWIN_OT_tiles_clear.bl_idname, text="", icon="TRASH")
        if panel.tile_facts:
            _draw_facts(context, layout.column(align=True), tile_facts.read(panel.tile_facts))
        working.draw_messages(context, layout, FIRETWIN_OT_tiles_preview)


def _draw_facts(context: bpy.types.Context, column: bpy.types.UILayout, facts: dict[str, Any]) -> None:
    for source in facts["sources"]:
        draw_paragraph(context, column, source, "FILE_3D")
    for label, text in facts["lines"]:
        labelled_row(column, label).label(text=text)
    for text in facts["missing"]:
        draw_paragraph(context, column, text, "ERROR")
    if facts["credits"]:
        draw_paragraph(context, column, f"Credits: {'; '.join(facts['credits'])}")


classes = (FIRETWIN_OT_tiles_preview, FIRETWIN_OT_tiles_clear, FIRETWIN_PT_tiles)
