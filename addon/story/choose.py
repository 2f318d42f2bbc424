"""Choice of a storyboard from a run, in seconds: each shot, or the reason why the run cannot give it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from datetime import timedelta
from functools import cached_property
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ..auto_framing import window
from ..run import areas, citations, labels, sun, times, zone
from ..run.labels import Label
from ..shot.sections import Time
from ..stations import fire_arrival
from .storyboard import ABOVE, CARD, FLIGHT, GLOBE, GROUND, MAP, Omission, Storyboard, StoryShot

_NEAR = 10.0  # km of a named place from burned ground, within which a camera at the place shows the fire
_PACE = re.compile(r"; \d+ frames, [\d.,]+ times real time")
_SUNRISE = 0.0  # degrees, elevation of the sun above which there is daylight
_SUN_STEP = 1800.0  # s between solar elevations
_LIMITS = "Simulated. Not for operational use."
_CREDITS = ("fire model", "observations", "software")
_LENGTHS = {  # s
    "title": 5.0,
    "place": 6.0,
    "growth": 20.0,
    "arrival": 6.0,
    "active": 8.0,
    "infrared": 8.0,
    "ground": 6.0,
    "scar": 5.0,
    "end": 6.0,
}

Choice = StoryShot | Omission


@dataclass(frozen=True)
class _Subject:
    """The run of a story, with facts for several shots."""

    run: Run
    places: list[Label]

    @property
    def first(self) -> float:
        """First model time, s."""
        return float(self.run.times[0])

    @property
    def last(self) -> float:
        """Last model time, s."""
        return float(self.run.times[-1])

    @cached_property
    def zone(self) -> str:
        """Time zone of the run."""
        return zone.time_zone(self.run)

    @cached_property
    def still(self) -> str:
        """Return why no shot can show the fire; "" if one can."""
        if self.last <= self.first:
            return "the run has one time"
        with np.errstate(invalid="ignore"):
            arrival = self.run.fuel_arrival_time()
            burns = np.any((arrival >= self.first) & (arrival <= self.last))
        return "" if burns else "nothing burns in the run"

    @cached_property
    def bright(self) -> float:
        """Model time of the highest sun in the run's first day, s."""
        sampled = np.arange(self.first, min(self.last, self.first + 86400.0) + 1.0, _SUN_STEP)
        return float(max(sampled, key=lambda time: sun.position(self.run, float(time))[1]))

    @cached_property
    def window(self) -> tuple[float, float, str]:
        """Start of the most active part (s), its speed (times real time), and its description."""
        chosen, words = window.choose(self.run, Time(frames=window.FRAMES, fps=window.FPS))
        assert chosen.start  # as something burns
        assert chosen.end
        span = (chosen.end - chosen.start).total_seconds()
        speed = span * window.FPS / (window.FRAMES - 1)
        return times.seconds(self.run, chosen.start), speed, _PACE.sub("", words)

    def shot(self, name: str, start: float = 0.0, end: float = 0.0, **keys: object) -> StoryShot:
        """Make a shot between two model times (s), moved into the run; without times if both are 0."""
        moments = {}
        if end > start:
            length = min(end - start, self.last - self.first)
            start = float(np.clip(start, self.first, self.last - length))
            begin = times.utc(self.run, start)
            moments = {"start": begin, "end": begin + timedelta(seconds=length)}
        return StoryShot(name, seconds=_LENGTHS[name], **moments, **keys)  # type: ignore[arg-type]

    def activity(self) -> tuple[float, float]:
        """Model times (s) of the active shot."""
        start, speed, _ = self.window
        end = min(start + speed * _LENGTHS["active"], self.last)
        return max(end - speed * _LENGTHS["active"], self.first), end


def choose(
    run: Run, path: Path, scene: Path | None = None, places: Path | None = None, units: str = "us"
) -> Storyboard:
    """Choose the storyboard of a run, for the story file `path`.

    Parameters
    ----------
    scene
        Scene file whose settings apply.
    places
        Named places; by default the places of the run's fire.
    """
    subject = _Subject(run, labels.find(run, places))
    choices = [part(subject) for part in _PARTS]
    return Storyboard(
        path,
        Path(run.path),
        scene,
        subject.zone,
        units,
        shots=tuple(each for each in choices if isinstance(each, StoryShot)),
        omitted=tuple(each for each in choices if isinstance(each, Omission)),
    )


def name_of(run: Run) -> str:
    """Return the name of a run, with the word "synthetic" if it is."""
    return f"{run.name} (synthetic)" if run.synthetic and "synthetic" not in run.name.lower() else run.name


