"""Stages and tasks of a job, and the pictures of each task. Runs without Blender."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .. import files, output
from ..errors import UsageError, input_error
from ..render import fingerprint
from ..render import plan as pictures
from ..render.picture import Picture
from ..run.content import sha256
from ..shot import comparison, frames
from ..shot.runs import scene_runs
from ..shot.schema.frame_list import FrameList
from ..shot.settings import Settings
from ..shot.shot import Shot
from ..shot.tiles import tile_terms
from ..smoke import sources
from . import assets

FOLDER, FILE, CACHE = "farm", "job.json", "cache"
CHUNK = 30
"""Maximum frames per task; `docs/how/farm.md` has the measured overhead of a task."""
_FORMAT = 1


@dataclass(frozen=True)
class Task:
    """One command that a scheduler runs.

    Attributes
    ----------
    stage
        "bake" or "render".
    cameras
        Cameras to render, with their views of all runs; for a bake, the one view whose flow is solved.
    frames
        List of frames; each camera renders those that it films.
    """

    stage: str
    cameras: tuple[str, ...]
    frames: str


@dataclass(frozen=True)
class Job:
    """Film divided into tasks, which are numbered from 1.

    Attributes
    ----------
    scene, scene_sha256
        Scene file (absolute) and its content.
    versions
        Versions of Firetwin and Blender.
    count
        Number of frames of the shot.
    camera_frames
        List of frames by camera.
    passes
        Passes by view (camera, or camera@run).
    tasks
        Bake tasks, then render tasks.
    assets
        Files that tasks read (absolute paths).
    feature
        Room whose work the file `scene` describes, with its units as frames (see `divided`); "" for a film.
    """

    scene: str
    scene_sha256: str
    versions: dict[str, str]
    count: int
    camera_frames: Mapping[str, str]
    passes: dict[str, tuple[str, ...]]
    tasks: tuple[Task, ...]
    assets: tuple[str, ...]
    feature: str = ""

    def numbers(self, stage: str) -> list[int]:
        """List the numbers of the tasks of a stage."""
        return [number for number, task in enumerate(self.tasks, start=1) if task.stage == stage]

    def task(self, number: int) -> Task:
        """Return the task with this number."""
        return self.tasks[number - 1]

    def frames(self, task: Task, camera: str) -> list[int]:
        """List the frames that a camera renders in a task."""
        asked = FrameList(task.frames).frames(self.count)
        if FrameList(self.camera_frames[camera]).has_all():
            return asked
        own = set(FrameList(self.camera_frames[camera]).frames(self.count))
        return [frame for frame in asked if frame in own]

    def views(self, camera: str) -> list[str]:
        """List the views of a camera: first run, then the others."""
        return [view for view in self.passes if view.partition("@")[0] == camera]

    def pictures(self, task: Task) -> Iterator[Picture]:
        """Yield the pictures of a task."""
        if task.stage != "render":
            return
        for camera in task.cameras:
            listed = self.frames(task, camera)
            for view in self.views(camera):
                yield from (Picture(view, frame, name) for frame in listed for name in self.passes[view])


def make_job(shot: Shot, scene: Path, size: int = CHUNK) -> Job:
    """Plan a film.

    Parameters
    ----------
    scene
        Scene file of the film.
    size
        Maximum frames per task.

    Raises
    ------
    UsageError
        There is nothing to render.
    InputError
        An asset is missing, or the terms of a tile service forbid copies for other machines.
    """
    settings = shot.settings
    camera_frames, passes, linked = {}, {}, []
    if not settings.cameras:
        raise UsageError(f"{settings.path} has no [[cameras]], so there is nothing to render")
    tile_terms.check(settings, [("pack", "the farm, whose machines share one copy")])
    for camera in settings.cameras:
        first = FrameList.of(shot.frames_of(camera)[:1])
        found = pictures.pictures(shot, first, camera.name)
        camera_frames[camera.name] = camera.frames
        linked.append({each.camera.partition("@")[0] for each in found} | {camera.name})
        own = [each for each in found if each.camera.partition("@")[0] == camera.name]
        for view in dict.fromkeys(each.camera for each in own):
            passes[view] = tuple(each.name for each in own if each.camera == view)
    tasks = [*_bakes(shot), *_renders(shot, settings, _groups(linked), size)]
    return Job(
        scene=str(scene.absolute()),
        scene_sha256=sha256(scene),
        versions=fingerprint.versions(),
        count=shot.frames.count,
        camera_frames=camera_frames,
        passes=passes,
        tasks=tuple(tasks),
        assets=tuple(map(str, assets.list_assets(shot))),
    )


def split_frames(listed: list[int], size: int, built: int) -> list[list[int]]:
    """Distribute frames over tasks.

    Parameters
    ----------
    listed
        Frames, ascending.
    size
        Maximum frames per task.
    built
        Number of frames that are built together (a build chunk); 0 builds all together. A task has complete
        build chunks, or some frames of a single one. In the latter case it still builds the complete chunk,
        so that its pictures do not depend on `size`.
    """
    chunks: list[list[int]] = []
    split = True
    for part in frames.parts(listed, built).values():
        if not split and len(chunks[-1]) + len(part) <= size:
            chunks[-1] += part
        else:
            split = len(part) > size
            chunks += _evenly(part, size)
    return chunks


def _evenly(listed: list[int], size: int) -> Iterator[list[int]]:
    """Split into as few parts of at most `size` frames as possible; their lengths differ by at most one."""
    count = -(-len(listed) // size)
    ends = [len(listed) * k // count for k in range(count + 1)]
    return (listed[i:j] for i, j in itertools.pairwise(ends))


def _groups(linked: Iterable[set[str]]) -> list[set[str]]:
    """Group cameras whose pictures depend on one another; each camera is in one group."""
    found: list[set[str]] = []
    for names in linked:
        joined = set(names).union(*(group for group in found if group & names))
        found = [group for group in found if not group & names] + [joined]
    return found


def _renders(shot: Shot, settings: Settings, groups: list[set[str]], size: int) -> Iterator[Task]:
    for group in groups:
        cameras = [camera for camera in settings.cameras if camera.name in group]
        listed = sorted({frame for camera in cameras for frame in shot.frames_of(camera)})
        built = max(settings.chunk_size(camera) for camera in cameras)
        for part in split_frames(listed, size, built):
            yield Task("render", tuple(camera.name for camera in cameras), FrameList.of(part))


def _bakes(shot: Shot) -> Iterator[Task]:
    """Yield one task per smoke flow; a view whose flow is contained in the flow of another view has none."""
    settings = shot.settings
    if not settings.smoke.enabled:
        return
    needed = {}
    for view in scene_runs.views(settings):
        own = comparison.for_view(shot, view)
        if solutions := sources.select(own).solutions():
            needed[view] = solutions, set(own.frames_of(*own.settings.cameras))
    solved: dict[str, set[int]] = {}
    for view, (solutions, listed) in sorted(needed.items(), key=lambda each: len(each[1][0]), reverse=True):
        host = next((other for other in solved if solutions <= needed[other][0]), view)
        solved.setdefault(host, set()).update(listed)
    for view in needed:
        if view in solved:
            yield Task("bake", (view,), FrameList.of(sorted(solved[view])))


def job_dir(out: Path) -> Path:
    """Return the folder of the job's files in its output folder."""
    return out / FOLDER


