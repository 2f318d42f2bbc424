"""What each verb of `firetwin farm` does."""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path

from ..errors import Error, UsageError
from ..progress import Reporter, count, result, say
from ..shot.schema import frame_list
from ..shot.source import ShotSource
from . import assemble, plan, status, submission, task
from .submission import Submission

_MAX_TASK_NUMBER = 10**9 - 1  # tasks, far more than there are


def run(arguments: argparse.Namespace, choice: Callable[[argparse.Namespace], ShotSource]) -> int | None:
    """Do it; the exit status.

    Parameters
    ----------
    choice
        Gives the scene of a command line.
    """
    if arguments.verb == "plan":
        run_plan(arguments, choice(arguments))
        return 0
    verbs: dict[str, Callable[[argparse.Namespace], int | None]] = {
        "status": run_status,
        "resume": run_resume,
        "cancel": run_cancel,
        "task": run_task,
        "assemble": run_assemble,
    }
    return verbs[arguments.verb](arguments)


def run_plan(arguments: argparse.Namespace, choice: ShotSource) -> None:
    """Plan a film; print the command that submits it, or submit it."""
    scene, out = Path(choice.scene).absolute(), arguments.out.absolute()
    job = plan.make(choice.shot(), scene, arguments.chunk or plan.CHUNK)
    plan.write(job, out)
    for line in submission.describe(job, out):
        say(line)
    command = submission.prepare(out, Submission(arguments.engine, tuple(arguments.options)))
    if arguments.submit:
        _submit(command)
    else:
        result(shlex.join(command))


def run_status(arguments: argparse.Namespace) -> None:
    """Print the progress of a job."""
    found = status.gather(arguments.out)
    result(json.dumps(found.plain(), indent=1) if arguments.json else status.page(found))


def run_resume(arguments: argparse.Namespace) -> None:
    """Submit the tasks of missing pictures, by the engine and with the options of before."""
    out = arguments.out.absolute()
    lost, numbers = submission.missing(out, Reporter())
    before = submission.last(out)
    say(f"{count(len(lost), 'picture')} missing: {count(len(numbers), 'task')} to submit")
    options = tuple(arguments.options) or before.options
    _submit(submission.prepare(out, Submission(before.engine, options), numbers))


def run_cancel(arguments: argparse.Namespace) -> int:
    """Cancel what was submitted."""
    return _call(submission.cancellation(arguments.out.absolute()))


def run_task(arguments: argparse.Namespace) -> int:
    """Run tasks; the exit status says whether to try again."""

    def work() -> None:
        try:
            numbers = frame_list.parse(arguments.numbers, _MAX_TASK_NUMBER)
        except ValueError as error:
            raise UsageError(f"tasks: {error}") from None
        task.run(arguments.out.absolute(), numbers, _scene(arguments))

    return _status(arguments, work)


def run_assemble(arguments: argparse.Namespace) -> int:
    """Enter all pictures and make the films; name what is missing."""
    out, lost = arguments.out.absolute(), {}
    status = _status(arguments, lambda: lost.update(assemble.run(out, _scene(arguments), Reporter(), say)))
    for line in assemble.described(lost):
        result(line)
    if lost:
        say(f"{count(len(lost), 'picture')} missing; firetwin farm resume {shlex.quote(str(out))} makes them")
    return status or (1 if lost else 0)


def _status(arguments: argparse.Namespace, work: Callable[[], None]) -> int:
    """Do what an engine runs; the exit status that tells the engine what to do next."""
    try:
        work()
    except (Error, UsageError, OSError) as error:
        if arguments.debug:
            raise
        say(" ".join(str(error).split()))
        return task.status_of(error)
    return 0


def _scene(arguments: argparse.Namespace) -> str:
    return str(arguments.scene) if arguments.scene else ""


def _submit(command: list[str]) -> None:
    """Run the command that submits."""
    if status := _call(command):
        raise Error(f"{shlex.join(command)} ended with exit status {status}")


def _call(command: list[str]) -> int:
    """Run an engine's own command; what it prints is shown."""
    try:
        return subprocess.run(command).returncode
    except FileNotFoundError:
        raise submission.absent(command) from None