def _title(subject: _Subject) -> Choice:
    run = subject.run
    first, last = (times.text(times.utc(run, at), subject.zone) for at in (subject.first, subject.last))
    latitude, longitude = sun.middle(run)
    longitude = float(areas.turned(longitude, 0.0))
    at = f"{abs(latitude):.2f}° {'NS'[latitude < 0]}, {abs(longitude):.2f}° {'EW'[longitude < 0]}"
    model = "Synthetic run" if run.synthetic else f"Model: {citations.model_name(run) or 'not named'}"
    caption = "\n".join([name_of(run), at, f"{first} to {last}", model])
    return subject.shot("title", picture=CARD, caption=caption, reason="names the fire, its place and times")


def _place(subject: _Subject) -> Choice:
    if subject.last <= subject.first:
        return Omission("place", subject.still)
    start = subject.bright
    reason = f"shows where on the Earth the fire is{_light(subject, start)}"
    return subject.shot(
        "place",
        start,
        start + _LENGTHS["place"],
        camera=GLOBE,
        smoke=False,
        caption="The place",
        reason=reason,
    )


def _growth(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("growth", subject.still)
    reason = "shows all of the run as a time-lapse"
    caption = "Growth, by hour of arrival"
    return subject.shot("growth", subject.first, subject.last, picture=MAP, caption=caption, reason=reason)


def _arrival(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("arrival", subject.still)
    start, _ = subject.activity()
    begin = start - subject.window[1] * _LENGTHS["arrival"]
    if begin < subject.first:
        return Omission("arrival", "the most active minutes are at the beginning of the run")
    reason = "flies to the front, in the minutes before the most active ones"
    return subject.shot("arrival", begin, start, camera=FLIGHT, caption="To the front", reason=reason)


def _active(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("active", subject.still)
    start, end = subject.activity()
    reason = f"has {subject.window[2]}"
    light = _light(subject, 0.5 * (start + end))
    caption = f"The most active minutes{light}, from a drone"
    return subject.shot("active", start, end, camera="chase", caption=caption, reason=reason)


def _infrared(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("infrared", subject.still)
    caption, reason = "The same minutes in infrared", "shows heat that smoke hides from the eye"
    start, end = subject.activity()
    return subject.shot(
        "infrared", start, end, camera="chase", render_pass="thermal", caption=caption, reason=reason
    )


def _ground(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("ground", subject.still)
    towns = [each for each in subject.places if each.kind in ("town", "")]
    if not towns:
        return Omission("ground", "no town or station has a name; a list of places gives them (labels.file)")
    latitude, longitude = ([getattr(each, axis) for each in towns] for axis in ("latitude", "longitude"))
    fire = fire_arrival.sample(subject.run, latitude, longitude)
    away = np.where(fire.nearest_time >= subject.first, fire.nearest_km, np.inf)
    nearest = int(np.argmin(np.nan_to_num(away, nan=np.inf)))
    if not away[nearest] <= _NEAR:
        return Omission("ground", f"no named place is within {_NEAR:g} km of the ground that burns")
    name, reaches = towns[nearest].name, away[nearest] == 0.0
    end = float(fire.nearest_time[nearest])
    event = "the fire reaches it" if reaches else f"the fire comes within {away[nearest]:.1f} km"
    start = end - subject.window[1] * _LENGTHS["ground"]
    return subject.shot(
        "ground", start, end, camera=GROUND, place=name, caption=f"From {name}", reason=f"shows how {event}"
    )


def _scar(subject: _Subject) -> Choice:
    if subject.still:
        return Omission("scar", subject.still)
    caption, start = "Burned ground at the end of the run", subject.last - _LENGTHS["scar"]
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


def _end(subject: _Subject) -> Choice:
    rows = [row for row in citations.of_run(subject.run) if row["kind"] in _CREDITS]
    sources = [f"{row['kind'].capitalize()}: {row['text']}" for row in rows]
    caption = "\n".join([_LIMITS, *sources, "All sources: firetwin cite"])
    return subject.shot("end", picture=CARD, caption=caption, reason="names sources and limits")


def _light(subject: _Subject, time: float) -> str:
    return " by daylight" if sun.position(subject.run, time)[1] > _SUNRISE else " by night"


_PARTS: tuple[Callable[[_Subject], Choice], ...] = (
    _title,
    _place,
    _growth,
    _arrival,
    _active,
    _infrared,
    _ground,
    _scar,
    _end,
)