def write(job: Job, out: Path) -> None:
    """Write a job into an output folder.

    Raises
    ------
    InputError
        The folder has a different job, or cannot be written.
    """
    path = job_dir(out) / FILE
    output.refuse_run_folders(path)
    if path.parent.is_symlink() or (not path.exists() and any(path.parent.glob("[!.]*"))):
        raise input_error(path.parent, "belongs to no job of Firetwin; choose another output folder")
    if path.exists() and read(out) != job:
        raise input_error(
            path, "describes a different job, or the scene file has changed; choose another output folder"
        )
    text = json.dumps({"format": _FORMAT} | asdict(job), separators=(",", ":")) + "\n"
    files.write_text(path, text)


def read(out: Path) -> Job:
    """Read the job of an output folder.

    Raises
    ------
    InputError
        The folder has no job, or its file is damaged.
    """
    path = job_dir(out) / FILE
    try:
        found: dict[str, Any] = files.read_json(path)
        if found.pop("format") != _FORMAT:
            raise ValueError
        tasks = (Task(each["stage"], tuple(each["cameras"]), each["frames"]) for each in found["tasks"])
        passes = {view: tuple(names) for view, names in found["passes"].items()}
        return Job(**(found | {"tasks": tuple(tasks), "passes": passes, "assets": tuple(found["assets"])}))
    except FileNotFoundError:
        reason = (
            "no farm job in this folder; write one with: firetwin farm SCENE.toml --engine NAME --out DIR"
        )
        raise input_error(path, reason) from None
    except (OSError, ValueError, TypeError, LookupError, AttributeError) as error:
        raise input_error(
            path, f"not a farm job of this version of Firetwin ({error}); plan it again"
        ) from None
