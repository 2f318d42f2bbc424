"""Observed fire (`fire.observed`): perimeters, detections and infrared heat, draped on the terrain.

A perimeter appears at its date and fades at the date of its file's next one. A satellite detection is a
square of its pixel size, shown for twelve hours: the longest gap between day and night overpasses. Heat of an
infrared flight is shown until the next flight or for a day, as flights are nightly. Sources too small for a
polygon are circles.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...progress import Progress, silent
from ...run import areas, content, observations, times
from ..schema import scene_text
from ..settings import Settings

if TYPE_CHECKING:
    from ..shot import Shot

ABOVE = 25.0  # m over the ground, above most crowns, which would occlude the lines
FOREVER = 1e12  # s
_DETECTION_TIME = 12 * 3600.0  # s, display time of a detection
_HEAT_TIME = 24 * 3600.0  # s, display time of an infrared flight's heat
_SOURCE = 30.0  # m, least radius of the circle around an isolated heat source
_MAX_POINTS = 60_000  # points of a perimeter at most
_STEP = 20.0  # m between points, so that lines follow the terrain


@dataclass(frozen=True)
class DrapedLine:
    """A closed line: points (n, 3) in the scene (m), and model times (s) of its start, fade and end.

    `kind` is one of `infrared_detections.KINDS`; it is "" for perimeters and satellite pixels.
    """

    points: NDArray[np.float64]
    start: float
    fades: float
    end: float
    kind: str = ""


def files(settings: Settings) -> list[Path]:
    """Observation files: the named file, or all files of the named folder."""
    path = settings.fire.observed
    if path is None:
        return []
    if not path.is_dir():
        return [path]
    return observations.inside(path)


def check(settings: Settings) -> None:
    """Check that observation files exist and can be read.

    Raises
    ------
    InputError
        Names the file and what to do.
    """
    if settings.fire.observed is not None and not files(settings):
        raise scene_text.error_at(
            settings.path, ("fire", "observed"), "fire.observed is a folder without observations"
        )
    try:
        observations.read(files(settings))
    except InputError as error:
        if not settings.path.is_file():
            raise
        raise scene_text.error_at(settings.path, ("fire", "observed"), f"fire.observed: {error}") from None


def inputs(settings: Settings, progress: Progress = silent) -> dict[str, str]:
    """SHA-256 of each observation file."""
    return {
        f"observed {path.name}": content.of_file(path, settings.cache, progress) for path in files(settings)
    }


def lines(shot: Shot) -> list[DrapedLine]:
    """All lines in order of their start times."""
    observed = observations.read(files(shot.settings))
    every = [*_perimeters(shot, observed), *_pixels(shot, observed), *_heat(shot, observed)]
    return sorted(every, key=lambda line: line.start)


def _perimeters(shot: Shot, observed: observations.Observations) -> Iterator[DrapedLine]:
    for i, perimeter in enumerate(observed.perimeters):
        later = (
            p.time
            for p in observed.perimeters[i + 1 :]
            if p.time > perimeter.time and p.source == perimeter.source
        )
        after = next(later, None)
        fades = FOREVER if after is None else times.seconds(shot.run, after)
        start = times.seconds(shot.run, perimeter.time)
        rings = [ring for polygon in perimeter.polygons for ring in polygon]
        step = max(_STEP, sum(_length(ring) for ring in rings) / _MAX_POINTS)
        for ring in rings:
            yield DrapedLine(_draped(shot, ring, step), start, fades, FOREVER)


def _heat(shot: Shot, observed: observations.Observations) -> Iterator[DrapedLine]:
    radius = max(_SOURCE, 1.5 * shot.settings.fire.observed_width)
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    for heat in observed.heat:
        start = times.seconds(shot.run, heat.time)
        later = [times.seconds(shot.run, h.time) for h in observed.heat if h.time > heat.time]
        end = min([start + _HEAT_TIME, *later])
        rings = [ring for polygon in heat.polygons for ring in polygon]
        for longitude, latitude in heat.points:
            north, east = areas.metres_per_degree(latitude)
            x, y = longitude + radius * np.cos(turn) / east, latitude + radius * np.sin(turn) / north
            rings.append(np.column_stack([x, y]))
        step = max(_STEP, sum(_length(ring) for ring in rings) / _MAX_POINTS)
        for ring in rings:
            yield DrapedLine(_draped(shot, ring, step), start, end, end, heat.kind)


def _pixels(shot: Shot, observed: observations.Observations) -> Iterator[DrapedLine]:
    for detection in observed.detections:
        for time, latitude, longitude, size in zip(
            detection.time, detection.latitude, detection.longitude, detection.size, strict=True
        ):
            north, east = areas.metres_per_degree(latitude)
            x, y = (
                np.array([-0.5, 0.5, 0.5, -0.5]) * size / east,
                np.array([-0.5, -0.5, 0.5, 0.5]) * size / north,
            )
            ring = np.column_stack([longitude + x, latitude + y])
            start = times.seconds(shot.run, time)
            yield DrapedLine(
                _draped(shot, ring, _STEP), start, start + _DETECTION_TIME, start + _DETECTION_TIME
            )


def _metres(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Side lengths (n,) of a ring, m."""
    north, east = areas.metres_per_degree(float(ring[:, 1].mean()))
    return np.hypot(*((np.roll(ring, -1, axis=0) - ring) * [east, north]).T)


def _length(ring: NDArray[np.float64]) -> float:
    return float(_metres(ring).sum())


def _draped(shot: Shot, ring: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Drape a ring (degrees) on the terrain: points (n, 3), at most `step` m apart, above the ground."""
    counts = np.maximum(np.ceil(_metres(ring) / step), 1).astype(int)
    side = np.repeat(np.arange(len(ring)), counts)
    along = np.concatenate([np.arange(count) / count for count in counts])
    place = ring[side] + (np.roll(ring, -1, axis=0) - ring)[side] * along[:, None]
    middle = float(shot.run.longitude[0] + shot.run.longitude[-1]) / 2
    return shot.ground.point(place[:, 1], areas.turned(place[:, 0], middle), ABOVE)
