"""Operators and panel of farm jobs, with the functions of `firetwin farm`."""

from __future__ import annotations

import functools
import shlex
import zlib
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import bpy

from ..errors import Error
from ..jobs.worker import Stop, StoppedError
from ..progress import MessageCallback, Progress, count
from ..shot.source import ShotSource
from ..ui import camera_edits, job, keys, run, scene_file, working
from ..ui.folder_watch import FolderWatch
from ..ui.job import InThread, Message, Steps
from ..ui.menu_entries import MenuEntry
from ..ui.sidebar import SidebarPanel
from ..ui.text import draw_paragraph, labelled_row
from ..ui.working import Working
from . import engines, plan, status, submission
from .status import Status
from .submission import Submission

NOT_SAVED = "Save the .blend file first; the scene file of the job is written next to it"
NO_OUTPUT = "Choose an output folder for the farm first"
NO_JOB = "has no farm job; write one with Write farm job"
_PERIOD = 10.0  # s between readings of the status


def _engine_items() -> tuple[tuple[str, str, str, str, int], ...]:
    """List the schedulers; the number of each in .blend files does not change when others are added."""
    texts = {name: engine.help.partition(":") for name, engine in engines.known().items()}
    return tuple(
        (name, label, keys.sentence(words.strip()), "NONE", zlib.crc32(name.encode()) >> 1)
        for name, (label, _, words) in texts.items()
    )


def _output_folder(panel: bpy.types.PropertyGroup) -> Path:
    return Path(scene_file.resolve_path(panel.farm_output))


def _parse_options(panel: bpy.types.PropertyGroup) -> tuple[str, ...]:
    """Split the options of the scheduler.

    Raises
    ------
    Error
        A quotation mark is not closed.
    """
    try:
        return tuple(shlex.split(panel.farm_options))
    except ValueError as error:
        raise Error(f"Options: {str(error).lower()}; write them as on a command line") from None


def _has_output(cls: type[bpy.types.Operator], panel: bpy.types.PropertyGroup) -> bool:
    """Return whether an output folder is set; otherwise set the poll message."""
    if panel.farm_output.startswith("//") and not bpy.data.filepath:
        cls.poll_message_set(NOT_SAVED)
        return False
    if not panel.farm_output:
        cls.poll_message_set(NO_OUTPUT)
    return bool(panel.farm_output)


