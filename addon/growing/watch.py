"""Watch job: polls the files of a model that is still running, and converts each complete time."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import Error, UsageError
from ..jobs import worker
from ..progress import MessageCallback, Progress, no_message, silent
from . import model_log, stamps, states, status_page, watched
from .step import Outcome

_PATIENCE = 300.0  # s without progress in reading, after which a step is ended
_REST = 4.0  # pause after a step, times its duration: reading takes a fifth of the time at most

Wait = Callable[[float], None]


@dataclass(frozen=True)
class WatchRequest:
    """Request of a watch.

    Attributes
    ----------
    source
        File, folder or zarr store that the model writes.
    extra
        Further files, such as a mapping.
    out
        Folder to write.
    every
        Time between polls, s.
    end
        Model time at which the run has ended; None: the model's log says it.
    idle
        Time without a change of the files after which the run has ended, s; 0: never.
    start, at, projection, name, zone
        As the options of `convert`.
    overwrite
        Replace the files of others that `watched.refuse_others` refuses.
    """

    source: Path
    out: Path
    extra: tuple[Path, ...] = ()
    every: float = 5.0
    end: datetime | None = None
    idle: float = 0.0
    start: str = ""
    at: str = ""
    projection: str = ""
    name: str = ""
    zone: str = ""
    overwrite: bool = False


def run(
    request: WatchRequest, tell: MessageCallback = no_message, wait: Wait = time.sleep, polls: int = 0
) -> str:
    """Watch until the model has ended or failed, and return the state.

    Parameters
    ----------
    polls
        Number of polls; 0: until the end.

    Raises
    ------
    InputError, Error, UsageError
        The output folder is in use or cannot be written, or an option is invalid.
    """
    watch = Watch(request, tell)
    while True:
        pause = watch.poll()
        polls -= 1
        if watch.state in watched.FINAL or polls == 0:
            return watch.state
        wait(pause)


def _log_folder(source: Path) -> Path:
    """Return the folder of the model's log: the source, or the folder of a file or a zarr store."""
    is_store = any((source / name).exists() for name in ("zarr.json", ".zgroup"))
    return source if source.is_dir() and not is_store else source.parent


class Watch:
    """State of a watch between polls."""

    def __init__(self, request: WatchRequest, tell: MessageCallback) -> None:
        from ..run.models.model import Options
        from . import revision

        self.request, self.tell = request, tell
        options = request.start, request.at, request.projection
        Options.of(*options, 0.0, [], request.name, request.zone)
        out = request.out
        if request.every <= 0:
            raise UsageError("--every: must be more than 0 s")
        if out.resolve() == request.source.resolve():
            raise UsageError("--out: is the folder of the model; choose another")
        watched.refuse_others(out, request.overwrite)
        revision.remove_parts(out)
        self.seen: stamps.Stamps = {}
        self.done: Any = None
        self.outcome = Outcome()
        self.state, self.message = "", ""
        self.restarted = False
        self.changed = time.time()

    def poll(self) -> float:
        """Poll once, and return the time until the next poll, s."""
        request, now = self.request, time.time()
        seen = stamps.scan(request.source)
        stable = sorted(path for path, stamp in seen.items() if self.seen.get(path) == stamp)
        if seen != self.seen:
            self.changed = now
        self.seen = seen
        log = model_log.read(_log_folder(request.source))
        accepted = watched.times(request.out)
        generation = watched.last_generation(accepted) if accepted else []
        idle = bool(request.idle) and now - self.changed >= request.idle
        ended = log.succeeded or idle
        key = (seen, stable, log, ended)
        pause = request.every
        if seen and (key != self.done or self.outcome.more):
            begun = time.monotonic()
            self.done = key
            self._step(log, stable, ended)
            took = time.monotonic() - begun
            pause = 0.0 if self.outcome.more else max(pause, _REST * took)
            accepted = watched.times(request.out)
            generation = watched.last_generation(accepted) if accepted else []
        if request.end is not None and generation and generation[-1].moment >= request.end:
            ended = True
        ended = ended and not self.outcome.more
        self._report(generation, ended, log)
        return pause

    def _step(self, log: model_log.ModelLog, stable: list[str], ended: bool) -> None:
        """Read the files in a worker process, and report its outcome."""
        request = self.request
        work = partial(
            in_process,
            replace(
                request,
                source=request.source.absolute(),
                extra=tuple(each.absolute() for each in request.extra),
                out=request.out.absolute(),
            ),
            log.written,
            [str(Path(path).absolute()) for path in stable],
            ended,
            self.outcome.tried,
        )
        try:
            self.outcome = worker.run(work, blender=False, patience=_PATIENCE)
        except (Error, worker.EndedError) as error:
            self.outcome = Outcome(tried=self.outcome.tried, message=str(error))
            if self.message != str(error):
                self.tell(f"not readable yet: {error}")
            self.message = str(error)
            return
        self.message = ""
        if self.outcome.restarted:
            self.restarted = True
            self.message = f"the model started again: {self.outcome.restarted}"
            self.tell(f"{self.message}; the earlier run stays")
        elif self.outcome.new:
            self.restarted = False
        for each in self.outcome.new:
            guess = " (guessed complete)" if each.complete == "guessed" else ""
            self.tell(f"{each.moment:%Y-%m-%d %H:%M:%S} UTC from {each.source}{guess}")

    def _report(self, generation: list[watched.Accepted], ended: bool, log: model_log.ModelLog) -> None:
        """Choose the state, write it, and print changes."""
        request = self.request
        state = states.state(
            [each.clock for each in generation],
            time.time(),
            request.every,
            ended=ended,
            failed=bool(log.failure) and not log.succeeded and not self.outcome.more,
            restarted=self.restarted,
        )
        if state == "ended" and not generation:
            state = "failed"
            self.message = self.message or "the model ended without a complete time"
        if state == "failed" and log.failure:
            self.message = f"{model_log.NAME}: {log.failure}"
        status = status_page.create(
            state, self.message, request.source, generation, self.outcome.pending, request.every
        )
        status_page.write(request.out, status, generation)
        if state != self.state:
            self.tell(status_page.describe(status) + (f"; {self.message}" if state == "failed" else ""))
        self.state = state


def in_process(
    request: WatchRequest,
    logged: dict[str, int],
    stable: list[str],
    ended: bool,
    tried: dict[str, str],
    progress: Progress = silent,
    tell: MessageCallback = no_message,
) -> Outcome:
    """Worker side of a step."""
    from ..run.models.model import Options
    from . import step

    further = list(request.extra)
    options = Options.of(
        request.start, request.at, request.projection, 0.0, further, request.name, request.zone
    )
    return step.run(request.source, further, request.out, options, logged, stable, ended, tried)
