"""Search of a clip: the place and moment at which most cameras see the fire, and see most of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...shot.fire import flame_phase
from ..coarse_smoke import CoarseSmoke
from . import placing
from .kinds import FireKind, LightOfDay
from .local_fire import LocalFire
from .places import Survey, candidates, with_own_smoke
from .placing import PlacedView

_AFTER = 0.4  # of the time at full height, after which the clip begins
_REACH = (10.0, 6.0, 250.0)  # m around the place in which flames count: least, flame lengths, most
_GROWN = 0.5  # of the cell's flame length, that flames at the place must have; lower ones are at a gap
_FULL = 0.3  # of a torching crown's time, at which it is in full flame
_TORCHES = 3  # crowns that are tried at a place
_TORCH_REACH = 40.0  # m around the place
_GOOD = 0.7  # score of every camera at which the search ends
_SMOKY = 100.0  # m, distance of cameras that are placed in solved smoke; its cells are wider than less
_JUDGED = 5  # clips whose smoke is solved

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Clip:
    """A clip: its fire, the aims (n, 2) of cameras, height of flames (m), and cameras, the nearest first."""

    fire: LocalFire
    aims: Array
    flame: float
    placed: list[PlacedView]

    @property
    def rating(self) -> float:
        """Rating: number of cameras that see the fire, plus the sum of their scores."""
        return sum(view.score for view in self.placed) + len(self.placed)


def find_clip(survey: Survey, kind: FireKind, light: LightOfDay, judged: int = _JUDGED) -> Clip | None:
    """Find the best clip of a kind of fire in a light; None if no camera has a clear view.

    Parameters
    ----------
    judged
        Clips whose smoke is solved, which takes seconds each.
    """
    clips: list[Clip] = []
    for row, column in candidates(survey, kind, light):
        clips += [clip for clip in _clips(survey, kind, row, column) if clip.placed]
        if sum(_is_good(clip, kind) for clip in clips) >= (judged if _far(kind) else 1):
            break
    clips.sort(key=lambda clip: -clip.rating)
    if _far(kind):
        clips = [_judged(clip, kind) for clip in clips[:judged]]
        clips = sorted((clip for clip in clips if clip.placed), key=lambda clip: -clip.rating)
    return clips[0] if clips else None


def _is_good(clip: Clip, kind: FireKind) -> bool:
    """Return whether all cameras of a clip see the fire well."""
    return len(clip.placed) == len(kind.distances) and min(view.score for view in clip.placed) >= _GOOD


def _far(kind: FireKind) -> list[float]:
    """Distances of a kind, m, at which smoke is between cameras and flames."""
    return [distance for distance in kind.distances if distance >= _SMOKY]


def _judged(clip: Clip, kind: FireKind) -> Clip:
    """Place the far cameras of a clip again, in smoke solved on wide cells."""
    smoke = CoarseSmoke(with_own_smoke(clip.fire.shot), [0])
    placed = [view for view in clip.placed if view.distance < _SMOKY]
    for distance in _far(kind):
        view = placing.place(clip.fire, clip.aims, clip.flame, distance, kind, smoke)
        placed += [view] if view is not None else []
    return replace(clip, placed=placed)


def _clips(survey: Survey, kind: FireKind, row: int, column: int) -> Iterator[Clip]:
    """Clips of the fire in a cell."""
    ground, length = survey.ground, float(survey.cells.length[row, column])
    centre = ground.point(*ground.places(float(row), float(column)))[0, :2]
    arrival = float(ground.burn_time[row, column])
    if not kind.torches:
        front = survey.shot.front
        tall, _ = flame_phase.times(
            front.speed[row, column], front.residence[row, column], np.asarray(length)
        )
        fire = LocalFire(survey.clip(arrival + _AFTER * float(tall)), centre)
        reach = float(np.clip(_REACH[1] * length, _REACH[0], _REACH[2]))
        aims, flame = fire.tall_flames(reach)
        if flame >= _GROWN * length:
            yield _clip(fire, aims, flame, kind)
        return
    near = LocalFire(survey.clip(arrival), centre)
    torches = near.torches
    away = np.hypot(*(torches.position[:, :2] - centre).T)
    close = np.flatnonzero(away < _TORCH_REACH)
    for at in close[np.argsort(-torches.length[close], kind="stable")][:_TORCHES]:
        start = float(torches.arrival_time[at] + _FULL * torches.residence[at])
        if not survey.first <= start <= survey.last:
            continue
        fire = LocalFire(survey.clip(start), torches.position[at, :2])
        yield _clip(fire, fire.centre[None], float(torches.length[at]), kind)


def _clip(fire: LocalFire, aims: Array, flame: float, kind: FireKind) -> Clip:
    placed = []
    if len(aims):
        views = (placing.place(fire, aims, flame, distance, kind) for distance in kind.distances)
        placed = [view for view in views if view is not None]
    return Clip(fire, aims, flame, placed)
