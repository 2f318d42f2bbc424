"""The smoke volumes of a shot on disk: one OpenVDB file per frame, made once.

They lie in ``<cache>/<key>/smoke_000001.vdb``; the key is a hash of what is in the run's files, of the
settings that change the smoke and of the code that makes it, so that a changed setting never shows old
smoke, and a repeated bake has nothing to do. Every file is whole: it gets its name when it is complete.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from ..errors import writing
from ..progress import MessageCallback, Progress, count, no_message, share, silent, size
from ..run import content
from ..shot import code_fingerprint
from ..shot.settings import schema
from ..shot.shot import Shot
from . import cache, shared_frames, sources
from .sources import Source
from .sources._single import SHOWN
from .view import resolution, shot_frames

__all__ = ["ahead", "bake", "estimate", "file", "folder", "resolution", "shot_frames"]

_FRAME_MEMORY = 2 << 30  # bytes that a frame may need while it is made: 0.5 GB, of a flow 1.9, were measured
_FRAME_PROCESSORS = 4  # a frame keeps two busy: two at once on those took as long, and twice the memory
_NOT_IN_FILES = ("enabled", "extinction", "voxel_size", "draw")
"""Keys of [smoke] that only say how it is drawn; voxel sizes count by themselves."""


def folder(shot: Shot, progress: Progress = silent) -> Path:
    """Where the smoke of this shot is kept. What of the run was never read is read now.

    It is absolute: Blender takes other paths for places beside the .blend file.
    """
    return shot.settings.cache.absolute() / _key(shot, progress)


def file(shot: Shot, frame: int) -> Path:
    """The volume of a frame."""
    return _in(folder(shot), frame)


def bake(shot: Shot, progress: Progress = silent, frames: Iterable[int] | None = None) -> Path:
    """Write the volumes of the shot (or of those of `frames` that it has) that are not there yet.

    Several frames are made at once, as many as there are processors and memory for. Those that one of several
    cameras films alone are that camera's own, as its film has them: they are made once for both.

    Returns
    -------
    The folder that holds them.

    Raises
    ------
    InputError
        The cache cannot be written.
    """
    place = _prepared(shot, progress)
    wanted = shot_frames(shot) if frames is None else _of_shot(shot, frames)

    def lacking() -> list[int]:
        return [frame for frame in wanted if not _in(place, frame).exists()]

    missing = lacking()
    for one, listed in shared_frames.frames(shot, missing):
        own = share(progress, len(wanted) - len(missing), len(wanted), "smoke")
        shared_frames.link(bake(one, own, listed), place, listed)
        missing = lacking()
    done = len(wanted) - len(missing)
    progress(done, len(wanted), "smoke")
    if not missing:
        return place
    source = sources.select(shot)
    with cache.in_use(place), source.in_use():
        source.prepare(missing, progress)
        with ThreadPoolExecutor(_at_once(len(missing))) as pool:
            tasks = [pool.submit(source.write, _in(place, frame), frame) for frame in missing]
            try:
                for task in as_completed(tasks):
                    task.result()
                    done += 1
                    progress(done, len(wanted), "smoke")
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    return place


@contextmanager
def ahead(
    shot: Shot, frames: Iterable[int], progress: Progress = silent, tell: MessageCallback = no_message
) -> Iterator[Callable[..., None]]:
    """Write volumes while pictures are made, one frame before it is shown.

    Gives a function ``ready(frame, ahead)`` that waits until the volume of a frame is there and has the first
    of the frames `ahead` whose volume is missing made meanwhile; left out, they are those that come after it.
    It raises what went wrong with that frame. With smoke off it does nothing.

    Parameters
    ----------
    frames
        In the order in which they are shown; those that the shot does not have count for nothing.
    progress
        Called while the first frame waits.
    tell
        Told how much room the volumes will need, once there is one to judge by.

    Raises
    ------
    InputError
        The cache cannot be written.
    """
    wanted = _of_shot(shot, frames)
    if not wanted or not shot.settings.smoke.enabled:
        yield lambda frame, ahead=None: None
        return
    line = _Volumes(shot, wanted, progress, tell)
    with cache.in_use(line.place):
        try:
            yield line.ready
        finally:
            line.close()


def estimate(shot: Shot, frames: Iterable[int]) -> int | None:
    """Bytes that the volumes of `frames` need, from the mean of those that are there; None without any."""
    sizes = {path.name: path.stat().st_size for path in folder(shot).glob("*.vdb")}
    there = sum(name.startswith("smoke") for name in sizes)
    return round(sum(sizes.values()) / there * len(_of_shot(shot, frames))) if there else None


class Line:
    """Frames whose smoke stands in line to be made, by one thread.

    Attributes
    ----------
    elsewhere
        Whether another process of ours prepares the shot; None: none does.
    """

    elsewhere: Callable[[], bool] | None = None

    def __init__(self, shot: Shot, progress: Progress, tell: MessageCallback) -> None:
        self.shot, self.progress, self.tell = shot, progress, tell
        self.pool = ThreadPoolExecutor(1)
        self.tasks: dict[int, Future[Any]] = {}
        self.held = ExitStack()

    @functools.cached_property
    def source(self) -> Source:
        """What makes it."""
        source = sources.select(self.shot)
        if cost := source.cost():
            self.tell(cost.describe())
        self.held.enter_context(source.in_use())
        source.progress = lambda *done: self.progress(*done)
        if self.elsewhere:
            source.elsewhere = self.elsewhere
        return source

    def close(self) -> None:
        """Let go of frames that nobody waits for any more."""
        if "source" in self.__dict__:
            self.source.stop.set()
        self.pool.shutdown(cancel_futures=True)
        self.held.close()


class _Volumes(Line):
    """Frames whose volumes are written."""

    def __init__(self, shot: Shot, frames: list[int], progress: Progress, tell: MessageCallback) -> None:
        super().__init__(shot, progress, tell)
        self.frames, self.place = frames, _prepared(shot, progress)

    def ready(self, frame: int, ahead: Iterable[int] | None = None) -> None:
        """Wait for a frame and have the next one begun."""
        if frame not in self.frames:
            return
        self._begin(frame)
        after = self.frames[self.frames.index(frame) + 1 :]
        if ahead is not None:
            after = [each for each in ahead if each in self.frames]
        following = next((each for each in after if not _in(self.place, each).exists()), None)
        if following is not None:
            self._begin(following)
        task = self.tasks.get(frame)
        if task is not None:
            self.progress(0, 1, "smoke of the first picture")
            task.result()
            self.progress(1, 1, "smoke of the first picture")
            self.tell(self._room())
        self.progress, self.tell = silent, no_message

    def _room(self) -> str:
        """How much the volumes need, in words."""
        needed = size(max(estimate(self.shot, self.frames) or 0, 1e6))
        return f"smoke of {count(len(self.frames), 'frame')} takes about {needed} in {self.place}"

    def _begin(self, frame: int) -> None:
        path = _in(self.place, frame)
        if frame not in self.tasks and not path.exists():
            self.tasks[frame] = self.pool.submit(self.source.write, path, frame)


def _in(place: Path, frame: int) -> Path:
    return place / f"smoke_{frame:06d}.vdb"


def _of_shot(shot: Shot, frames: Iterable[int]) -> list[int]:
    """Those of `frames` that the shot has, each once."""
    return [frame for frame in dict.fromkeys(frames) if 1 <= frame <= shot.frames.count]


def _prepared(shot: Shot, progress: Progress) -> Path:
    """The folder of the volumes, made and swept."""
    place = folder(shot, progress)
    with writing(place):
        place.mkdir(parents=True, exist_ok=True)
    cache.sweep(place)
    return place


def _at_once(frames: int) -> int:
    """How many frames are made at the same time."""
    try:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        free = _FRAME_MEMORY
    return max(1, min(frames, (os.cpu_count() or 1) // _FRAME_PROCESSORS, free // _FRAME_MEMORY))


def _key(shot: Shot, progress: Progress) -> str:
    """Hash of everything that the volumes depend on."""
    settings, complete = shot.settings, shot.settings.smoke.complete
    source = sources.select(shot)
    found = schema.select(settings, {"time", "smoke"} if complete else {"time", "smoke", "camera", "terrain"})
    leaders = [each for camera in settings.cameras if (each := camera.rig.followed(shot.cameras))]
    for name in (*_NOT_IN_FILES, *source.unused_settings):
        del found["smoke"][name]
    found |= source.inputs()
    if not complete:  # what is left out depends on what the cameras see, and when
        width, height = settings.render.resolution
        for camera in found.get("cameras", ()):
            del camera["frames"]  # however they are written
        found["sight"] = [height / width, [shot.frames_of(camera) for camera in settings.cameras]]
        found["leaders"] = [repr(each) for each in leaders]
    return content.fingerprint(
        {
            "sources": code_fingerprint.hashes(
                {"smoke"}, [*settings.cameras, *leaders], *source.code_files()
            ),
            "run": shot.input_hashes(("temperature",), progress),
            "settings": found,
            "voxel": source.voxels(),
            "grids": None if complete else SHOWN,
        }
    )
