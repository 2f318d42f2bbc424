"""Bake job: writes the smoke volumes of the whole shot."""

from __future__ import annotations

from pathlib import Path

from ..errors import Error
from ..progress import READING, MessageCallback, Progress, no_message, notify_if_slow, silent
from ..shot.comparison import for_view
from ..shot.runs import scene_runs
from ..shot.source import ShotSource
from . import worker


def run(
    choice: ShotSource,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    together: bool = False,
) -> list[Path]:
    """Write the missing smoke volumes, separately for each camera as `render` uses them.

    Parameters
    ----------
    together
        Write the volumes of one scene with all cameras.

    Returns
    -------
    Cache folders of the volumes; empty without smoke.

    Raises
    ------
    Error
        The worker process ended early.
    """
    with notify_if_slow(READING):
        shot = choice.shot()
    if not shot.settings.smoke.enabled:
        return []
    task = {"choice": choice.plain(), "together": together}
    try:
        places = worker.run(f"{__name__}:in_process", task, progress, stop=stop, tell=tell, blender=False)
    except worker.EndedError as error:
        raise Error(f"the bake {error}; if memory ran out, larger voxels need less") from None
    return [Path(place) for place in places]


def in_process(
    choice: dict[str, str], together: bool, progress: Progress, tell: MessageCallback
) -> list[str]:
    """Bake and return the folders of the volumes."""
    from ..smoke import bake, plume_mass, sources

    shot = ShotSource(**choice).shot()
    for text in shot.warnings():
        tell(text)
    shots = [shot] if together else [for_view(shot, view) for view in scene_runs.views(shot.settings)]
    places = {bake.folder(each, progress): each for each in shots}
    for place in places.values():
        if cost := sources.select(place).cost():
            tell(cost.describe())
    made = [str(bake.bake(place, progress)) for place in places.values()]
    tell(plume_mass.describe(shot))
    return made
