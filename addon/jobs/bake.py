"""Bake job: prepares the smoke of a shot for `render`, or writes the volumes that .blend files show."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ..errors import Error
from ..progress import READING, MessageCallback, Progress, no_message, notify_if_slow, silent
from ..shot.comparison import for_view
from ..shot.runs import scene_runs
from ..shot.shot import Shot
from ..shot.source import ShotSource
from . import worker


def run(
    choice: ShotSource,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    volumes: bool = False,
    frames: Sequence[int] | None = None,
) -> list[Path]:
    """Prepare the smoke separately for each camera, as `render` uses it, or write volumes.

    `render` reads volumes if Blender draws the smoke. It integrates solved smoke along camera rays, which
    needs the solved flow alone.

    Parameters
    ----------
    volumes
        Write the volumes of one scene with all cameras, which .blend files show.
    frames
        Frames of these volumes; None: all that cameras film.

    Returns
    -------
    Cache folders of the volumes, and of flows without volumes; empty without smoke.

    Raises
    ------
    Error
        The worker process ended early.
    """
    with notify_if_slow(READING):
        shot = choice.shot()
    if not shot.settings.smoke.enabled:
        return []
    work = partial(in_process, choice, volumes, frames)
    try:
        return worker.run(work, progress, stop=stop, tell=tell, blender=False)
    except worker.EndedError as error:
        raise Error(f"the bake {error}; if memory ran out, larger voxels need less") from None


def in_process(
    choice: ShotSource,
    volumes: bool,
    frames: Sequence[int] | None,
    progress: Progress,
    tell: MessageCallback,
) -> list[Path]:
    """Prepare the smoke and return its folders."""
    from ..smoke import plume_mass

    shot = choice.shot()
    for text in shot.warnings():
        tell(text)
    shots = [shot] if volumes else [for_view(shot, view) for view in scene_runs.views(shot.settings)]
    made = [place for each in shots for place in _prepare(each, volumes, frames, progress, tell)]
    if frames is None:
        tell(plume_mass.describe(shot))
    return list(dict.fromkeys(made))


def _prepare(
    shot: Shot, volumes: bool, frames: Sequence[int] | None, progress: Progress, tell: MessageCallback
) -> list[Path]:
    """Write the volumes of a shot, or solve its flow if that is all that `render` needs."""
    from ..smoke import bake, sources

    source = sources.select(shot)
    if frames is None and (cost := source.cost()):
        tell(cost.describe())
    if volumes or not sources.is_integrated(shot):
        return [bake.bake(shot, progress, frames)]
    with source.in_use():
        source.prepare(bake.shot_frames(shot), progress)
    return [shot.settings.cache.absolute() / name for name in sorted(source.solutions())]
