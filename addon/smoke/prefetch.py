"""Smoke of frames for rays to be marched through, painted one frame before it is shown."""

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
    """What gives pictures their smoke: `bricks` where it is marched, else `bake.ahead`."""
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
    """Paint smoke while pictures are made.

    Gives a function ``ready(frame, after)`` that waits until the smoke of a frame is painted and returns it;
    the first of the frames `after` is painted meanwhile. Frames that are not among `frames` have none. It
    raises what went wrong with that frame.

    Parameters
    ----------
    elsewhere
        Whether another process of ours prepares the shot. What it leaves undone is done here.
    """
    line = _Bricks(shot, set(frames), progress, tell, elsewhere)
    try:
        yield line.ready
    finally:
        line.close()


class _Bricks(bake.Line):
    """Frames whose smoke is painted."""

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
        """The smoke of a frame. That of the next is begun, and what nobody waits for any more is let go."""
        if frame not in self.frames:
            return []
        following = next((each for each in after if each in self.frames), None)
        for number in (frame, following):
            if number is not None and number not in self.tasks:
                self.tasks[number] = self.pool.submit(self.source.bricks, number)
        for old in set(self.tasks) - {frame, following}:
            self.tasks.pop(old).cancel()
        self.progress(0, 1, "smoke of the first picture")
        found = self.tasks.pop(frame).result()
        self.progress(1, 1, "smoke of the first picture")
        self.progress, self.tell = silent, no_message
        return found