def _can_write(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether a job can be written; otherwise set the poll message."""
    if not run.is_ready(cls, context):
        return False
    if not bpy.data.filepath:
        cls.poll_message_set(NOT_SAVED)
        return False
    return _has_output(cls, context.scene.firetwin)


def _check_job(out: Path) -> None:
    """Check that a folder has a job; the error message names the panel's button."""
    if not (plan.job_dir(out) / plan.FILE).is_file():
        raise Error(f"{out} {NO_JOB}")


def _write_job(
    scene: Path,
    out: Path,
    size: int,
    chosen: Submission,
    progress: Progress,
    tell: MessageCallback,
    stop: Stop,
) -> list[str]:
    """Plan and write a job in a thread; return the command that submits it."""
    found = plan.make_job(ShotSource(str(scene)).shot(), scene, size)
    if stop.asked:
        raise StoppedError
    plan.write(found, out)
    for line in submission.describe(found, out):
        tell(line)
    return submission.prepare(out, chosen)


def _find_missing(
    out: Path,
    options: Callable[[str], tuple[str, ...]],
    progress: Progress,
    tell: MessageCallback,
    stop: Stop,
) -> list[str]:
    """Find missing pictures in a thread; return the command that submits their tasks."""

    def followed(done: int, total: int, what: str = "", note: str = "") -> None:
        if stop.asked:
            raise StoppedError
        progress(done, total, what, note)

    missing, numbers = submission.find_missing(out, followed)
    if stop.asked:
        raise StoppedError
    tell(f"{count(len(missing), 'picture')} missing: {count(len(numbers), 'task')} to submit")
    before = submission.last_submission(out)
    chosen = Submission(before.engine, options(before.engine) or before.options)
    return submission.prepare(out, chosen, numbers)


def _write_files(context: bpy.types.Context) -> Generator[InThread | Message, Any, list[str]]:
    """Write the scene file next to the .blend file, and its job; return the submit command."""
    panel = context.scene.firetwin
    for text in camera_edits.read_camera_edits(context.scene):
        yield Message(text, "WARNING")
    chosen = Submission(panel.farm_engine, _parse_options(panel))
    out, size = _output_folder(panel), panel.farm_chunk
    scene, fresh = scene_file.write_next_to_blend(context.scene)
    try:
        yield Message(f"The scene file of the job is {scene}")
        work = functools.partial(_write_job, scene, out, size, chosen)
        return (yield InThread("planning the film", work))
    except BaseException:
        if fresh:
            scene.unlink(missing_ok=True)
        raise


def _submit(command: list[str], out: Path, last: str) -> Steps:
    """Run a scheduler's command, then read the status of the job."""
    yield InThread("submitting", functools.partial(submission.run_command, command, out))
    status_watch.start(out, (yield InThread("reading the status", lambda **_: status.gather(out))))
    return last


def _read_status(out: Path) -> Status | str:
    """Read the status of a job, or the message of an error."""
    try:
        return status.gather(out)
    except Exception as error:
        return job.describe_error(error)


def _is_final(state: Status | str) -> bool:
    return isinstance(state, str) or not (state.running or state.waiting)


status_watch = FolderWatch(_read_status, _is_final, _PERIOD)
"""Watch of the job of the open file."""


class FarmProperties:
    """Properties of the scene that this panel shows."""

    farm_engine: bpy.props.EnumProperty(
        name="Scheduler", description="Scheduler that runs the tasks", items=_engine_items(), default="slurm"
    )
    farm_output: bpy.props.StringProperty(
        name="Output",
        description="Folder for the film and the job, with the same path on all machines of the farm; "
        "each job needs a separate folder",
        subtype="DIR_PATH",
        default="//firetwin_farm",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    farm_chunk: bpy.props.IntProperty(
        name="Frames per task",
        description="Frames per task; rounded up to multiples of Chunk if the build chunk splits the film",
        default=plan.CHUNK,
        min=1,
    )
    farm_options: bpy.props.StringProperty(
        name="Options", description="Options of the scheduler's command, as on a command line"
    )


class FIRETWIN_OT_farm_write(Working, bpy.types.Operator):
    """Plan the film as tasks of a render farm and write the scheduler's job; nothing is submitted"""

    bl_idname = "firetwin.farm_write"
    bl_label = "Write farm job"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _can_write(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Plan in a thread."""
        command = yield from _write_files(context)
        return f"To submit it: {shlex.join(command)}"


class FIRETWIN_OT_farm_submit(Working, bpy.types.Operator):
    """Plan the film as tasks of a render farm, write the scheduler's job and submit it"""

    bl_idname = "firetwin.farm_submit"
    bl_label = "Submit farm job"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _can_write(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Plan in a thread, then wait for the scheduler's command."""
        out = _output_folder(context.scene.firetwin)
        command = yield from _write_files(context)
        return (yield from _submit(command, out, f"Submitted the job of {out}"))


class _JobOperator(Working):
    """An operator on the job of the output folder."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return working.is_editable(cls, context) and _has_output(cls, context.scene.firetwin)


class FIRETWIN_OT_farm_status(_JobOperator, bpy.types.Operator):
    """Read how many tasks and pictures of the job are finished, from its files"""

    bl_idname = "firetwin.farm_status"
    bl_label = "Read farm status"
    bl_options = {"REGISTER"}

    def steps(self, context: bpy.types.Context) -> Steps:
        """Read the files in a thread; the panel reads them again while tasks are unfinished."""
        out = _output_folder(context.scene.firetwin)
        _check_job(out)
        found = yield InThread("reading the status", lambda **_: status.gather(out))
        status_watch.start(out, found)
        return "; ".join(text for _, text in status.rows(found))


class FIRETWIN_OT_farm_resume(_JobOperator, bpy.types.Operator):
    """Read all pictures of the job and submit the tasks of those that are missing or damaged"""

    bl_idname = "firetwin.farm_resume"
    bl_label = "Resume farm job"
    bl_options = {"REGISTER"}

    def steps(self, context: bpy.types.Context) -> Steps:
        """Read the pictures in a thread, then wait for the scheduler's command."""
        panel = context.scene.firetwin
        out, engine, own = _output_folder(panel), panel.farm_engine, _parse_options(panel)
        _check_job(out)
        work = functools.partial(_find_missing, out, lambda before: own if before == engine else ())
        command = yield InThread("reading the pictures", work)
        return (yield from _submit(command, out, f"Submitted the tasks of missing pictures in {out}"))


class FIRETWIN_OT_farm_cancel(_JobOperator, bpy.types.Operator):
    """Cancel the submitted tasks of the job. Finished pictures remain"""

    bl_idname = "firetwin.farm_cancel"
    bl_label = "Cancel farm job"
    bl_options = {"REGISTER"}

    def steps(self, context: bpy.types.Context) -> Steps:
        """Wait for the scheduler's command."""
        out = _output_folder(context.scene.firetwin)
        _check_job(out)
        command = submission.cancel_command(out)
        yield InThread("cancelling", functools.partial(submission.run_command, command, out))
        return f"Cancelled the job of {out}; Resume farm job continues it"


class FIRETWIN_PT_farm(SidebarPanel, bpy.types.Panel):
    """Film of all cameras and frames as a render farm job"""

    bl_idname = "FIRETWIN_PT_farm"
    bl_label = "On a farm"
    bl_parent_id = "FIRETWIN_PT_render"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        column = working.settings_column(layout)
        column.prop(panel, "farm_engine")
        column.prop(panel, "farm_output")
        column.prop(panel, "farm_chunk")
        column.prop(panel, "farm_options", placeholder="--partition=gpu --time=4:00:00")
        if not bpy.data.filepath:
            draw_paragraph(context, layout.column(align=True), NOT_SAVED, "INFO")
        working.draw_button(layout.row(align=True), FIRETWIN_OT_farm_write, "FILE_TICK")
        working.draw_button(layout.row(align=True), FIRETWIN_OT_farm_submit, "EXPORT")
        working.draw_button(layout.row(align=True), FIRETWIN_OT_farm_status, "FILE_REFRESH")
        row = layout.row(align=True)
        working.draw_button(row, FIRETWIN_OT_farm_resume, "PLAY")
        working.draw_button(row, FIRETWIN_OT_farm_cancel, "CANCEL")
        for operator in _WORKS:
            working.draw_messages(context, layout, operator)
        if panel.farm_output and scene_file.resolve_path(panel.farm_output):
            _draw_status(context, layout, status_watch.states.get(_output_folder(panel)))


def _draw_status(context: bpy.types.Context, layout: bpy.types.UILayout, state: Status | str | None) -> None:
    """Draw the last status of the job: tasks, pictures, remaining time and errors."""
    if state is None:
        return
    box = layout.box().column(align=True)
    if isinstance(state, str):
        draw_paragraph(context, box, state, "ERROR")
        return
    box.progress(factor=state.finished / max(state.pictures, 1), text=status.rows(state)[1][1])
    for label, text in status.rows(state):
        labelled_row(box, keys.sentence(label)).label(text=text)
    for line in status.failures(state):
        draw_paragraph(context, box, keys.sentence(line), "ERROR")


_WORKS = (
    FIRETWIN_OT_farm_write,
    FIRETWIN_OT_farm_submit,
    FIRETWIN_OT_farm_status,
    FIRETWIN_OT_farm_resume,
    FIRETWIN_OT_farm_cancel,
)
classes = (*_WORKS, FIRETWIN_PT_farm)
properties = FarmProperties


def unregister() -> None:
    """Stop watching the job."""
    status_watch.clear()


menu = {
    "Render": (
        MenuEntry("farm_write", icon="FILE_TICK"),
        MenuEntry("farm_submit", icon="EXPORT"),
        MenuEntry("farm_status", icon="FILE_REFRESH"),
        MenuEntry("farm_resume", icon="PLAY"),
        MenuEntry("farm_cancel", icon="CANCEL"),
    )
}
