"""Progress of a job, from its files alone: no engine is asked, and no picture is read."""

from __future__ import annotations

import os
import time
from collections import defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..progress import count, duration
from ..shot import passes
from . import entries, plan
from .entries import Attempt
from .plan import Job

PATIENCE = 10.0 * entries.HEARTBEAT  # s without a heartbeat, after which an attempt counts as lost


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
        At the mean time of a file so far, for as many tasks at once as run now (none: one). None where none
        is finished yet.
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
    file_s = _file_seconds([each for found in tried.values() for each in found])
    there = _Folders(out)
    groups: dict[str, list[int]] = {"done": [], "running": [], "failed": [], "waiting": []}
    wanted = finished = files_left = 0
    errors = {}
    for number in range(1, len(job.tasks) + 1):
        made, every, lacking = _made(job, number, tried[number], there)
        wanted, finished, files_left = wanted + every, finished + made, files_left + lacking
        state = _state(job, number, tried[number], lacking, now)
        groups[state].append(number)
        if state == "failed":
            last = tried[number][-1]
            errors[number] = last.said or f"no heartbeat any more, on {last.host}"
    left = None if file_s is None else file_s * files_left / max(len(groups["running"]), 1)
    return Status(
        len(job.tasks), **groups, pictures=wanted, finished=finished, seconds_left=left, errors=errors
    )


def rows(status: Status) -> list[tuple[str, str]]:
    """Labels, and what stands beside them."""
    parts = [f"{len(getattr(status, name))} {name}" for name in ("done", "running", "failed", "waiting")]
    found = [
        ("tasks", f"{', '.join(parts)}, of {status.tasks}"),
        ("pictures", f"{status.finished:,} of {count(status.pictures, 'picture')}"),
    ]
    if status.finished < status.pictures and status.seconds_left is not None:
        at_once = max(len(status.running), 1)
        found.append(("left", f"{duration(status.seconds_left)} with {count(at_once, 'task')} at once"))
    return found


def failures(status: Status) -> list[str]:
    """A sentence for each failed task."""
    return [f"task {number} failed: {said}" for number, said in status.errors.items()]


def page(status: Status) -> str:
    """For people."""
    return "\n".join([*(f"{label:<10}{text}" for label, text in rows(status)), *failures(status)])


class _Folders:
    """Paths of the files in folders of pictures, each folder listed once."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self._paths: dict[str, set[str]] = {}

    def paths(self, folder: str) -> set[str]:
        """Paths of its files, relative to the output folder."""
        if folder not in self._paths:
            try:
                self._paths[folder] = set(map(f"{folder}/".__add__, os.listdir(self.out / folder)))
            except OSError:
                self._paths[folder] = set()
        return self._paths[folder]


def _made(job: Job, number: int, tried: list[Attempt], there: _Folders) -> tuple[int, int, int]:
    """Pictures of a task that are there and entered, all that it has, and the files of those that lack."""
    task, entered = job.task(number), set[str]().union(*(each.paths for each in tried))
    made = every = lacking = 0
    if task.stage != "render":
        return 0, 0, 0
    for camera in task.cameras:
        listed = job.frames(task, camera)
        for view in job.views(camera):
            for name in job.passes[view]:
                files = _files(view, name, listed)
                known = there.paths(files[0][0].rpartition("/")[0]) if listed else set()
                if all(entered.issuperset(each) and known.issuperset(each) for each in files):
                    found = len(listed)
                else:
                    both = entered & known
                    found = sum(both.issuperset(picture) for picture in zip(*files, strict=True))
                made, every = made + found, every + len(listed)
                lacking += (len(listed) - found) * len(files)
    return made, every, lacking


def _files(view: str, name: str, listed: list[int]) -> list[list[str]]:
    """Paths of a view's frames in a pass, a list for each kind of file."""
    found = []
    for end in passes.known()[name].files:
        head, _, tail = passes.file_of(view, name, 0, end).rpartition("000000")
        found.append([f"{head}{frame:06d}{tail}" for frame in listed])
    return found


def _state(job: Job, number: int, tried: list[Attempt], lacking: int, now: float) -> str:
    bake = job.task(number).stage == "bake"
    if bake and any(each.ended == 0 for each in tried):
        return "done"
    if not bake and not lacking:
        return "done"
    if not tried or tried[-1].ended == 0:
        return "waiting"
    return "running" if tried[-1].ended is None and now - tried[-1].last < PATIENCE else "failed"


def _file_seconds(tried: list[Attempt]) -> float | None:
    """Mean seconds of a file, with what its task took to start."""
    worked = [each for each in tried if each.paths]
    files = sum(len(each.paths) for each in worked)
    return sum(max(each.last - each.began, 0.0) for each in worked) / files if files else None
