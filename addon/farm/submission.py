"""Submission of a job, or of the tasks of missing pictures, to a scheduler; for command line and panel."""

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
from ..errors import Error, UsageError, input_error
from ..jobs.worker import Stop, StoppedError
from ..progress import MessageCallback, Progress, count, no_message, silent
from ..render.picture import Picture
from . import assemble, assets, divided, plan, status, task
from .engines import Batch, known
from .plan import Job

_FILE, _LOG = "submitted.json", "submitted.log"
_TICK, _LOOK = 0.2, 5.0  # s between polls of the scheduler's command, and of the job's files


@dataclass(frozen=True)
class Submission:
    """Scheduler of a job, with the user's options for it."""

    engine: str
    options: tuple[str, ...] = ()


def describe(job: Job, out: Path) -> Iterator[str]:
    """Describe a job: number of tasks and pictures, and files that need the same path on all machines."""
    pictures = sum(1 for each in job.tasks for _ in job.pictures(each))
    bakes, renders = (len(job.numbers(stage)) for stage in ("bake", "render"))
    tasks = f"{count(bakes, 'bake task')}, {count(renders, 'render task')}"
    yield f"{tasks}, {count(pictures, 'picture')} in {out}"
    away = assets.outside_of([Path(each) for each in job.assets], Path(job.scene).parent)
    if away:
        files = count(len(away), "file")
        yield f"{files} outside the scene's folder, such as {away[0]}; all machines need the same paths"


def prepare(out: Path, chosen: Submission, numbers: Iterable[int] | None = None) -> list[str]:
    """Write the scheduler's files for tasks (None: all tasks), and store scheduler and options.

    Returns
    -------
    The command that submits them.
    """
    job = plan.read(out)
    wanted = range(1, len(job.tasks) + 1) if numbers is None else sorted(numbers)
    command = known()[chosen.engine]().write(Batch(job, out, tuple(wanted), chosen.options))
    files.write_text(plan.job_dir(out) / _FILE, json.dumps(asdict(chosen)) + "\n")
    return command


def last_submission(out: Path) -> Submission:
    """Read scheduler and options of the last submission.

    Raises
    ------
    InputError
        The file is missing or damaged.
    """
    path = plan.job_dir(out) / _FILE
    try:
        found = files.read_json(path)
        chosen = Submission(found["engine"], tuple(found["options"]))
        if chosen.engine in known() and all(isinstance(each, str) for each in chosen.options):
            return chosen
    except (OSError, ValueError, TypeError, LookupError):
        pass
    raise input_error(path, "is not the submission of a job; plan the job again")


def find_missing(out: Path, progress: Progress = silent) -> tuple[dict[Picture, str], list[int]]:
    """Find missing and damaged pictures, each with the reason, and the numbers of their tasks."""
    job = plan.read(out)
    if job.feature:
        missing = divided.missing(job, out)
        return missing, assemble.tasks_of_pictures(job, missing)
    shot = task.job_source(job, out).shot()
    _, missing = assemble.check_pictures(job, out, assemble.fingerprints(job, shot, progress))
    solved = {*status.gather(out).done}
    renders = assemble.tasks_of_pictures(job, missing)
    bakes = [number for number in job.numbers("bake") if renders and number not in solved]
    return missing, [*bakes, *renders]


def cancel_command(out: Path) -> list[str]:
    """Return the command that cancels the submitted tasks.

    Raises
    ------
    InputError
        The folder has no job.
    UsageError
        The scheduler has no such command; the message explains how to cancel.
    """
    plan.read(out)
    return known()[last_submission(out).engine]().cancel(out)


def not_installed_error(command: list[str]) -> UsageError:
    """Create the error for a scheduler whose command is not installed."""
    return UsageError(
        f"{command[0]} is not installed here; on a machine that has it, run: {shlex.join(command)}"
    )


def run_command(
    command: list[str],
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: Stop | None = None,
) -> None:
    """Run a scheduler's command from the panel until it ends, with its output in a file of the job.

    `tell` receives the last line of the output. If the scheduler runs the tasks within this command,
    `progress` follows the files of the job.

    Raises
    ------
    StoppedError
        `stop` was requested: the command received SIGTERM and has ended.
    Error
        The command failed; the message has the last line of its output.
    """
    log = plan.job_dir(out) / _LOG
    with log.open("w+", encoding="utf-8", errors="replace") as written:
        try:
            child = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=written, stderr=subprocess.STDOUT
            )
        except FileNotFoundError:
            raise not_installed_error(command) from None
        asked = _wait(child, out, progress, stop)
    lines = [line for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    if asked:
        raise StoppedError
    if child.returncode:
        words = f": {lines[-1].strip()}" if lines else ""
        raise Error(
            f"{shlex.join(command)} ended with exit status {child.returncode}{words} (full output: {log})"
        )
    if lines:
        tell(lines[-1].strip())


def _wait(child: subprocess.Popen[bytes], out: Path, progress: Progress, stop: Stop | None) -> bool:
    """Wait for a scheduler's command; returns whether it received SIGTERM."""
    asked, looked = False, time.monotonic()
    while child.poll() is None:
        if stop is not None and stop.asked and not asked:
            child.terminate()
            asked = True
        if time.monotonic() - looked > _LOOK:
            looked = time.monotonic()
            with contextlib.suppress(Error, OSError):  # a shared folder may be unreachable for a while
                found = status.gather(out)
                progress(found.finished, found.pictures, "rendering")
        time.sleep(_TICK)
    return asked
