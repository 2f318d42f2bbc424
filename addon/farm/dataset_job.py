"""Jobs that make a data set: tasks make samples, and the last stage writes formats and report.

The data set is in the folder `dataset` of the output folder. Tasks call `firetwin dataset` as a separate
process, so this package does not need the other one.
"""

from __future__ import annotations

import json
import subprocess
import tomllib
from collections.abc import Iterable
from pathlib import Path

from ..errors import Error, full_disk_error, is_nearly_full
from ..render import fingerprint
from ..render.picture import Picture
from ..run.content import sha256
from ..shot.schema.frame_list import FrameList
from .engines._engine import firetwin_command
from .plan import SAMPLE, Job, Task

FOLDER = "dataset"
_METADATA = "meta/{:06d}.json"  # of a complete sample; a test compares it with `dataset.truth`


def is_plan(path: Path) -> bool:
    """Return whether a file is the plan of a data set: its runs have places."""
    try:
        runs = tomllib.loads(path.read_text(encoding="utf-8-sig")).get("runs")
    except (OSError, ValueError):
        return False
    return isinstance(runs, list) and any(isinstance(run, dict) and "place" in run for run in runs)


def make_job(plan: Path, out: Path, size: int) -> Job:
    """Divide a data set into tasks of at most `size` samples, or of the samples of one scene.

    Raises
    ------
    Error
        The plan is invalid; the process has printed the reason.
    """
    estimate = json.loads(
        _call([str(plan), "--out", str(out / FOLDER), "--estimate", "--json"], capture=True)
    )
    tasks: list[list[int]] = []
    for listed in estimate["scenes"]:
        samples = FrameList(listed).frames(estimate["count"])
        if tasks and len(tasks[-1]) + len(samples) <= size:
            tasks[-1] += samples
        else:
            tasks.append(samples)
    return Job(
        scene=str(plan),
        scene_sha256=sha256(plan),
        versions=fingerprint.versions(),
        count=estimate["count"],
        camera_frames={},
        passes={},
        tasks=tuple(Task("render", (), FrameList.of(sorted(each))) for each in tasks),
        assets=(),
        samples=True,
    )


def make_samples(out: Path, samples: str, plan: str) -> None:
    """Make samples of a data set.

    Parameters
    ----------
    plan
        Path of the plan on this machine.

    Raises
    ------
    FullDiskError
        The disk is full.
    Error
        They could not be made; the process has printed the reason.
    """
    _call([plan, "--out", str(out / FOLDER), "--only", samples])


def finish(out: Path, plan: str) -> None:
    """Write formats and report of a complete data set.

    Raises
    ------
    Error
        A file cannot be written; the process has printed the reason.
    """
    _call([plan, "--out", str(out / FOLDER)])


def missing(out: Path, samples: Iterable[int]) -> list[int]:
    """List the samples that are not finished."""
    return [index for index in samples if not (out / FOLDER / _METADATA.format(index)).is_file()]


def missing_pictures(job: Job, out: Path) -> dict[Picture, str]:
    """Find the samples that are not finished, as pictures with the reason."""
    lacking = missing(out, range(1, job.count + 1))
    return {Picture(SAMPLE, index, "labels"): "not rendered" for index in lacking}


def _call(arguments: list[str], capture: bool = False) -> str:
    """Call `firetwin dataset`; returns its output if it is captured. The process ends with this one."""
    child = subprocess.Popen(
        [*firetwin_command(), "dataset", *arguments], stdout=subprocess.PIPE if capture else None, text=True
    )
    try:
        text, _ = child.communicate()
    finally:
        if child.poll() is None:
            child.terminate()
            child.wait()
    if child.returncode:
        folder = Path(arguments[2])
        if is_nearly_full(folder):
            raise full_disk_error(folder)
        raise Error(f"firetwin dataset ended with exit status {child.returncode}")
    return text or ""
