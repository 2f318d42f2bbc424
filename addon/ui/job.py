"""Task runner: long tasks as generators of steps.

A generator yields one of three values. A text precedes each step that runs in Blender's main thread.
`Message(...)` is a message for the user. `InThread(...)` is a function to run in a thread, which usually
waits for a worker process; its result is sent back.

At every yield the user may rename, delete or undo anything, so no data-block reference is retained across a
yield: `owned.scene` looks up the scene again.
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable, Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from ..errors import Error, InputError, UsageError
from ..escaped import message
from ..jobs.worker import Stop, StoppedError
from ..progress import duration
from . import keys, scene_file

_UNDONE = "undo was used during the build, so the scene is incomplete; build it again"


@dataclass(frozen=True)
class InThread:
    """A call without Blender data: ``function(progress=..., tell=..., stop=...)``, run in a thread."""

    label: str
    function: Callable[..., Any]


@dataclass(frozen=True)
class Message:
    """A message for the user: "INFO", "WARNING" or "ERROR"."""

    text: str
    level: str = "INFO"

    def __post_init__(self) -> None:
        object.__setattr__(self, "text", message(self.text))


Steps = Generator["str | InThread | Message", Any, str]
"""Steps of a task; it returns its final message."""


@dataclass(frozen=True)
class JobResult:
    """Messages of the last finished task, and the file that was open then (None: any file)."""

    name: str
    messages: tuple[Message, ...]
    file: str | None


class Job:
    """The running task; there is at most one.

    Attributes
    ----------
    last
        Messages of the previous task.
    touched
        True once a step in Blender has run, so that there are changes to undo.
    undone
        True if undo or redo was used after that.
    messages
        Messages so far.
    """

    current: ClassVar[Job | None] = None
    last: ClassVar[JobResult | None] = None

    def __init__(self, name: str, steps: Steps) -> None:
        self.name, self.steps = name, steps
        self.what, self.done, self.total = name, 0, 1
        self.stop, self.touched, self.undone = Stop(), False, False
        self.messages: list[Message] = []
        self.result = ""
        self._since = time.monotonic()
        self._thread: threading.Thread | None = None
        self._outcome: dict[str, Any] = {}
        self._shown = False

    def run(self) -> str:
        """Run all steps at once and return the final message."""
        while not self._step(wait=True):
            pass
        return self.result

    def advance(self) -> bool:
        """Run a step or poll the thread, without blocking; return whether the task has finished."""
        if self._thread is not None and self._thread.is_alive():
            return False
        if self._thread is None and not self._shown:
            self._shown = True  # so that the next step is displayed while it runs
            return False
        self._shown = False
        return self._step(wait=False)

    def progress(self, done: int, total: int, what: str = "", note: str = "") -> None:
        """Update the progress (callback of the thread)."""
        if what and what != self.what:
            self.what, self._since = what, time.monotonic()
        self.done, self.total = done, total

    def tell(self, text: str) -> None:
        """Add a message (callback of the thread)."""
        self.messages.append(Message(text))

    @property
    def factor(self) -> float:
        """Completed fraction of the current step, 0 to 1."""
        return self.done / self.total if self.total > 0 else 0.0

    @property
    def text(self) -> str:
        """Status text: step, progress and remaining time."""
        text = self.what[:1].upper() + self.what[1:]
        if self.total <= 1:
            return text
        text += f" {self.done} of {self.total}"
        if not 0 < self.done < self.total:
            return text
        left = (time.monotonic() - self._since) / self.done * (self.total - self.done)
        return f"{text}, {duration(left)} left"

    def _step(self, wait: bool) -> bool:
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        outcome, self._outcome = self._outcome, {}
        if self.undone:
            outcome["error"] = Error(_UNDONE)
        if self.stop.asked:
            outcome.setdefault("error", StoppedError())
        try:
            step = self._next(outcome)
        except StopIteration as end:
            self.result = end.value or ""
            return True
        self.what, self.done, self.total, self._since = _step_label(step), 0, 1, time.monotonic()
        if isinstance(step, InThread):
            thread = self._send_away(step.function)
            if wait:
                thread.join()
        else:
            self.touched = True
        return False

    def _next(self, outcome: dict[str, Any]) -> str | InThread:
        if "error" in outcome:
            step = self.steps.throw(outcome["error"])
        else:
            step = self.steps.send(outcome.get("result"))
        while isinstance(step, Message):
            self.messages.append(step)
            step = next(self.steps)
        return step

    def _send_away(self, function: Callable[..., Any]) -> threading.Thread:
        outcome: dict[str, Any] = {}

        def work() -> None:
            try:
                outcome["result"] = function(progress=self.progress, tell=self.tell, stop=self.stop)
            except BaseException as error:
                outcome["error"] = error

        self._outcome = outcome
        self._thread = threading.Thread(target=work, name="Firetwin", daemon=True)
        self._thread.start()
        return self._thread


def _step_label(step: str | InThread) -> str:
    return step.label if isinstance(step, InThread) else step


unexpected: list[str] = []
"""Traceback of the last unexpected error."""


def describe_error(error: BaseException) -> str:
    """Return a one-line message for an error: location and remedy, without a traceback."""
    return message(_error_text(error))


def _error_text(error: BaseException) -> str:
    if isinstance(error, UsageError):
        option, _, rest = str(error).partition(": ")
        return f"{option[2:].capitalize()}: {rest}" if option.startswith("--") else str(error)
    if isinstance(error, InputError) and Path(error.path).parent == scene_file.temporary_folder():
        return keys.sentence(error.reason)  # the user does not know this temporary file
    if isinstance(error, Error):
        return str(error).replace(", or add --overwrite", "").replace(" for --out", "")
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    unexpected[:] = traceback.format_exception(error)
    traceback.print_exception(error)
    return f"Unexpected {type(error).__name__}: {error} (Copy details has more)"
