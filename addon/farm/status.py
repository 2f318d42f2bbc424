"""Progress of a job, read from its files: pictures are not opened.

It only asks schedulers about attempts without a recent heartbeat (`lost`).
"""

from __future__ import annotations

import os
import time
from collections import defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..progress import count, duration
from ..shot import passes
from ..shot.schema.frame_list import FrameList
from . import divided, entries, lost, plan
from .entries import Attempt
from .plan import Job

PATIENCE = 10.0 * entries.HEARTBEAT  # s without a heartbeat, after which an attempt counts as lost


@dataclass(frozen=True)
class Status:
    """Counts of tasks and pictures.

    Attributes
    ----------
    done, running, failed, waiting
        Numbers of tasks. Done: all its files exist. Running: an attempt has a recent heartbeat. Failed: the
        last attempt failed, was killed, or its heartbeat stopped. Waiting: not started, or finished but files
        are gone.
    pictures, finished
        Number of pictures of the film, and of existing ones.
    seconds_left
        Estimate from the mean time per file and the number of running tasks (at least one). None if no file
        is finished.
    errors
        Error messages of failed tasks by task number.
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

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data for JSON."""
        return asdict(self)


def gather(out: Path, now: float | None = None) -> Status:
    """Read the files of a job.

    Parameters
    ----------
    now
        Time, s since 1970 (now).
    """
    now = time.time() if now is None else now
    job = plan.read(out)
    tried = defaultdict(list)
    for each in entries.attempts(out):
        tried[each.number].append(each)
    file_s = _file_seconds([each for found in tried.values() for each in found])
    there = _FolderListings(out)
    groups: dict[str, list[int]] = {"done": [], "running": [], "failed": [], "waiting": []}
    wanted = finished = files_left = 0
    errors, gone = {}, lost.Lost(now)
    for number in range(1, len(job.tasks) + 1):
        made, every, lacking = _made(job, number, tried[number], there)
        wanted, finished, files_left = wanted + every, finished + made, files_left + lacking
        state = _state(job, number, tried[number], lacking, now)
        why = gone.reason(tried[number][-1]) if state == "running" else ""
        state = "failed" if why else state
        groups[state].append(number)
        if state == "failed":
            last = tried[number][-1]
            errors[number] = last.message or why or f"heartbeat stopped on {last.host}"
    left = None if file_s is None else file_s * files_left / max(len(groups["running"]), 1)
    return Status(
        len(job.tasks), **groups, pictures=wanted, finished=finished, seconds_left=left, errors=errors
    )


def rows(status: Status) -> list[tuple[str, str]]:
    """List the rows of the summary: label and text."""
    parts = [f"{len(getattr(status, name))} {name}" for name in ("done", "running", "failed", "waiting")]
    lines = [
        ("tasks", f"{', '.join(parts)}, of {status.tasks}"),
        ("pictures", f"{status.finished:,} of {count(status.pictures, 'picture')}"),
    ]
    if status.finished < status.pictures and status.seconds_left is not None:
        at_once = max(len(status.running), 1)
        lines.append(("left", f"{duration(status.seconds_left)} with {count(at_once, 'task')} at once"))
    return lines


def failures(status: Status) -> list[str]:
    """Describe each failed task in a sentence."""
    return [f"task {number} failed: {message}" for number, message in status.errors.items()]


def format_text(status: Status) -> str:
    """Format the summary as text."""
    return "\n".join([*(f"{label:<10}{text}" for label, text in rows(status)), *failures(status)])


class _FolderListings:
    """Paths of the files in folders of pictures; each folder is read once."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self._paths: dict[str, set[str]] = {}

    def paths(self, folder: str) -> set[str]:
        """List the files of a folder, relative to the output folder."""
        if folder not in self._paths:
            try:
                self._paths[folder] = set(map(f"{folder}/".__add__, os.listdir(self.out / folder)))
            except OSError:
                self._paths[folder] = set()
        return self._paths[folder]


def _made(job: Job, number: int, tried: list[Attempt], there: _FolderListings) -> tuple[int, int, int]:
    """Count the finished pictures of a task, all its pictures, and the files of missing pictures."""
    task, entered = job.task(number), set[str]().union(*(each.paths for each in tried))
    finished_files = every = lacking = 0
    if task.stage != "render":
        return 0, 0, 0
    if job.feature:
        asked = FrameList(task.frames).frames(job.count)
        lacking = len(divided.work(job).missing(there.out, asked))
        return len(asked) - lacking, len(asked), lacking
    for camera in task.cameras:
        listed = job.frames(task, camera)
        for view in job.views(camera):
            for name in job.passes[view]:
                files = _files(view, name, listed)
                known = there.paths(files[0][0].rpartition("/")[0]) if listed else set()
                if all(entered.issuperset(each) and known.issuperset(each) for each in files):
                    finished = len(listed)
                else:
                    both = entered & known
                    finished = sum(both.issuperset(picture) for picture in zip(*files, strict=True))
                finished_files, every = finished_files + finished, every + len(listed)
                lacking += (len(listed) - finished) * len(files)
    return finished_files, every, lacking


def _files(view: str, name: str, listed: list[int]) -> list[list[str]]:
    """List the paths of the frames of a view in a pass: one list per file type."""
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
    """Compute the mean time per file, s, including the start-up of tasks."""
    worked = [each for each in tried if each.paths]
    files = sum(len(each.paths) for each in worked)
    return sum(max(each.last - each.began, 0.0) for each in worked) / files if files else None
