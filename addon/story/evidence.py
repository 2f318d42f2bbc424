"""Shots of a story that compare: satellite imager, observed perimeters, other runs, members of a forecast."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from datetime import datetime, timedelta

import numpy as np
from firetwin_core.run import Run

from ..errors import InputError
from ..run import areas, observations, readers, sun, times
from ..shot import frames, scene_inputs
from ..shot.cameras.rigs.satellite import Satellite
from ..shot.satellites import imager
from ..shot.sections import Time
from ..shot.surface import observed
from .storyboard import ABOVE, GOES, Omission
from .subject import Choice, Subject

CADENCE = 600.0
"""s between pictures of the full disk by ABI, in its mode 6."""
_LOOP = 36, 4  # pictures of a loop at most, and at least
_PIXELS = 4  # pixels of the imager along the run's shorter side, at least
_SATELLITES = {"GOES West": -137.2, "GOES East": -75.2}  # degrees east
_AROUND = 0.1  # of the run, time before the first and after the last perimeter


def choose_satellite(subject: Subject) -> Choice:
    """Choose a loop of a geostationary imager, at its cadence, around the most active minutes."""
    run = subject.run
    if reason := _unseen(run):
        return Omission("satellite", reason)
    room = int((subject.last - subject.first) / CADENCE)
    if room < _LOOP[1]:
        return Omission(
            "satellite", f"the run is shorter than {_LOOP[1]} steps of the imager, of {CADENCE / 60:.0f} min"
        )
    length = (min(room, _LOOP[0]) - 1) * CADENCE
    active = np.mean(subject.activity())
    start = float(np.clip(active - 0.5 * length, subject.first, subject.last - length - CADENCE))
    after = times.utc(run, start).timestamp() % CADENCE
    start += (CADENCE - after) % CADENCE  # so that pictures are at its times of the clock
    name, longitude = goes(run)
    return subject.shot(
        "satellite",
        start,
        start + length,
        camera=GOES,
        render_pass="imager_short",
        smoke=False,
        step=CADENCE,
        caption=f"Simulated imager of {name}, every {CADENCE / 60:.0f} min",
        reason=f"shows the fire as an imager above {abs(longitude):g}° W would measure it, at its cadence",
    )


def goes(run: Run) -> tuple[str, float]:
    """Return name and longitude (degrees east) of the GOES satellite that is nearest to a run."""
    middle = float(areas.turned(sun.middle(run)[1], 0.0))
    return min(_SATELLITES.items(), key=lambda each: abs(float(areas.turned(each[1], middle)) - middle))


def _unseen(run: Run) -> str:
    """Return why no GOES imager shows a run; "" if one does."""
    name, longitude = goes(run)
    moment = frames.Frames(float(run.times[0]), float(run.times[0]), 1)
    if Satellite(geostationary=longitude).validate_against(run, moment):
        return "no GOES satellite sees the fire"
    try:
        sides = imager.pixels_inside(imager.grid_of(imager.ABI, run, longitude), run)
    except imager.NothingSeenError as error:
        return f"{error} ({name})"
    if (least := min(map(len, sides))) < _PIXELS:
        return f"the run is {least} pixels of the imager wide ({name})"
    return ""


def choose_perimeters(subject: Subject) -> Choice:
    """Choose the burned ground with observed perimeters, around their times."""
    paths = observed.files(subject.settings) or observations.beside(subject.run.path)
    if not paths:
        return Omission("perimeters", "no perimeter was observed (fire.observed, or RUN/observations)")
    every = [each.time for each in observations.read(paths).perimeters]
    moments = [time for time in (times.seconds(subject.run, each) for each in every) if subject.has(time)]
    if not moments:
        return Omission("perimeters", "no observed perimeter has a time of the run")
    room = _AROUND * (subject.last - subject.first)
    return subject.shot(
        "perimeters",
        max(moments[0] - room, subject.first),
        min(moments[-1] + room, subject.last),
        camera=ABOVE,
        smoke=False,
        observed=True,
        caption="Observed perimeters (lines), simulated fire",
        reason=f"compares the run with {len(moments)} observed perimeter{'s' * (len(moments) > 1)}",
    )


def choose_what_if(subject: Subject) -> Choice:
    """Choose the difference to the other runs of the scene file."""
    if not subject.settings.runs:
        return Omission("what-if", "the scene file has no other run ([[runs]])")
    names = ", ".join(each.name for each in subject.settings.runs)
    common = _common(subject, (_span(readers.open(each.path)) for each in subject.settings.runs))
    if common is None:
        return Omission("what-if", f"the run has no time in common with {names}")
    return subject.shot(
        "what-if",
        *common,
        camera=ABOVE,
        render_pass="difference",
        smoke=False,
        caption="Another run: ground that burns in one only",
        reason=f"compares the run with {names}",
    )


def choose_forecast(subject: Subject) -> Choice:
    """Choose the share of a forecast's members that have burned the ground, by time."""
    settings, run = subject.settings, subject.run
    if settings.forecast.ensemble is None:
        return Omission("forecast", "the scene file names no ensemble ([forecast])")
    try:
        common = _common(subject, scene_inputs.windows(settings))
        if common is None:
            return Omission("forecast", "the run has no time in common with the forecast")
        begin, end = (times.utc(run, time) for time in common)
        scene_inputs.check(replace(settings, time=Time(begin, end, 2)), run)
    except InputError as error:
        return Omission("forecast", str(error))
    return subject.shot(
        "forecast",
        *common,
        camera=ABOVE,
        render_pass="forecast",
        smoke=False,
        caption="Forecast: how many members burn the ground",
        reason="shows how sure the forecast is, of which ground, and by when",
    )


def _span(run: Run) -> tuple[datetime, datetime]:
    return times.utc(run, float(run.times[0])), times.utc(run, float(run.times[-1]))


def _common(subject: Subject, spans: Iterable[tuple[datetime, datetime]]) -> tuple[float, float] | None:
    """Return the model times (s) that the run and all spans (UTC) have; None without any."""
    starts, ends = zip(_span(subject.run), *spans, strict=True)
    begin, end = max(starts), min(ends)
    if end - begin <= timedelta(0):
        return None
    return times.seconds(subject.run, begin), times.seconds(subject.run, end)
