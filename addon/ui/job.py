"""Long work in steps.

The work is a generator. It yields a text before each step that has to be taken in Blender itself;
`Message(...)`, a sentence for people; or `InThread(...)`, a function for a thread, which most often waits for
a worker process, and gets back what that returned.

At every yield people may rename, delete or undo anything, so no data-block is held across one: `owned.scene`
finds the scene again.
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
    """Work that needs no Blender data: ``function(progress=..., tell=..., stop=...)``, called in a thread."""

    what: str
    function: Callable[..., Any]


@dataclass(frozen=True)
class Message:
    """A sentence for people: "INFO", "WARNING" or "ERROR"."""

    text: str
    level: str = "INFO"

    def __post_init__(self) -> None:
        object.__setattr__(self, "text", message(self.text))


Steps = Generator["str | InThread | Message", Any, str]
"""The steps of a work; it returns what to tell when it is done."""


@dataclass(frozen=True)
class JobResult:
    """What the last work that ended had to tell, and the file that was open then (None: whichever)."""

    name: str
    told: tuple[Message, ...]
    file: str | None


class Job:
    """The work that goes on; there is at most one.

    Attributes
    ----------
    last
        What the one before had to tell.
    touched
        Whether a step in Blender has been taken, so that there is something to undo.
    undone
        Whether undo or redo was used after that.
    said
        Sentences for people so far.
    """

    current: ClassVar[Job | None] = None
    last: ClassVar[JobResult | None] = None

    def __init__(self, name: str, steps: Steps) -> None:
        self.name, self.steps = name, steps
        self.what, self.done, self.total = name, 0, 1
        self.stop, self.touched, self.undone = Stop(), False, False
        self.said: list[Message] = []
        self.told = ""
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

    def progress(self, done: int, total: int, what: str = "", note: str = "") -> None:
        """How far the thread is."""
        if what and what != self.what:
            self.what, self._since = what, time.monotonic()
        self.done, self.total = done, total

    def tell(self, text: str) -> None:
        """A sentence for people, from the thread."""
        self.said.append(Message(text))

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
        if self.undone:
            outcome["error"] = Error(_UNDONE)
        if self.stop.asked:
            outcome.setdefault("error", StoppedError())
        try:
            step = self._next(outcome)
        except StopIteration as end:
            self.told = end.value or ""
            return True
        self.what, self.done, self.total, self._since = _label(step), 0, 1, time.monotonic()
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
            self.said.append(step)
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


def _label(step: str | InThread) -> str:
    return step.what if isinstance(step, InThread) else step


unexpected: list[str] = []
"""The traceback of the last error that nobody foresaw."""


def describe_error(error: BaseException) -> str:
    """What to tell about an error in one line: where it is and what to do, never a traceback."""
    return message(_words(error))


def _words(error: BaseException) -> str:
    if isinstance(error, UsageError):
        option, _, rest = str(error).partition(": ")
        return f"{option[2:].capitalize()}: {rest}" if option.startswith("--") else str(error)
    if isinstance(error, InputError) and Path(error.path).parent == scene_file.folder():
        return keys.sentence(error.reason)  # nobody has seen this file
    if isinstance(error, Error):
        return str(error)
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    unexpected[:] = traceback.format_exception(error)
    traceback.print_exception(error)
    return f"Unexpected {type(error).__name__}: {error} (Copy details has more)"
