"""Modal task operator: shows progress, keeps the window usable, and can be cancelled.

In the background, and when called by a script, all steps of a task run at once. In the window a modal
operator runs them. Esc cancels the task only with the pointer over the sidebar, because it has other meanings
elsewhere. After a step in Blender only mouse events in the sidebar are handled, and views can be turned. A
task that ends early is undone in the window, so that a scene is complete or unchanged.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy

from ..jobs.worker import StoppedError
from . import job, keys, text
from .job import Job, JobResult, Message, Steps, describe_error

_TICK = 0.1  # s
_MOUSE = ("MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "LEFTMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN")
_NAVIGATION = ("MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION")
_ICONS = {"INFO": "INFO", "WARNING": "ERROR", "ERROR": "CANCEL"}


def is_free(cls: type[bpy.types.Operator]) -> bool:
    """Return whether no task is running; otherwise set the poll message."""
    if Job.current is not None:
        cls.poll_message_set(f"{Job.current.name} is not finished; press Stop in the sidebar to end it")
    return Job.current is None


def is_editable(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether no task is running and the scene is editable; otherwise set the poll message."""
    if context.scene.library is not None:
        cls.poll_message_set("This scene is linked from another file: change it there, or make it local")
        return False
    return is_free(cls)


class Editable:
    """An operator of an editable scene, while no task is running."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Return whether it can be used."""
        return is_editable(cls, context)


