"""Solve the flow of a shot's smoke in a process of its own, while another paints snapshots and renders."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

from ..errors import Error
from ..progress import MessageCallback, Progress
from ..shot.comparison import for_view
from ..shot.source import ShotSource
from . import worker

Working = Callable[[], bool]


@contextlib.contextmanager
def beside(choice: ShotSource, view: str, frames: list[int], progress: Progress) -> Iterator[Working]:
    """Solve the flow of a view up to these frames meanwhile; gives whether that goes on.

    The solver's half a gigabyte is another process's. What goes wrong there, who needs a snapshot meets
    again as it solves it.
    """
    stop = worker.Stop()
    task = {"choice": choice.plain(), "view": view, "frames": frames}

    def solve() -> None:
        with contextlib.suppress(Error, worker.StoppedError, worker.EndedError, OSError):
            worker.run(f"{__name__}:in_process", task, progress, stop=stop, blender=False)

    thread = threading.Thread(target=solve, daemon=True)
    thread.start()
    try:
        yield thread.is_alive
    finally:
        stop.now()
        thread.join()


def in_process(
    choice: dict[str, str], view: str, frames: list[int], progress: Progress, tell: MessageCallback
) -> None:
    """Solve it."""
    from ..smoke import sources

    source = sources.select(for_view(ShotSource(**choice).shot(), view))
    with source.in_use():
        source.prepare(frames, progress)
