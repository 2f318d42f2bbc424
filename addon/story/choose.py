"""Choice of a storyboard from a run, in seconds: each shot, or the reason why the run cannot give it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ..run import areas, burning, citations, info, sun, times
from ..shot.fire import smoke_scale
from ..shot.settings import Settings, scene_file
from . import evidence, report
from .storyboard import ABOVE, CARD, FLIGHT, FRONT, GLOBE, GROUND, MAP, NEAR, Omission, Storyboard, StoryShot
from .subject import LENGTHS, NEAR_TOWN, Choice, Subject

_DARK = -6.0  # degrees, elevation of the sun below which flames light the picture: civil dusk
_BY_TIME = "arrival", "flames", "active", "infrared", "night", "ground"
_SUNRISE = 0.0  # degrees, elevation of the sun above which there is daylight
_LONG = 3.0 * 3600.0  # s, shortest run with a time-lapse of its hours
_LIMITS = "Simulated. Not for operational use."
_ASSUMED = 4  # assumptions of the run at most, on the last card
_CREDITS = ("fire model", "observations", "software")


def choose(
    run: Run,
    path: Path,
    scene: Path | None = None,
    places: Path | None = None,
    units: str = "us",
    lapse: bool = False,
) -> Storyboard:
    """Choose the storyboard of a run, for the story file `path`.

    Parameters
    ----------
    scene
        Scene file whose settings apply.
    places
        Named places; by default the places of the scene file, or of the run's fire.
    lapse
        Add the time-lapse with smoke, which takes minutes.
    """
    settings = scene_file.read(scene) if scene else Settings(path=path, run=Path(run.path))
    if places:
        settings = replace(settings, labels=replace(settings.labels, file=places))
    subject = Subject(run, settings, path.parent / "cache", lapse)
    choices = [
        Omission(name, subject.still) if subject.still and name not in _WITHOUT_FIRE else part(subject)
        for name, part in _PARTS.items()
    ]
    return Storyboard(
        path,
        Path(run.path),
        scene,
        subject.zone,
        units,
        shots=_in_order([each for each in choices if isinstance(each, StoryShot)]),
        omitted=tuple(each for each in choices if isinstance(each, Omission)),
    )


def _in_order(shots: list[StoryShot]) -> tuple[StoryShot, ...]:
    """Order the shots of the fire by time; a flight is before the shot that begins where it ends."""
    own = [shot for shot in shots if shot.name in _BY_TIME]
    by_time = iter(sorted(own, key=_begins))
    return tuple(next(by_time) if shot.name in _BY_TIME else shot for shot in shots)


def _begins(shot: StoryShot) -> datetime:
    """Return the start of a shot, or the end of a flight."""
    moment = shot.end if shot.camera == FLIGHT else shot.start
    assert moment
    return moment


def name_of(run: Run) -> str:
    """Return the name of a run, with the word "synthetic" if it is."""
    return f"{run.name} (synthetic)" if run.synthetic and "synthetic" not in run.name.lower() else run.name


def _title(subject: Subject) -> Choice:
    run = subject.run
    first, last = (times.text(times.utc(run, at), subject.zone) for at in (subject.first, subject.last))
    latitude, longitude = sun.middle(run)
    longitude = float(areas.turned(longitude, 0.0))
    at = f"{abs(latitude):.2f}° {'NS'[latitude < 0]}, {abs(longitude):.2f}° {'EW'[longitude < 0]}"
    model = "Synthetic run" if run.synthetic else f"Model: {citations.model_name(run) or 'not named'}"
    caption = "\n".join([name_of(run), at, f"{first} to {last}", model])
    return subject.shot("title", picture=CARD, caption=caption, reason="names the fire, its place and times")


def _place(subject: Subject) -> Choice:
    if subject.last <= subject.first:
        return Omission("place", subject.still)
    start = subject.bright
    reason = f"shows where on the Earth the fire is{_light(subject, start)}"
    near = None if subject.still else subject.nearest_town
    return subject.shot(
        "place",
        start,
        start + LENGTHS["place"],
        camera=GLOBE,
        smoke=False,
        caption="The place" + (f" near {near[0].name}" if near else ""),
        reason=reason,
    )


def _growth(subject: Subject) -> Choice:
    reason = "shows all of the run as a time-lapse"
    with np.errstate(invalid="ignore"):
        before = np.any(subject.run.fuel_arrival_time() < subject.first)
    caption = "Growth, by hour of arrival" + " (grey: burned before)" * bool(before)
    return subject.shot("growth", subject.first, subject.last, picture=MAP, caption=caption, reason=reason)


def _lapse(subject: Subject) -> Choice:
    if subject.last - subject.first < _LONG:
        return Omission("lapse", f"the run is shorter than {_LONG / 3600.0:g} hours")
    if not smoke_scale.resolves_plume(max(burning.fuel_cell(subject.run))):
        return Omission("lapse", "the fuel cells are too wide for smoke")
    if not subject.lapse:
        return Omission("lapse", "its smoke takes minutes of processor time (--time-lapse adds it)")
    return subject.shot(
        "lapse",
        subject.first,
        subject.last,
        camera="overview",
        caption="All hours of the fire, with smoke",
        reason="shows how smoke and light change with the hours",
    )


def _arrival(subject: Subject) -> Choice:
    start = subject.flames.start if subject.flames else subject.activity()[0]
    begin = start - subject.window[1] * LENGTHS["arrival"]
    if begin < subject.first:
        return Omission("arrival", "the first shot of the front is at the beginning of the run")
    reason = "flies to the front, in the minutes before the next shot"
    return subject.shot("arrival", begin, start, camera=FLIGHT, caption="To the front", reason=reason)


def _active(subject: Subject) -> Choice:
    start, end = subject.activity()
    reason = f"has {subject.window[2]}"
    light = _light(subject, 0.5 * (start + end))
    caption = f"The most active minutes{light}, from a drone"
    return subject.shot("active", start, end, camera=FRONT, caption=caption, reason=reason)


def _infrared(subject: Subject) -> Choice:
    active = _active(subject)
    assert isinstance(active, StoryShot)
    return replace(
        active,
        name="infrared",
        render_pass="thermal",
        wipe_from=active.name,
        caption="The same minutes: colour, and infrared at right",
        reason="shows heat that smoke hides from the eye",
    )


def _flames(subject: Subject) -> Choice:
    near = subject.flames
    if near is None:
        return Omission("flames", "no camera has a clear view of flames from nearby")
    words = f"{near.kind.words} {near.light.words}"
    return subject.shot(
        "flames",
        near.start,
        near.start + LENGTHS["flames"],
        camera=NEAR,
        caption=f"{words[:1].upper()}{words[1:]}, from {near.distance:.0f} m",
        reason=f"shows flames of a {near.kind.words} where a camera sees them clearly, in real time",
    )


def _night(subject: Subject) -> Choice:
    start, end = subject.peak
    if sun.position(subject.run, end)[1] > _DARK or start == subject.activity()[0]:
        return Omission("night", "the most active minutes of the run are in another shot, or by daylight")
    reason = "has the most active minutes of the run, which are by night"
    caption = "The most active minutes of all, by night"
    return subject.shot("night", start, end, camera=FRONT, caption=caption, reason=reason)


def _ground(subject: Subject) -> Choice:
    if not subject.towns:
        return Omission("ground", "no town or station has a name; a list of places gives them (labels.file)")
    if not subject.nearest_town:
        return Omission("ground", f"no named place is within {NEAR_TOWN:g} km of the ground that burns")
    town, away, end = subject.nearest_town
    event = f"the fire comes within {away:.1f} km" if away else "the fire reaches it"
    start = end - subject.window[1] * LENGTHS["ground"]
    return subject.shot(
        "ground",
        start,
        end,
        camera=GROUND,
        place=town.name,
        caption=f"From {town.name}",
        reason=f"shows how {event}",
    )


def _scar(subject: Subject) -> Choice:
    caption, start = "Burned ground at the end of the run", subject.last - LENGTHS["scar"]
    dark = sun.position(subject.run, subject.last)[1] <= _SUNRISE
    reason = "shows the burned ground without smoke" + ", by its heat, as it is night" * dark
    return subject.shot(
        "scar",
        start,
        subject.last,
        camera=ABOVE,
        render_pass="thermal" if dark else "rgb",
        smoke=False,
        caption=caption + ", in infrared" * dark,
        reason=reason,
    )


def _end(subject: Subject) -> Choice:
    run = subject.run
    assumed = [f"Assumed {text}" for text in info.source(Path(run.path)).get("assumptions", [])]
    left_out = "fire model" if run.synthetic and assumed else ""  # the assumptions say more
    rows = [row for row in citations.of_run(run) if row["kind"] in _CREDITS and row["kind"] != left_out]
    sources = [f"{row['kind'].capitalize()}: {row['text'].removesuffix(' (CITATION.cff)')}" for row in rows]
    areas_from = f"Burned areas: {report.area_source(run)}"
    caption = "\n".join([_LIMITS, *assumed[:_ASSUMED], areas_from, *sources])
    return subject.shot("end", picture=CARD, caption=caption, reason="names sources and limits")


def _light(subject: Subject, time: float) -> str:
    return " by daylight" if sun.position(subject.run, time)[1] > _SUNRISE else " by night"


_WITHOUT_FIRE = {"title", "place", "end"}
_PARTS: dict[str, Callable[[Subject], Choice]] = {
    "title": _title,
    "place": _place,
    "growth": _growth,
    "satellite": evidence.choose_satellite,
    "lapse": _lapse,
    "arrival": _arrival,
    "flames": _flames,
    "active": _active,
    "infrared": _infrared,
    "night": _night,
    "ground": _ground,
    "perimeters": evidence.choose_perimeters,
    "what-if": evidence.choose_what_if,
    "forecast": evidence.choose_forecast,
    "scar": _scar,
    "end": _end,
}
"""Choices by the names of their shots; of a run in which nothing burns, those without fire."""
