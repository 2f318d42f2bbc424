"""Solver job: solves a shot's smoke flow in a separate process, concurrently with rendering."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from functools import partial

from ..errors import Error
from ..progress import MessageCallback, Progress
from ..shot.comparison import for_view
from ..shot.source import ShotSource
from . import worker

Working = Callable[[], bool]


@contextlib.contextmanager
def in_parallel(choice: ShotSource, view: str, frames: list[int], progress: Progress) -> Iterator[Working]:
    """Solve a view's flow up to these frames in parallel; yield a test of whether the solver runs.

    The solver's half a gigabyte belongs to the other process. Its errors are not raised here: the renderer
    meets them again when it solves a missing snapshot itself.
    """
    stop = worker.Stop()
    work = partial(in_process, choice, view, frames)

    def solve() -> None:
        with contextlib.suppress(Error, worker.StoppedError, worker.EndedError, OSError):
            worker.run(work, progress, stop=stop, blender=False)

    thread = threading.Thread(target=solve, daemon=True)
    thread.start()
    try:
        yield thread.is_alive
    finally:
        stop.now()
        thread.join()


def in_process(
    choice: ShotSource, view: str, frames: list[int], progress: Progress, tell: MessageCallback
) -> None:
    """Solve the flow; worker side."""
    from ..smoke import sources

    source = sources.select(for_view(choice.shot(), view))
    with source.in_use():
        source.prepare(frames, progress)
