"""Places and moments of each kind of fire in a run: cells in which it burns, by suitability."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import burning, sun, times
from ...shot.fire import flame_map, smoke_scale
from ...shot.sections import Time
from ...shot.settings import Settings
from ...shot.shot import Shot
from ...shot.terrain.terrain import Terrain
from .kinds import Cells, FireKind, LightOfDay

FRAMES, FPS = 96, 24  # four seconds in real time
SECONDS = (FRAMES - 1) / FPS
_SPIN_UP = 300.0  # s; older smoke of a large fire covers the flames in most places (by eye)
_SUN_STEP = 600.0  # s between positions of the sun
_PLACES = 12  # places that are tried for a kind of fire
_APART = 4.0  # cells between them, at least

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Survey:
    """Run, terrain and fire, computed once for all views.

    Attributes
    ----------
    shot
        Shot of the whole run, without cameras.
    first, last
        Model times between which clips begin, s.
    """

    shot: Shot
    cells: Cells
    first: float
    last: float

    @property
    def ground(self) -> Terrain:
        """Terrain without detail near cameras."""
        return self.shot.bare_ground

    def clip(self, start: float) -> Shot:
        """Return the shot of a clip from a model time (s), rounded to the millisecond.

        Its scale of smoke is the run's; `with_own_smoke` has the clip's.
        """
        run, settings = self.shot.run, self.shot.settings
        time = Time(start=times.utc(run, round(start, 3)), frames=FRAMES, fps=FPS, speed=1.0)
        return self.shot.with_settings(replace(settings, time=time))


def with_own_smoke(clip: Shot) -> Shot:
    """Return a clip with the fire and the scale of smoke that its scene file has."""
    own = Shot(clip.settings, clip.run)
    own.relief, own.arrival, own.bare_ground = clip.relief, clip.arrival, clip.bare_ground
    return own


def survey(run: Run, folder: Path, cache: Path, asked: tuple[datetime | None, datetime | None]) -> Survey:
    """Survey the fire of a run between the requested times."""
    settings = Settings(path=cache / "scene.toml", run=folder, cache=cache, time=Time(frames=2))
    if not smoke_scale.resolves_plume(max(burning.fuel_cell(run))):
        settings = replace(settings, smoke=replace(settings.smoke, enabled=False))
    shot = Shot(settings, run)
    if shot.spin_up > _SPIN_UP:
        shot = shot.with_settings(replace(settings, smoke=replace(settings.smoke, spin_up=_SPIN_UP)))
    ground, front, _ = shot.bare_ground, shot.front, shot.flame_length  # which clips share
    cells = Cells(
        np.where(ground.burned >= 0.5, flame_map.cell_lengths(front, settings.fire.flame_length), 0.0),
        front.intensity,
        front.kind,
        ground.fields.canopy_fuel,
    )
    limits = float(run.times[0]), float(run.times[-1])
    first, last = (
        limit if moment is None else times.seconds(run, moment)
        for limit, moment in zip(limits, asked, strict=True)
    )
    return Survey(shot, cells, first, last - SECONDS)


def candidates(survey: Survey, kind: FireKind, light: LightOfDay) -> list[tuple[int, int]]:
    """Rows and columns of cells in which the fire burns in this light, the most suitable first, apart."""
    ground = survey.ground
    suits = kind.suits(survey.cells)
    inside = (ground.arrival >= survey.first) & (ground.arrival <= survey.last)
    row, column = np.nonzero((suits > 0.0) & inside)
    height = _sun_elevation(survey, ground.arrival[row, column])
    lit = (height >= light.low) & (height <= light.high)
    row, column = row[lit], column[lit]
    order = np.argsort(-suits[row, column], kind="stable")
    chosen: list[tuple[int, int]] = []
    for at in order:
        place = int(row[at]), int(column[at])
        if all(np.hypot(place[0] - r, place[1] - c) >= _APART for r, c in chosen):
            chosen.append(place)
        if len(chosen) == _PLACES:
            break
    return chosen


def _sun_elevation(survey: Survey, moments: Array) -> Array:
    """Elevation (n,) of the sun at model times (n,), degrees."""
    run = survey.shot.run
    first, last = float(run.times[0]), float(run.times[-1])
    some = np.linspace(first, last, max(int((last - first) / _SUN_STEP), 1) + 1)
    return np.interp(moments, some, [sun.position(run, float(time))[1] for time in some])
