"""Verbs of `firetwin farm`."""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
from collections.abc import Callable
from pathlib import Path

from ..auto_framing import fitted_scene
from ..errors import Error, UsageError
from ..progress import Reporter, count, result, say
from ..shot.schema.frame_list import FrameList
from . import assemble, divided, plan, status, submission, task
from .submission import Submission

_MAX_TASK_NUMBER = 10**9 - 1  # far above any real number of tasks


def run(arguments: argparse.Namespace) -> int | None:
    """Run the requested verb; returns the exit status."""
    verbs: dict[str, Callable[[argparse.Namespace], int | None]] = {
        "plan": run_plan,
        "status": run_status,
        "resume": run_resume,
        "cancel": run_cancel,
        "task": run_task,
        "assemble": run_assemble,
    }
    return verbs[arguments.verb](arguments)


def run_plan(arguments: argparse.Namespace) -> None:
    """Plan a film or the work of another feature; print the command that submits it, or run that command."""
    out, size = arguments.out.absolute(), arguments.chunk or plan.CHUNK
    if feature := divided.find(arguments.scene):
        job = divided.make_job(feature, arguments.scene.absolute(), out, size)
    else:
        choice = fitted_scene.find_source(arguments)
        shot = choice.shot()
        job = plan.make_job(shot, Path(choice.scene).absolute(), size)
        say(shot.describe_film())
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
    result(json.dumps(found.as_json(), indent=1) if arguments.json else status.format_text(found))


def run_resume(arguments: argparse.Namespace) -> None:
    """Submit the tasks of missing pictures with the previous scheduler and options."""
    out = arguments.out.absolute()
    missing, numbers = submission.find_missing(out, Reporter())
    before = submission.last_submission(out)
    say(f"{count(len(missing), 'picture')} missing: {count(len(numbers), 'task')} to submit")
    options = tuple(arguments.options) or before.options
    _submit(submission.prepare(out, Submission(before.engine, options), numbers))


def run_cancel(arguments: argparse.Namespace) -> int:
    """Cancel the submitted tasks."""
    return _call(submission.cancel_command(arguments.out.absolute()))


def run_task(arguments: argparse.Namespace) -> int:
    """Run tasks; the exit status shows whether a retry is worthwhile."""

    def work() -> None:
        try:
            numbers = FrameList(arguments.numbers).frames(_MAX_TASK_NUMBER)
        except ValueError as error:
            raise UsageError(f"tasks: {error}") from None
        task.run(arguments.out.absolute(), numbers, _scene(arguments))

    return _status(arguments, work)


def run_assemble(arguments: argparse.Namespace) -> int:
    """Enter all pictures and make the films; list missing pictures."""
    out, missing = arguments.out.absolute(), {}
    status = _status(arguments, lambda: missing.update(assemble.run(out, _scene(arguments), Reporter(), say)))
    for line in assemble.format_missing(missing):
        result(line)
    if missing:
        say(f"{count(len(missing), 'picture')} missing; run: firetwin farm resume {shlex.quote(str(out))}")
    return status or (1 if missing else 0)


def _status(arguments: argparse.Namespace, work: Callable[[], None]) -> int:
    """Run the work of a scheduler's command; returns the exit status for the scheduler."""
    try:
        work()
    except (Error, UsageError, OSError) as error:
        if arguments.debug:
            raise
        say(" ".join(str(error).split()))
        return task.exit_status(error)
    return 0


def _scene(arguments: argparse.Namespace) -> str:
    return str(arguments.scene) if arguments.scene else ""


def _submit(command: list[str]) -> None:
    """Run the submit command."""
    if status := _call(command):
        raise Error(f"{shlex.join(command)} ended with exit status {status}")


def _call(command: list[str]) -> int:
    """Run a scheduler's command and show its output; returns its exit status."""
    try:
        return subprocess.run(command).returncode
    except FileNotFoundError:
        raise submission.not_installed_error(command) from None
