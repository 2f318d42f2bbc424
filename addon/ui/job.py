"""Long work in the window: it shows how far it is, lets people go on looking, and Esc stops it.

An operator's work is a generator. It yields a text before each step that has to be taken in Blender itself,
or `Away(...)`, a function for a thread (which most often waits for a worker process), and gets back what
that returned. In the background, and when called by a script, the same steps follow one another at once.
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any, ClassVar

import bpy

from ..errors import Error, UsageError
from ..progress import duration
from ..worker import Stop, StoppedError

_TICK = 0.1  # s


@dataclass(frozen=True)
class Away:
    """Work that needs no Blender data: ``function(progress=..., stop=...)``, called in a thread."""

    what: str
    function: Callable[..., Any]


Steps = Generator["str | Away", Any, str]
"""The steps of a work; it returns what to tell when it is done."""


class Job:
    """The work that goes on; there is at most one.

    Attributes
    ----------
    touched
        Whether a step in Blender has been taken, so that there is something to undo.
    """

    current: ClassVar[Job | None] = None

    def __init__(self, name: str, steps: Steps) -> None:
        self.name, self.steps = name, steps
        self.what, self.done, self.total = name, 0, 1
        self.stop, self.touched, self.told = Stop(), False, ""
        self._since = time.monotonic()
        self._thread: threading.Thread | None = None
        self._outcome: dict[str, Any] = {}
        self._shown = False

    def run(self) -> str:
        """Take all steps at once; what there is to tell."""
        while not self._step(wait=True):
            pass
        return self.told

    def advance(self) -> bool:
        """Take a step or see how far the thread is, without waiting; whether the work is over."""
        if self._thread is not None and self._thread.is_alive():
            return False
        if self._thread is None and not self._shown:
            self._shown = True  # so that the coming step is on the screen while it is taken
            return False
        self._shown = False
        return self._step(wait=False)

    def progress(self, done: int, total: int, what: str = "") -> None:
        """How far the thread is."""
        if what and what != self.what:
            self.what, self._since = what, time.monotonic()
        self.done, self.total = done, total

    @property
    def factor(self) -> float:
        """How much of the present step is done, 0 to 1."""
        return self.done / self.total if self.total > 0 else 0.0

    @property
    def text(self) -> str:
        """What is done, how far it is, and how long it will take."""
        words = self.what[:1].upper() + self.what[1:]
        if self.total <= 1:
            return words
        words += f" {self.done} of {self.total}"
        if not 0 < self.done < self.total:
            return words
        left = (time.monotonic() - self._since) / self.done * (self.total - self.done)
        return f"{words}, {duration(left)} left"

    def _step(self, wait: bool) -> bool:
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        outcome, self._outcome = self._outcome, {}
        if self.stop.asked:
            outcome.setdefault("error", StoppedError())
        try:
            if "error" in outcome:
                step = self.steps.throw(outcome["error"])
            else:
                step = self.steps.send(outcome.get("result"))
        except StopIteration as end:
            self.told = end.value or ""
            return True
        self.what, self.done, self.total, self._since = _label(step), 0, 1, time.monotonic()
        if isinstance(step, Away):
            self._send_away(step.function)
            if wait:
                self._thread.join()
        else:
            self.touched = True
        return False

    def _send_away(self, function: Callable[..., Any]) -> None:
        outcome: dict[str, Any] = {}

        def work() -> None:
            try:
                outcome["result"] = function(progress=self.progress, stop=self.stop)
            except BaseException as error:
                outcome["error"] = error

        self._outcome = outcome
        self._thread = threading.Thread(target=work, name="Firetwin", daemon=True)
        self._thread.start()


def _label(step: str | Away) -> str:
    return step.what if isinstance(step, Away) else step


def words(error: BaseException) -> str:
    """What to tell about an error: where it is and what to do, never a traceback."""
    if isinstance(error, UsageError):
        option, _, rest = str(error).partition(": ")
        return f"{option[2:].capitalize()}: {rest}" if option.startswith("--") else str(error)
    if isinstance(error, Error):
        return str(error)
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    traceback.print_exception(error)
    return f"Unexpected {type(error).__name__}: {error} (details are in the system console)"


def free(cls: type[bpy.types.Operator]) -> bool:
    """Whether no work goes on; says so where it does."""
    if Job.current is not None:
        cls.poll_message_set(f"{Job.current.name} is not finished; Esc stops it")
    return Job.current is None


def abandon() -> None:
    """End whatever goes on, without a word: its operator goes away."""
    if Job.current is not None:
        Job.current.stop.now()
        Job.current = None
        _show(bpy.context, None)


class Working:
    """An operator whose `steps(context)` are taken one by one while its window stays usable."""

    _timer: bpy.types.Timer | None = None

    def steps(self, context: bpy.types.Context) -> Steps:
        """The work."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        work = Job(self.bl_label, self.steps(context))
        try:
            self.report({"INFO"}, work.run())
        except Exception as error:
            return self._failed(work, error)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self.job = Job.current = Job(self.bl_label, self.steps(context))
        self._timer = context.window_manager.event_timer_add(_TICK, window=context.window)
        context.window_manager.modal_handler_add(self)
        _show(context, self.job)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if Job.current is not self.job:  # the add-on was switched off
            self._end(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            self.job.stop.now()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if not self.job.touched else {"RUNNING_MODAL"}
        try:
            over = self.job.advance()
        except Exception as error:
            self._end(context)
            return self._failed(self.job, error)
        if not over:
            _show(context, self.job)
            return {"RUNNING_MODAL"}
        self._end(context)
        self.report({"INFO"}, self.job.told)
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Another file is opened, or Blender ends."""
        self.job.stop.now()
        self._end(context)

    def _failed(self, work: Job, error: Exception) -> set[str]:
        if isinstance(error, StoppedError):
            undo = "; undo takes back what was made" if work.touched else "; what was finished is kept"
            self.report({"WARNING"}, f"{work.name} stopped{undo}")
        else:
            self.report({"ERROR"}, words(error))
        return {"FINISHED"} if work.touched else {"CANCELLED"}  # what is half made can then be undone

    def _end(self, context: bpy.types.Context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if Job.current is self.job:
            Job.current = None
        _show(context, None)


def _show(context: bpy.types.Context, work: Job | None) -> None:
    """Draw the sidebars and the status bar anew."""
    if context.workspace is not None:
        context.workspace.status_text_set(f"{work.name}: {work.text}    Esc stops" if work else None)
    redraw()


def redraw() -> None:
    """Draw the sidebars anew; the 3D views themselves may take long."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def button(layout: bpy.types.UILayout, operator: type[bpy.types.Operator], icon: str) -> None:
    """The button of a work; while it goes on, how far it is and a button to stop it, in the same place."""
    if Job.current is not None and Job.current.name == operator.bl_label:
        layout.progress(factor=Job.current.factor, text=Job.current.text)
        layout.operator(FIRETWIN_OT_stop.bl_idname, text="", icon="CANCEL")
    else:
        layout.operator(operator.bl_idname, icon=icon)


class FIRETWIN_OT_stop(bpy.types.Operator):
    """Stop what Firetwin is doing. What is finished is kept"""

    bl_idname = "firetwin.stop"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if Job.current is None:
            cls.poll_message_set("Nothing goes on")
        return Job.current is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        Job.current.stop.now()
        return {"FINISHED"}


classes = (FIRETWIN_OT_stop,)