def is_object_mode(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether Blender is in object mode; otherwise set the poll message."""
    if context.mode != "OBJECT":
        cls.poll_message_set("Leave the edit mode first")
        return False
    return True


def report_errors(execute: Callable[..., set[str]]) -> Callable[..., set[str]]:
    """Turn errors of an operator's `execute` into reports (decorator)."""

    @functools.wraps(execute)
    def wrapper(self: bpy.types.Operator, context: bpy.types.Context) -> set[str]:
        try:
            return execute(self, context)
        except Exception as error:
            self.report({"ERROR"}, job.describe_error(error))
            return {"CANCELLED"}

    return wrapper


def undo_last() -> None:
    """Undo the last step in the first window."""
    with bpy.context.temp_override(window=next(iter(bpy.context.window_manager.windows), None)):
        if bpy.ops.ed.undo.poll():
            bpy.ops.ed.undo()


def cancel_task() -> None:
    """Cancel the running task without a message, which ends its operator."""
    if Job.current is not None:
        Job.current.stop.now()
        Job.current = None
        _redraw_status(bpy.context, None)
    _watch_undo(False)


def _watch_undo(on: bool) -> None:
    """Start or stop watching for undo and redo."""
    for handlers in (bpy.app.handlers.undo_post, bpy.app.handlers.redo_post):
        if _note_undo in handlers:
            handlers.remove(_note_undo)
        if on:
            handlers.append(_note_undo)


def _note_undo(*_: object) -> None:
    if Job.current is not None and Job.current.touched:
        Job.current.undone = True


def is_over_sidebar(window: bpy.types.Window, event: bpy.types.Event) -> bool:
    """Return whether the pointer is over the sidebar of a 3D view."""
    return any(
        region.x <= event.mouse_x < region.x + region.width
        and region.y <= event.mouse_y < region.y + region.height
        for area in window.screen.areas
        if area.type == "VIEW_3D"
        for region in area.regions
        if region.type == "UI" and region.width > 1
    )


class Working:
    """An operator whose `steps(context)` run one by one while its window stays usable."""

    _timer: bpy.types.Timer | None = None

    if TYPE_CHECKING:  # members of bpy.types.Operator
        bl_label: str
        bl_options: set[str]

        def report(self, type: set[str], message: str) -> None:
            """Report a message to the user."""

    def steps(self, context: bpy.types.Context) -> Steps:
        """Yield the steps of the task."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        work = Job.current = Job(self.bl_label, self.steps(context))
        try:
            work.run()
        except Exception as error:
            return self._failed(work, error)
        finally:
            Job.current = None
        self._tell(work, Message(work.result))
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return self.begin(context)

    def begin(self, context: bpy.types.Context) -> set[str]:
        """Run the first step when the window is next idle."""
        self.job = Job.current = Job(self.bl_label, self.steps(context))
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        _watch_undo(True)
        _redraw_status(context, self.job)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if Job.current is not self.job:  # the add-on was disabled
            self._end(context)
            return {"CANCELLED"}
        here = is_over_sidebar(context.window, event)
        if event.type == "ESC" and event.value == "PRESS" and here:
            self.job.stop.now()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            look = event.type == "ESC" or event.type in _NAVIGATION
            free = not self.job.touched or look or (here and event.type in _MOUSE)
            return {"PASS_THROUGH"} if free else {"RUNNING_MODAL"}
        return self._advance(context)

    def _advance(self, context: bpy.types.Context) -> set[str]:
        try:
            over = self.job.advance()
        except Exception as error:
            self._end(context)
            return self._failed(self.job, error, self._goes_back())
        if not over:
            _redraw_status(context, self.job)
            return {"PASS_THROUGH"}  # other timers of the window
        self._end(context)
        self._tell(self.job, Message(self.job.result))
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Handle the opening of another file, or the end of Blender."""
        self.job.stop.now()
        self._end(context)
        gone = Message(f"{self.job.name} stopped because another file was opened", "WARNING")
        Job.last = JobResult(self.job.name, (gone,), None)

    def _tell(self, work: Job, last: Message) -> None:
        """Report the messages, and store them for the panel."""
        messages = tuple({each.text: each for each in (*work.messages, last) if each.text}.values())  # unique
        Job.last = JobResult(work.name, messages, bpy.data.filepath)
        for message in messages:
            self.report({message.level}, message.text)

    def _failed(self, work: Job, error: Exception, back: bool = False) -> set[str]:
        if isinstance(error, StoppedError):
            undo = "the scene is restored" if back else "undo restores the scene"
            kept = undo if work.touched else "finished work remains"
            self._tell(work, Message(f"{work.name}: stopped; {kept}", "WARNING"))
        else:
            self._tell(work, Message(describe_error(error), "ERROR"))
        if back:
            bpy.app.timers.register(undo_last, first_interval=0.0)  # after Blender has pushed this undo step
        return {"FINISHED"} if work.touched else {"CANCELLED"}  # an incomplete result can be undone then

    def _goes_back(self) -> bool:
        """Return whether an incomplete result can be undone, and has not been undone yet."""
        able = not bpy.app.background and bpy.context.preferences.edit.use_global_undo
        return able and self.job.touched and not self.job.undone and "UNDO" in self.bl_options

    def _end(self, context: bpy.types.Context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if Job.current is self.job:
            Job.current = None
            _watch_undo(False)
        _redraw_status(context, None)


def _redraw_status(context: bpy.types.Context, work: Job | None) -> None:
    """Redraw the sidebars and the status bar."""
    if context.workspace is not None:
        how = "Press Stop in the sidebar, or Esc over it, to end the task"
        context.workspace.status_text_set(f"{work.name}: {work.text}    {how}" if work else None)
    redraw()


def redraw() -> None:
    """Redraw the sidebars; the 3D views themselves may be slow."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def settings_column(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Return a column of settings, which are locked while a task runs."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    column = layout.column()
    column.enabled = Job.current is None
    return column


def draw_button(layout: bpy.types.UILayout, operator: type[bpy.types.Operator], icon: str) -> None:
    """Draw the button of a task; while it runs, its progress and a stop button instead."""
    if Job.current is not None and Job.current.name == operator.bl_label:
        layout.progress(factor=Job.current.factor, text=Job.current.text)
        layout.operator(FIRETWIN_OT_stop.bl_idname, text="", icon="CANCEL")
    else:
        layout.operator(operator.bl_idname, icon=icon)


def draw_messages(
    context: bpy.types.Context, layout: bpy.types.UILayout, operator: type[bpy.types.Operator]
) -> None:
    """Draw the messages of the operator's last task; while it runs, a hint on how to stop it."""
    column = layout.column(align=True)
    if Job.current is not None and Job.current.name == operator.bl_label:
        text.draw_paragraph(context, column, "Press Stop, or Esc with the pointer here, to end the task")
    elif Job.current is None:
        for message in last_messages(operator):
            text.draw_paragraph(context, column, keys.sentence(message.text), _ICONS[message.level])
        if wrong := [message.text for message in last_messages(operator) if message.level == "ERROR"]:
            draw_copy_button(column, "\n".join(wrong))


def draw_copy_button(layout: bpy.types.UILayout, message: str) -> None:
    """Draw a button that copies an error message with the details for a support request."""
    layout.operator(FIRETWIN_OT_copy.bl_idname, text="Copy details", icon="COPYDOWN").message = message


def last_messages(operator: type[bpy.types.Operator]) -> tuple[Message, ...]:
    """Return messages of the last task, if it was this operator's and in this file."""
    last = Job.last
    if last is None or last.name != operator.bl_label or last.file not in (None, bpy.data.filepath):
        return ()
    return last.messages


class FIRETWIN_OT_stop(bpy.types.Operator):
    """Stop the task, as Esc over this sidebar does. Finished work remains"""

    bl_idname = "firetwin.stop"
    bl_label = "Stop running task"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if Job.current is None:
            cls.poll_message_set("No task is running")
        return Job.current is not None

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        if Job.current is not None:
            Job.current.stop.now()
        return {"FINISHED"}


class FIRETWIN_OT_copy(bpy.types.Operator):
    """Copy the message with the versions of Firetwin, Blender and the system, for a support request"""

    bl_idname = "firetwin.copy"
    bl_label = "Copy details of last message"
    bl_options = {"INTERNAL"}

    message: bpy.props.StringProperty(options={"SKIP_SAVE"})

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        last = "" if Job.last is None else "\n".join(each.text for each in Job.last.messages)
        context.window_manager.clipboard = support_details(self.message or last)
        self.report({"INFO"}, "Copied the details")
        return {"FINISHED"}


def support_details(message: str) -> str:
    """Return a message with software versions, and the traceback of an unexpected error."""
    import platform

    import firetwin_core

    return "\n".join(
        (
            message,
            f"Firetwin {firetwin_core.__version__}, Blender {bpy.app.version_string}, "
            f"Python {platform.python_version()}, {platform.platform()}",
            *job.unexpected,
        )
    )


classes = (FIRETWIN_OT_stop, FIRETWIN_OT_copy)
