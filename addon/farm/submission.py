"""What is handed to an engine: a whole job, or the tasks of what is missing; for command line and window."""

from __future__ import annotations

import contextlib
import json
import shlex
import subprocess
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from .. import files
from ..errors import Error, UsageError
from ..jobs.worker import Stop, StoppedError
from ..progress import MessageCallback, Progress, count, no_message, silent
from ..render.picture import Picture
from . import assemble, assets, plan, status, task
from .engines import Batch, known
from .plan import Job

_FILE, _LOG = "submitted.json", "submitted.log"
_TICK, _LOOK = 0.2, 5.0  # s between two looks at the engine's command, and at the job's files


@dataclass(frozen=True)
class Submission:
    """The engine of a job, and its own options as the user wrote them."""

    engine: str
    options: tuple[str, ...] = ()


def describe(job: Job, out: Path) -> Iterator[str]:
    """Sentences on a job: what it makes, and the files that must be found under the same path elsewhere."""
    pictures = sum(1 for each in job.tasks for _ in job.pictures(each))
    bakes, renders = (len(job.numbers(stage)) for stage in ("bake", "render"))
    tasks = f"{count(bakes, 'bake task')}, {count(renders, 'render task')}"
    yield f"{tasks}, {count(pictures, 'picture')} in {out}"
    away = assets.elsewhere([Path(each) for each in job.assets], Path(job.scene).parent)
    if away:
        files = count(len(away), "file")
        yield f"{files} outside of the scene's folder, such as {away[0]}: keep these paths"


def prepare(out: Path, chosen: Submission, numbers: Iterable[int] | None = None) -> list[str]:
    """Write the engine's text of tasks (None: of all), and remember engine and options.

    Returns
    -------
    The command that submits it.
    """
    job = plan.read(out)
    wanted = range(1, len(job.tasks) + 1) if numbers is None else sorted(numbers)
    command = known()[chosen.engine]().write(Batch(job, out, tuple(wanted), chosen.options))
    files.write_text(plan.place(out) / _FILE, json.dumps(asdict(chosen)) + "\n")
    return command


def last(out: Path) -> Submission:
    """Engine and options of the last time."""
    found = json.loads((plan.place(out) / _FILE).read_text(encoding="utf-8"))
    return Submission(found["engine"], tuple(found["options"]))


def missing(out: Path, progress: Progress = silent) -> tuple[dict[Picture, str], list[int]]:
    """Pictures that are missing or damaged, each with the reason, and the numbers of tasks that make them."""
    job = plan.read(out)
    shot = task.source(job, out).shot()
    _, lost = assemble.check(job, out, assemble.fingerprints(job, shot, progress))
    solved = {*status.gather(out).done}
    renders = assemble.tasks_of(job, lost)
    bakes = [number for number in job.numbers("bake") if renders and number not in solved]
    return lost, [*bakes, *renders]


def cancellation(out: Path) -> list[str]:
    """The command that cancels what was submitted.

    Raises
    ------
    InputError
        There is no job.
    UsageError
        The engine is told otherwise to do so; says how.
    """
    plan.read(out)
    return known()[last(out).engine]().cancel(out)


def absent(command: list[str]) -> UsageError:
    """The error where an engine's command is not installed."""
    return UsageError(f"{command[0]} is not installed here; on a machine that has it: {shlex.join(command)}")


def call(
    command: list[str],
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: Stop | None = None,
) -> None:
    """Run an engine's own command to its end from the window; what it prints goes into a file of the job.

    `tell` gets its last line. An engine that runs the tasks itself is followed by the files of the job.

    Raises
    ------
    StoppedError
        `stop` was used: the command was told to end by SIGTERM, and has ended.
    Error
        It failed; has its last line.
    """
    log = plan.place(out) / _LOG
    with log.open("w+", encoding="utf-8", errors="replace") as written:
        try:
            child = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=written, stderr=subprocess.STDOUT
            )
        except FileNotFoundError:
            raise absent(command) from None
        asked = _wait(child, out, progress, stop)
    said = [line for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    if asked:
        raise StoppedError
    if child.returncode:
        words = f": {said[-1].strip()}" if said else ""
        raise Error(
            f"{shlex.join(command)} ended with exit status {child.returncode}{words} (all of it is in {log})"
        )
    if said:
        tell(said[-1].strip())


def _wait(child: subprocess.Popen[bytes], out: Path, progress: Progress, stop: Stop | None) -> bool:
    """Wait for an engine's command; whether it was told to end."""
    asked, looked = False, time.monotonic()
    while child.poll() is None:
        if stop is not None and stop.asked and not asked:
            child.terminate()
            asked = True
        if time.monotonic() - looked > _LOOK:
            looked = time.monotonic()
            with contextlib.suppress(Error, OSError):  # files of a shared folder may be away for a time
                found = status.gather(out)
                progress(found.finished, found.pictures, "rendering")
        time.sleep(_TICK)
    return asked
