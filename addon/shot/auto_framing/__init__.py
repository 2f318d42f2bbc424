"""Settings that fit a run: its most active part, and cameras that show it.

`firetwin new` writes them as a scene file; `render`, `build` and `bake` of a run folder, and *Open run* in
Blender, take the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from firetwin_core.run import Run

from ..settings.settings import Settings, Time
from ..shot import Shot
from . import chase, flank, front, overview, satellite, text, window
from .candidates import Placed
from .visible_share import Visible


@dataclass(frozen=True)
class FittedScene:
    """Settings that fit a run, and what is said of them.

    Attributes
    ----------
    name
        Of the run.
    window
        A line about the moments that are shown.
    cameras
        A line about each camera, by its name.
    shares
        Of the front that each camera films, how much it shows, 0..1; 0 where nothing burns.
    """

    settings: Settings
    name: str
    window: str
    cameras: dict[str, str]
    shares: dict[str, float]

    @property
    def lines(self) -> list[str]:
        """What was chosen, in a few lines."""
        return [self.window, *(f"{name}: {words}" for name, words in self.cameras.items())]

    @property
    def text(self) -> str:
        """The settings as a short scene file."""
        return text.text(self.settings, self.name, self.window, self.cameras)


def fit(run: Run, settings: Settings) -> FittedScene:
    """Settings for a run that begin with these, which name the run, the file and the cache.

    Where they say when the shot starts or ends, cameras fit that, and no other moments are looked for.
    """
    time, words = window.choose(run, settings.time)
    settings = replace(
        settings,
        time=time,
        terrain=replace(settings.terrain, error=0.1),
        render=replace(settings.render, samples=3, passes=("rgb", "thermal")),
    )
    shot = Shot(settings, run)
    moving = front.find_front(shot)
    placed = _placed(moving)
    whole = replace(settings, cameras=tuple(each.camera for each in placed))
    said, shares = ({each.camera.name: getattr(each, name) for each in placed} for name in ("words", "share"))
    return FittedScene(whole, run.name, words, said, shares)


def fit_folder(folder: Path, path: Path, cache: Path, time: Time | None = None) -> FittedScene:
    """Settings for the run in a folder, as of the scene file `path`; `time` may say what is filmed.

    Raises
    ------
    InputError
        What is wrong with the run.
    """
    from ...run import readers

    return fit(readers.open(folder), Settings(path=path, run=folder, cache=cache, time=time or Time()))


def _placed(moving: front.Front) -> list[Placed]:
    visible = Visible(moving)
    kinds = (overview, chase, flank, satellite) if moving.runs else (overview, satellite)
    return [kind.place(moving, visible) for kind in kinds]
