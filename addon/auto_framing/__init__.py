"""Auto framing: settings fitted to a run, with its most active time window and cameras that show it.

`firetwin new` writes them as a scene file. `render`, `build` and `bake` of a run folder use the same, and so
does *Open run* in Blender.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from firetwin_core.run import Run

from ..run import burning
from ..shot.fire import smoke_scale
from ..shot.sections import Time
from ..shot.settings import Settings
from ..shot.shot import Shot
from . import chase, flank, front, overview, satellite, text, window
from .candidates import PlacedCamera
from .visible_share import Visible


@dataclass(frozen=True)
class FittedScene:
    """Settings fitted to a run, with descriptions.

    Attributes
    ----------
    name
        Name of the run.
    window
        Description of the time window, one line.
    cameras
        Description of each camera, one line, by its name.
    shares
        Visible fraction of the front for each camera, 0..1; 0 without fire.
    """

    settings: Settings
    name: str
    window: str
    cameras: dict[str, str]
    shares: dict[str, float]

    @property
    def lines(self) -> list[str]:
        """Describe the choices in a few lines."""
        return [self.window, *(f"{name}: {words}" for name, words in self.cameras.items())]

    @property
    def text(self) -> str:
        """Format the settings as a short scene file."""
        return text.text(self.settings, self.name, self.window, self.cameras)


def fit(run: Run, settings: Settings) -> FittedScene:
    """Fit settings to a run, based on these, which name the run, the file and the cache.

    If they have the shot's start or end, cameras are fitted to that window, and no other is searched.
    """
    time, words = window.choose(run, settings.time)
    smoky, settings = settings.smoke.enabled, replace(fit_draft(run, settings), time=time)
    if smoky and not settings.smoke.enabled:
        words = f"{words}; no smoke, as the fuel cells resolve no plume"
    shot = Shot(settings, run)
    moving = front.find_front(shot)
    placed = _placed(moving)
    whole = replace(settings, cameras=tuple(camera.camera for camera in placed))
    said, shares = (
        {camera.camera.name: getattr(camera, name) for camera in placed} for name in ("words", "share")
    )
    return FittedScene(whole, run.name, words, said, shares)


def fit_draft(run: Run, settings: Settings) -> Settings:
    """Fit settings of drafts to a run, without its time window and cameras."""
    resolved = smoke_scale.resolves_plume(max(burning.fuel_cell(run)))
    return replace(
        settings,
        smoke=settings.smoke if resolved else replace(settings.smoke, enabled=False),
        terrain=replace(settings.terrain, error=0.1),
        render=replace(settings.render, samples=3, passes=("rgb", "thermal")),
    )


def fit_folder(folder: Path, path: Path, cache: Path, time: Time | None = None) -> FittedScene:
    """Fit settings to the run in a folder, for the scene file `path`; `time` may give the time window.

    Raises
    ------
    InputError
        There is something wrong with the run.
    """
    from ..run import readers

    film = replace(time or Time(), frames=window.FRAMES, fps=window.FPS)
    return fit(readers.open(folder), Settings(path=path, run=folder, cache=cache, time=film))


def _placed(moving: front.MovingFront) -> list[PlacedCamera]:
    visible = Visible(moving)
    kinds = (overview, chase, flank, satellite) if moving.runs else (overview, satellite)
    placed = (kind.place(moving, visible) for kind in kinds)
    return [camera for camera in placed if camera is not None]
