"""Smoke volumes of a built scene: written for frames that the user chooses, and before a frame is rendered.

A .blend file can be built without its smoke volumes, which take seconds and 50 MB per frame. The panel reads
a stored list of missing frames, so drawing it does not access the disk.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import bpy

from .. import files
from ..blender import owned
from ..blender.owned import Stage
from ..errors import Error
from ..jobs.worker import StoppedError
from ..progress import count, say
from ..scene.smoke import volume_files
from ..shot.shot import Shot
from ..shot.source import ShotSource
from . import job, scene_file, working
from .job import InThread, JobResult, Message, Steps
from .text import draw_paragraph
from .working import Working

_UNKNOWN = (
    "this scene does not have the settings of its smoke, because an earlier version built it; build it again"
)
_FRAME, _RANGE = "frame", "range"


@dataclass
class _State:
    """Number of frames with smoke, and those without volumes."""

    frames: int
    missing: set[int]


_states: dict[int, _State] = {}
"""Smoke of scenes, by `session_uid`."""


def _state(scene: bpy.types.Scene) -> _State:
    """Return the stored state of a scene; it is read once after a file was opened or changed."""
    uid = scene.session_uid
    if uid not in _states:
        stage = owned.find_stage(scene)
        missing = volume_files.missing(stage) if stage else ()
        _states[uid] = _State(volume_files.count(stage) if stage else 0, set(missing))
    return _states[uid]


@bpy.app.handlers.persistent
def refresh(*_: object) -> None:
    """Read the state of scenes again when it is next shown."""
    _states.clear()


@bpy.app.handlers.persistent
def _look_for_frame(scene: bpy.types.Scene, *_: object) -> None:
    """Check a frame that had no volumes, when it is shown: another program may have written them."""
    stage, state = owned.find_stage(scene), _states.get(scene.session_uid)
    if stage and state and scene.frame_current in state.missing:
        state.missing -= {scene.frame_current} - {*volume_files.missing(stage, [scene.frame_current])}


def store(scene: bpy.types.Scene, shot: Shot, chosen: ShotSource) -> None:
    """Store the settings of smoke that was just built, and build the notice of missing volumes."""
    from ..scene.smoke import notice

    stage = owned.stage(scene)
    volume_files.store_source(stage, files.read_text(Path(chosen.scene)), chosen.beside)
    notice.build(shot.full, stage)
    refresh()


def _source(stage: Stage) -> ShotSource:
    """Return the shot source from which the smoke of a scene was built."""
    text, run = volume_files.read_source(stage)
    if not text:
        raise Error(_UNKNOWN)
    name = hashlib.sha256(text.encode()).hexdigest()[:16]
    path = scene_file.temporary_folder() / f"{name}.toml"
    if not path.is_file():
        files.write_text(path, text)
    return ShotSource(str(path), beside=run)


def _range(scene: bpy.types.Scene) -> range:
    """Return the playback range, or the preview range if it is on."""
    if scene.use_preview_range:
        return range(scene.frame_preview_start, scene.frame_preview_end + 1)
    return range(scene.frame_start, scene.frame_end + 1)


class FIRETWIN_OT_smoke_volumes(Working, bpy.types.Operator):
    """Write missing smoke volumes, so that Blender shows and renders the smoke"""

    bl_idname = "firetwin.smoke_volumes"
    bl_label = "Write smoke of frames"
    bl_options = {"REGISTER", "UNDO"}

    which: bpy.props.EnumProperty(
        name="Frames",
        description="Frames whose smoke volumes are written",
        items=(
            (_FRAME, "This frame", "Current frame"),
            (_RANGE, "Playback range", "Playback range, or the preview range if it is on"),
        ),
        default=_FRAME,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        chosen = "current frame" if properties.which == _FRAME else "frames that are played"
        return (
            f"Write the missing smoke volumes of the {chosen}, so that Blender shows and renders the smoke. "
            "The first one takes minutes if the smoke is not solved yet, each further one seconds"
        )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _state(context.scene).frames:
            cls.poll_message_set("Build a scene with smoke first")
            return False
        return working.is_editable(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Write the volumes in a worker process, then show them."""
        from ..jobs import bake

        scene = context.scene
        uid, stage = scene.session_uid, owned.stage(scene)
        frames = [scene.frame_current] if self.which == _FRAME else _range(scene)
        missing = volume_files.missing(stage, frames)
        if not missing:
            return _nothing_to_write(stage, frames)
        write = functools.partial(bake.run, _source(stage), volumes=True, frames=missing)
        try:
            places = yield InThread("smoke", write)
        except StoppedError:
            _show(uid)
            raise
        yield "loading the smoke"
        _show(uid, *places)
        return f"Wrote the smoke of {count(len(missing), 'frame')}"


