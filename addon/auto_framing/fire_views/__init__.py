"""Fire views: short clips of one kind of fire, from several distances, as a scene file for each kind.

`firetwin new --views` writes them. Places and moments come from the run's arrival times, fuel, terrain and
wind; trees and flames are those that the shot will draw.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from firetwin_core.run import Run

from ...run import readers
from ...shot.settings import Camera
from . import places, search
from .kinds import KINDS, LIGHTS, FireKind, LightOfDay
from .scene_text import camera, scene_text

_FARTHEST = 400.0  # m, of the single view
_TALLEST_FIRST = sorted(KINDS, key=lambda kind: kind.name != "crown")  # then torching, surface, grass


@dataclass(frozen=True)
class FireView:
    """Scene file of one kind of fire by one light; `text` is empty if the run has none, and `words` say so.

    Attributes
    ----------
    name
        File name: ``fire_crown_night.toml``.
    """

    name: str
    text: str
    words: str


def names() -> list[str]:
    """File names of all views."""
    return [f"fire_{kind.name}{light.suffix}.toml" for kind in KINDS for light in LIGHTS]


def find_views(
    folder: Path, out: Path, cache: Path, asked: tuple[datetime | None, datetime | None] = (None, None)
) -> Iterator[FireView]:
    """Find the views of a run in a folder, for scene files in the folder `out`, in the requested times.

    Raises
    ------
    InputError
        There is something wrong with the run.
    """
    run = readers.open(folder)
    survey = places.survey(run, folder, cache, asked)
    for kind in KINDS:
        for light in LIGHTS:
            yield _find_view(run, survey, kind, light, out)


def _find_view(run: Run, survey: places.Survey, kind: FireKind, light: LightOfDay, out: Path) -> FireView:
    name = f"fire_{kind.name}{light.suffix}.toml"
    best = search.find_clip(survey, kind, light)
    if best is None:
        return FireView(
            name, "", f"{name}: left out, as the run has no {kind.words} {light.words} with a clear view"
        )
    text = scene_text(run, survey.shot.settings, kind, best, out / name)
    cameras = ", ".join(f"{placed.distance:,.0f} m" for placed in best.placed)
    return FireView(name, text, f"{name}: {kind.words} {light.words}, from {cameras}")


@dataclass(frozen=True)
class NearView:
    """View of flames from nearby: its kind and light, start (model time, s), camera, and its distance (m)."""

    kind: FireKind
    light: LightOfDay
    start: float
    camera: Camera
    distance: float


def find_near_view(
    run: Run, cache: Path, asked: tuple[datetime | None, datetime | None] = (None, None)
) -> NearView | None:
    """Find a view of the tallest kind of flames in the requested times, if possible by day."""
    survey = places.survey(run, Path(run.path), cache, asked)
    for light, kind in itertools.product(LIGHTS, _TALLEST_FIRST):
        farthest = max(distance for distance in kind.distances if distance <= _FARTHEST)
        clip = search.find_clip(survey, replace(kind, distances=(farthest,)), light, judged=1)
        if clip:
            (view,) = clip.placed
            return NearView(kind, light, clip.fire.first, camera(run, kind, view), view.distance)
    return None
