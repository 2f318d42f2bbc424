"""Progress of a job, from its files alone: no engine is asked, and no picture is read."""

from __future__ import annotations

import time
from collections import defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..progress import count, duration
from . import entries, plan
from .entries import Attempt
from .plan import Job

PATIENCE = 10.0 * entries.SIGN  # s without a sign of life, after which an attempt counts as lost


@dataclass(frozen=True)
class Status:
    """Numbers of tasks and pictures.

    Attributes
    ----------
    done, running, failed, waiting
        Tasks: all of it is there; an attempt goes on; the last attempt failed or was lost; none began or the
        last ended well and its pictures have gone since.
    pictures, finished
        Pictures of the film, and those that are there.
    seconds_left
        At the mean time of a frame so far, for as many tasks at once as run now (none: one). None where no
        frame is finished yet.
    errors
        What failed tasks said, by number.
    """

    tasks: int
    done: list[int]
    running: list[int]
    failed: list[int]
    waiting: list[int]
    pictures: int
    finished: int
    seconds_left: float | None
    errors: dict[int, str]

    def plain(self) -> dict[str, Any]:
        """As JSON carries it."""
        return asdict(self)


def gather(out: Path, now: float | None = None) -> Status:
    """Look at the files of a job.

    Parameters
    ----------
    now
        s since 1970.
    """
    now = time.time() if now is None else now
    job = plan.read(out)
    tried = defaultdict(list)
    for each in entries.attempts(out):
        tried[each.number].append(each)
    frame_s = _frame_seconds([each for found in tried.values() for each in found])
    there = _Folders(out)
    groups: dict[str, list[int]] = {"done": [], "running": [], "failed": [], "waiting": []}
    wanted = finished = frames_left = 0
    errors = {}
    for number in range(1, len(job.tasks) + 1):
        made, lacking, frames = _made(job, number, tried[number], there)
        wanted, finished, frames_left = wanted + made + lacking, finished + made, frames_left + frames
        state = _state(job, number, tried[number], lacking, now)
        groups[state].append(number)
        if state == "failed":
            last = tried[number][-1]
            errors[number] = last.said or f"no sign of it since, on {last.host}"
    left = None if frame_s is None else frame_s * frames_left / max(len(groups["running"]), 1)
    return Status(
        len(job.tasks), **groups, pictures=wanted, finished=finished, seconds_left=left, errors=errors
    )


def page(status: Status) -> str:
    """For people."""
    parts = [f"{len(getattr(status, name))} {name}" for name in ("done", "running", "failed", "waiting")]
    lines = [
        f"tasks     {', '.join(parts)}, of {status.tasks}",
        f"pictures  {status.finished:,} of {count(status.pictures, 'picture')}",
    ]
    if status.finished < status.pictures and status.seconds_left is not None:
        at_once = max(len(status.running), 1)
        lines.append(f"left      {duration(status.seconds_left)} with {count(at_once, 'task')} at once")
    lines += [f"task {number} failed: {said}" for number, said in status.errors.items()]
    return "\n".join(lines)


class _Folders:
    """Names of the files in folders of pictures, each listed once."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self._names: dict[str, set[str]] = {}

    def has(self, path: str) -> bool:
        folder, _, name = path.rpartition("/")
        if folder not in self._names:
            try:
                self._names[folder] = {each.name for each in (self.out / folder).iterdir()}
            except OSError:
                self._names[folder] = set()
        return name in self._names[folder]


def _made(job: Job, number: int, tried: list[Attempt], there: _Folders) -> tuple[int, int, int]:
    """Pictures of a task that are there and entered, those that are not, and the frames of those."""
    entered = {entry.path for each in tried for entry in each.entries}
    made, lacking = 0, []
    for picture in job.pictures(job.task(number)):
        if all(path in entered and there.has(path) for path in picture.files()):
            made += 1
        else:
            lacking.append(picture)
    return made, len(lacking), len({(each.camera.partition("@")[0], each.frame) for each in lacking})


def _state(job: Job, number: int, tried: list[Attempt], lacking: int, now: float) -> str:
    bake = job.task(number).stage == "bake"
    if bake and any(each.ended == 0 for each in tried):
        return "done"
    if not bake and not lacking:
        return "done"
    if not tried or tried[-1].ended == 0:
        return "waiting"
    return "running" if tried[-1].ended is None and now - tried[-1].last < PATIENCE else "failed"


def _frame_seconds(tried: list[Attempt]) -> float | None:
    """Mean seconds of a frame, with what its task took to start."""
    worked = [each for each in tried if each.frames]
    frames = sum(each.frames for each in worked)
    return sum(max(each.last - each.began, 0.0) for each in worked) / frames if frames else None
