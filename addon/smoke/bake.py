"""Bake: write the smoke volumes of a shot to disk, one OpenVDB file per frame.

Files are ``<cache>/<key>/smoke_000001.vdb``. The key is a hash of the run's inputs, of the settings that
affect smoke, and of the code that makes it. Therefore changed settings never show stale smoke, and a repeated
bake does no work. Files are renamed into place when complete.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from .. import memory
from ..errors import writing
from ..progress import MessageCallback, Progress, count, no_message, share, silent, size
from ..run import content
from ..shot import schema
from ..shot.settings import code_fingerprint
from ..shot.shot import Shot
from . import cache, shared_frames, sources
from .sources import Source
from .sources.model import SHOWN
from .view import resolution, shot_frames

__all__ = [
    "ahead",
    "bake",
    "estimate",
    "file",
    "folder",
    "marker",
    "resolution",
    "shot_frames",
    "volume_path",
]

_FRAME_MEMORY = 2 << 30  # bytes of memory per frame; measured: 0.5 GB, and 1.9 GB for a flow
_FRAME_PROCESSORS = 4  # per frame; on four, two frames in parallel took as long and twice the memory
_NOT_IN_FILES = ("enabled", "voxel_size", "draw")
"""Keys of [smoke] that affect only rendering; voxel sizes are hashed separately."""


def folder(shot: Shot, progress: Progress = silent) -> Path:
    """Return the cache folder of this shot's smoke. This may read inputs of the run.

    The path is absolute, because Blender resolves relative paths against the .blend file.
    """
    return shot.settings.cache.absolute() / _cache_key(shot, progress)


def file(shot: Shot, frame: int) -> Path:
    """Return the volume file of a frame."""
    return volume_path(folder(shot), frame)


def marker(volume_file: Path) -> Path:
    """Return the small file that marks the volumes of a frame as complete.

    Geometry nodes can read text files: the notice of missing smoke in a .blend file tests for this one.
    """
    return volume_file.with_suffix(".txt")


def bake(shot: Shot, progress: Progress = silent, frames: Iterable[int] | None = None) -> Path:
    """Write the missing volumes of the shot, or of its frames among `frames`.

    Several frames are baked in parallel, as processors and memory allow. A frame filmed by only one of
    several cameras shares the volume with a render of that camera alone.

    Returns
    -------
    The folder of the volumes.

    Raises
    ------
    InputError
        The cache cannot be written.
    """
    place = _prepare_folder(shot, progress)
    wanted = shot_frames(shot) if frames is None else _frames_of_shot(shot, frames)

    def missing_frames() -> list[int]:
        return [frame for frame in wanted if not volume_path(place, frame).exists()]

    missing = missing_frames()
    for one, listed in shared_frames.frames(shot, missing):
        own = share(progress, len(wanted) - len(missing), len(wanted), "smoke")
        shared_frames.link(bake(one, own, listed), place, listed)
        missing = missing_frames()
    done = len(wanted) - len(missing)
    progress(done, len(wanted), "smoke")
    for frame in set(wanted) - set(missing):
        _mark(volume_path(place, frame))
    if not missing:
        return place
    source = sources.select(shot)
    with cache.in_use(place), source.in_use():
        source.prepare(missing, progress)
        with ThreadPoolExecutor(_parallel_frames(len(missing))) as pool:
            tasks = [pool.submit(_write, source, volume_path(place, frame), frame) for frame in missing]
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
    """Write volumes during rendering, one frame ahead.

    Yields a function ``ready(frame, ahead)``. It waits for a frame's volume, or raises its error, and starts
    the first missing one of the frames `ahead`, by default the following frames. Without smoke it does
    nothing.

    Parameters
    ----------
    frames
        Frames in order of rendering; frames outside of the shot are ignored.
    progress
        Called while waiting for the first frame.
    tell
        Receives a message on the required disk space, as soon as a volume exists to estimate it.

    Raises
    ------
    InputError
        The cache cannot be written.
    """
    wanted = _frames_of_shot(shot, frames)
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
    """Estimate the bytes of the volumes of `frames` from the mean of existing volumes; None without any."""
    sizes = {path.name: path.stat().st_size for path in folder(shot).glob("*.vdb")}
    there = sum(name.startswith("smoke") for name in sizes)
    return round(sum(sizes.values()) / there * len(_frames_of_shot(shot, frames))) if there else None


class BakeQueue:
    """Queue of frames whose smoke is prepared by one thread.

    Attributes
    ----------
    elsewhere
        True while another Firetwin process prepares the shot; None: there is no other process.
    """

    elsewhere: Callable[[], bool] | None = None

    def __init__(self, shot: Shot, progress: Progress, tell: MessageCallback) -> None:
        self.shot, self.progress, self.tell = shot, progress, tell
        self.pool = ThreadPoolExecutor(1)
        self.tasks: dict[int, Future[Any]] = {}
        self.held = ExitStack()

    @functools.cached_property
    def source(self) -> Source:
        """Smoke source of the frames."""
        source = sources.select(self.shot)
        if not self.elsewhere and (cost := source.cost()):
            self.tell(cost.describe())
        self.held.enter_context(source.in_use())
        source.progress = lambda *done: self.progress(*done)
        if self.elsewhere:
            source.elsewhere = self.elsewhere
        return source

    def close(self) -> None:
        """Cancel queued frames."""
        if "source" in self.__dict__:
            self.source.stop.set()
        self.pool.shutdown(cancel_futures=True)
        self.held.close()


class _Volumes(BakeQueue):
    """Queue of frames whose volumes are written to disk."""

    def __init__(self, shot: Shot, frames: list[int], progress: Progress, tell: MessageCallback) -> None:
        super().__init__(shot, progress, tell)
        self.frames, self.place = frames, _prepare_folder(shot, progress)

    def ready(self, frame: int, ahead: Iterable[int] | None = None) -> None:
        """Wait for a frame and start the next one."""
        if frame not in self.frames:
            return
        self._begin(frame)
        after = self.frames[self.frames.index(frame) + 1 :]
        if ahead is not None:
            after = [number for number in ahead if number in self.frames]
        following = next((number for number in after if not volume_path(self.place, number).exists()), None)
        if following is not None:
            self._begin(following)
        task = self.tasks.get(frame)
        if task is not None:
            self.progress(0, 1, "smoke of the first picture")
            task.result()
            self.progress(1, 1, "smoke of the first picture")
            self.tell(self._disk_space())
        self.progress, self.tell = silent, no_message

    def _disk_space(self) -> str:
        """Format the message on disk space."""
        needed = size(max(estimate(self.shot, self.frames) or 0, 1e6))
        return f"smoke of {count(len(self.frames), 'frame')} takes about {needed} in {self.place}"

    def _begin(self, frame: int) -> None:
        path = volume_path(self.place, frame)
        if frame not in self.tasks and not path.exists():
            self.tasks[frame] = self.pool.submit(_write, self.source, path, frame)


def _write(source: Source, path: Path, frame: int) -> None:
    """Write the volumes of a frame, then their marker."""
    source.write(path, frame)
    _mark(path)


def _mark(path: Path) -> None:
    """Write the marker of a volume file, unless it exists."""
    if not marker(path).exists():
        with writing(path):
            marker(path).write_text("complete\n", encoding="utf-8", newline="\n")


def volume_path(place: Path, frame: int) -> Path:
    """Return the volume file of a frame in a folder; it is the last file of the frame to be written."""
    return place / f"smoke_{frame:06d}.vdb"


def _frames_of_shot(shot: Shot, frames: Iterable[int]) -> list[int]:
    """Return the frames of the shot among `frames`, without duplicates."""
    return [frame for frame in dict.fromkeys(frames) if 1 <= frame <= shot.frames.count]


def _prepare_folder(shot: Shot, progress: Progress) -> Path:
    """Create the folder of the volumes and remove unfinished files."""
    place = folder(shot, progress)
    with writing(place):
        place.mkdir(parents=True, exist_ok=True)
    cache.remove_unfinished(place)
    return place


def _parallel_frames(frames: int) -> int:
    """Return the number of frames to bake in parallel."""
    return max(1, min(frames, (os.cpu_count() or 1) // _FRAME_PROCESSORS, memory.free() // _FRAME_MEMORY))


def _cache_key(shot: Shot, progress: Progress) -> str:
    """Compute the cache key: a hash of all inputs of the volumes."""
    settings, complete = shot.settings, shot.settings.smoke.complete
    source = sources.select(shot)
    inputs = schema.select(
        settings, {"time", "smoke"} if complete else {"time", "smoke", "camera", "terrain"}
    )
    leaders = [each for camera in settings.cameras if (each := camera.rig.followed(shot.cameras))]
    for name in (*_NOT_IN_FILES, *source.unused_settings):
        del inputs["smoke"][name]
    inputs |= source.inputs()
    if not complete:  # culling depends on the cameras and their frames
        width, height = settings.render.resolution
        for camera in inputs.get("cameras", ()):
            del camera["frames"]  # normalised form
        inputs["sight"] = [height / width, [shot.frames_of(camera) for camera in settings.cameras]]
        inputs["culled"] = settings.render.cull
        inputs["leaders"] = [repr(leader) for leader in leaders]
    return content.fingerprint(
        {
            "sources": code_fingerprint.hashes(
                {"smoke"}, [*settings.cameras, *leaders], *source.code_files()
            ),
            "run": shot.input_hashes(("temperature",), progress),
            "settings": inputs,
            "voxel": source.voxels(),
            "grids": None if complete else SHOWN,
        }
    )
