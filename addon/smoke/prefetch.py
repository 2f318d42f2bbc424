"""Prefetch of smoke bricks for ray marching: each frame is painted one frame ahead."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager

from firetwin_core import volume

from ..progress import MessageCallback, Progress, no_message, silent
from ..shot.shot import Shot
from . import bake, sources

Smoke = list[volume.Bricks]
Ready = Callable[[int, Iterable[int]], Smoke]


def smoke(
    shot: Shot,
    frames: Iterable[int],
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    elsewhere: Callable[[], bool] | None = None,
) -> AbstractContextManager[Callable[..., Smoke | None]]:
    """Supply rendered frames with smoke: `bricks` for ray marching, else `bake.ahead`."""
    if sources.is_integrated(shot):
        return bricks(shot, frames, progress, tell, elsewhere)
    return bake.ahead(shot, frames, progress, tell)


@contextmanager
def bricks(
    shot: Shot,
    frames: Iterable[int],
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    elsewhere: Callable[[], bool] | None = None,
) -> Iterator[Ready]:
    """Paint smoke bricks during rendering.

    Yields a function ``ready(frame, after)``. It waits for a frame's smoke and returns it, or raises its
    error; meanwhile the first of the frames `after` is painted. Frames outside of `frames` have no smoke.

    Parameters
    ----------
    elsewhere
        True while another Firetwin process prepares the shot. Its unfinished work is completed here.
    """
    line = _Bricks(shot, set(frames), progress, tell, elsewhere)
    try:
        yield line.ready
    finally:
        line.close()


class _Bricks(bake.BakeQueue):
    """Queue of frames whose smoke is painted as bricks."""

    def __init__(
        self,
        shot: Shot,
        frames: set[int],
        progress: Progress,
        tell: MessageCallback,
        elsewhere: Callable[[], bool] | None,
    ) -> None:
        super().__init__(shot, progress, tell)
        self.frames = frames
        self.elsewhere = elsewhere

    def ready(self, frame: int, after: Iterable[int] = ()) -> Smoke:
        """Return a frame's smoke, start the next frame, and cancel frames that are no longer needed."""
        if frame not in self.frames:
            return []
        following = next((each for each in after if each in self.frames), None)
        for number in (frame, following):
            if number is not None and number not in self.tasks:
                self.tasks[number] = self.pool.submit(self.source.bricks, number)
        for old in set(self.tasks) - {frame, following}:
            self.tasks.pop(old).cancel()
        self.progress(0, 1, "smoke of the first picture")
        smoke = self.tasks.pop(frame).result()
        self.progress(1, 1, "smoke of the first picture")
        self.progress, self.tell = silent, no_message
        return smoke