def _nothing_to_write(stage: Stage, frames: Iterable[int]) -> str:
    if not any(1 <= frame <= volume_files.count(stage) for frame in frames):
        return f"The smoke covers frames 1 to {volume_files.count(stage)}; choose some of them"
    return "These frames have their smoke already"


def _show(uid: int, place: Path | None = None) -> None:
    """Let a scene show volumes that were written into the folder `place` (None: into its own)."""
    stage = owned.stage(owned.scene(uid))
    if place is not None and place != volume_files.folder(stage):
        volume_files.set_folder(stage, place)
    volume_files.reload(stage)
    refresh()


def draw(context: bpy.types.Context, layout: bpy.types.UILayout) -> None:
    """Draw the number of missing volumes and the buttons that write them; nothing if none is missing."""
    scene, operator = context.scene, FIRETWIN_OT_smoke_volumes
    state, current = _state(scene), job.Job.current
    if not state.frames:
        return
    column = layout.column(align=True)
    if current is not None and current.name == operator.bl_label:
        working.draw_button(column.row(align=True), operator, "OUTLINER_OB_VOLUME")
    elif state.missing:
        frame, shown = scene.frame_current, _range(scene)
        if frame in state.missing:
            text = f"Frame {frame} has no smoke volume yet: Blender shows it without smoke"
            draw_paragraph(context, column, text, "ERROR")
        there = f"{state.frames - len(state.missing)} of {state.frames} frames have their smoke"
        draw_paragraph(context, column, there)
        row = column.row(align=True)
        pressed = row.operator(operator.bl_idname, text=f"Smoke of frame {frame}", icon="OUTLINER_OB_VOLUME")
        pressed.which = _FRAME
        text = f"Of frames {shown.start} to {shown.stop - 1}"
        row.operator(operator.bl_idname, text=text).which = _RANGE
    working.draw_messages(context, layout, operator)


@bpy.app.handlers.persistent
def write_before_render(scene: bpy.types.Scene, *_: object) -> None:
    """Write the missing volumes of a frame that Blender is about to render.

    This runs in the thread of the render, which waits. If the volumes cannot be written, the reason is
    printed and shown in the panel, and the frame contains a notice (`scene.smoke.notice`).
    """
    from ..jobs import bake

    frame, stage = scene.frame_current, owned.find_stage(scene)
    if stage is None or not volume_files.missing(stage, [frame]) or not volume_files.are_rendered(stage):
        return
    say(f"writing the smoke of frame {frame} before it is rendered")
    try:
        for place in bake.run(_source(stage), tell=say, volumes=True, frames=[frame]):
            if place != volume_files.folder(stage):
                raise Error(
                    "this version of Firetwin makes other smoke than the file has; use Smoke of frames"
                )
    except Exception as error:
        text = f"frame {frame} is rendered without smoke: {job.describe_error(error)}"
        say(text)
        name = FIRETWIN_OT_smoke_volumes.bl_label
        job.Job.last = JobResult(name, (Message(text, "ERROR"),), bpy.data.filepath)
    _soon(functools.partial(_show_rendered, scene.session_uid))


def _soon(work: Callable[[], None]) -> None:
    """Call `work` in the main thread of a Blender with a window."""
    if not bpy.app.background:
        bpy.app.timers.register(work, first_interval=0.5)


def _show_rendered(uid: int) -> None:
    if any(scene.session_uid == uid for scene in bpy.data.scenes):
        _show(uid)
    working.redraw()


_HANDLERS = {
    "frame_change_post": _look_for_frame,
    "load_post": refresh,
    "undo_post": refresh,
    "redo_post": refresh,
    "render_pre": write_before_render,
}


def register() -> None:
    """Follow frames, files and renders."""
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Stop following them."""
    for name, handler in _HANDLERS.items():
        if handler in getattr(bpy.app.handlers, name):
            getattr(bpy.app.handlers, name).remove(handler)
    refresh()


classes = (FIRETWIN_OT_smoke_volumes,)
