"""Tasks as schedulers run them: a task can run twice, and can be stopped and restarted."""

from __future__ import annotations

import functools
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import Error, InputError, UsageError, is_worth_another_try, writing
from ..jobs import render, solve, worker
from ..progress import Progress, say
from ..render import fingerprint
from ..run.content import sha256
from ..shot.schema.frame_list import FrameList
from ..shot.source import ShotSource
from . import divided, entries, plan
from .entries import Log
from .plan import Job, Task
from .private import PrivateFolder, verified_entries

EXIT_INPUT, EXIT_RETRY, EXIT_TERMINATED = 2, 75, 128 + signal.SIGTERM
"""Exit status: invalid input; retry (EX_TEMPFAIL: GPU or disk); ended by SIGTERM."""


def run(out: Path, numbers: list[int], scene: str = "") -> None:
    """Run tasks of a job, one after the other.

    Parameters
    ----------
    scene
        Path of the scene file on this machine; empty for the path at planning.

    Raises
    ------
    SystemExit
        143: the process received SIGTERM. Finished pictures are published.
    """
    with _terminable():
        job = plan.read(out)
        if wrong := [number for number in numbers if not 1 <= number <= len(job.tasks)]:
            raise UsageError(
                f"task {wrong[0]} does not exist; the job in {out} has tasks 1 to {len(job.tasks)}"
            )
        choice = job_source(job, out, scene)
        for done, number in enumerate(numbers):
            with entries.attempt(out, number) as log:
                progress = _openjd_progress(done, len(numbers))
                _logged(log, functools.partial(_task, job, choice, out, number, log, progress))


def job_source(job: Job, out: Path, scene: str = "") -> ShotSource:
    """Find the scene of a job, with the smoke cache of the job.

    Raises
    ------
    UsageError
        Firetwin or Blender has another version than at planning, or the scene file has changed.
    """
    here = fingerprint.versions()
    if here != job.versions:
        planned = _describe_versions(job.versions)
        raise UsageError(
            f"this is {_describe_versions(here)}, but the job needs {planned}; install those here"
        )
    path = Path(scene or job.scene)
    if path.is_file() and sha256(path) != job.scene_sha256:
        raise UsageError(f"{path} has changed since the job was planned; plan it again with another --out")
    return ShotSource(scene=str(path), cache=str(plan.job_dir(out.absolute()) / plan.CACHE))


def exit_status(error: BaseException) -> int:
    """Return the exit status for the exception that ended a task."""
    if isinstance(error, SystemExit):
        return int(error.code or 0)
    if is_worth_another_try(error):
        return EXIT_RETRY
    return EXIT_INPUT if isinstance(error, UsageError | InputError) else 1


def _describe_versions(versions: dict[str, str]) -> str:
    return f"Firetwin {versions['firetwin']} with Blender {versions['blender']}"


@contextmanager
def _terminable() -> Iterator[None]:
    """Turn SIGTERM into an exception, so that finished pictures are published and partial ones removed."""

    def end(*_: object) -> None:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # ignore repeated signals
        sys.exit(EXIT_TERMINATED)

    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _logged(log: Log, work: Callable[[], None]) -> None:
    try:
        work()
    except BaseException as error:
        log.end(exit_status(error), " ".join(str(error).split()))
        raise
    log.end(0)


def _task(job: Job, choice: ShotSource, out: Path, number: int, log: Log, progress: Progress) -> None:
    task = job.task(number)
    print(f"openjd_status: {task.stage} {' and '.join(task.cameras)}, frames {task.frames}", flush=True)
    if job.feature:
        divided.work(job).make(Path(choice.scene), out, task.frames)
    elif task.stage == "bake":
        _bake(job, choice, task, progress)
    else:
        _render(job, choice, out, number, log, progress)
    progress(1, 1)


def _bake(job: Job, choice: ShotSource, task: Task, progress: Progress) -> None:
    """Solve the flow of a view; an interrupted solution continues."""
    (view,) = task.cameras
    frames = FrameList(task.frames).frames(job.count)
    work = functools.partial(solve.in_process, choice, view, frames)
    try:
        worker.run(work, progress, tell=say, blender=False)
    except worker.EndedError as error:
        raise Error(f"the bake {error}; if memory ran out, choose larger voxels") from None


def _render(job: Job, choice: ShotSource, out: Path, number: int, log: Log, progress: Progress) -> None:
    """Render the missing pictures of a task in a private folder, and publish them."""
    task, shot = job.task(number), choice.shot()
    pictures = list(job.pictures(task))
    render.prepare_tiles(choice, pictures, render.RenderRequest(out, resume=True), tell=say)
    made_with = fingerprint.compute(shot, pictures)
    known = [entry for each in entries.attempts(out, number) for entry in each.entries]
    with writing("the temporary folder"):
        temporary = tempfile.TemporaryDirectory(prefix="firetwin-farm-", ignore_cleanup_errors=True)
    with temporary as place:
        private = PrivateFolder(Path(place), out, log)
        private.seed(verified_entries(known, out, made_with), made_with)

        def follow(done: int, total: int, what: str = "", note: str = "") -> None:
            if what == "rendering":
                private.publish()
                progress(done, total)

        def tell(text: str) -> None:
            say(text.replace(place, str(out)))

        asked = render.RenderRequest(Path(place), task.frames, task.cameras, resume=True, films=False)
        try:
            render.run(choice, asked, follow, tell, shot=shot)
        finally:
            private.publish()


def _openjd_progress(done: int, of: int) -> Progress:
    """Create a callback that prints the progress over several tasks in the form of Open Job Description."""
    last = ""

    def report(here: int, total: int, what: str = "", note: str = "") -> None:
        nonlocal last
        line = f"openjd_progress: {100.0 * (done + min(here / max(total, 1), 1.0)) / of:.1f}"
        if line != last:
            print(line, flush=True)
        last = line

    return report
