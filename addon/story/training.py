"""Stories for training: the growth pauses at decisions, with a question, and then shows what happened.

Questions and answers have numbers of the run only, and name no person and no agency.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import timedelta
from typing import cast

import numpy as np
from firetwin_core.run import Run

from ..auto_framing import candidates
from ..ellipsoid import metres_per_degree
from ..html_text import quote
from ..progress import duration
from ..run import areas, burning, info, measure, times
from ..run.labels import Label
from ..run.measure import Units
from ..stations import fire_arrival
from .captions import clocks
from .storyboard import CARD, Omission, Storyboard, StoryShot
from .timeline import Span

QUESTION, ANSWER, GROWTH = "decision", "answer", "growth"
_SHARES = (0.1, 0.35, 0.65)  # of the area that burns in the run, at the decisions
_STEPS = 288  # times of the run at which areas are computed
_ROUND = 600.0  # s; decisions are at round times in runs of more than `_LONG`
_LONG = 4.0 * 3600.0  # s
_HOUR = 3600.0
_READING = 10.0, 6.0  # s that a question and an answer stay
_LEAST = 3.0  # s, least length of a part of the growth
_NAMED = 3  # most places of a question


@dataclass(frozen=True)
class _Fire:
    """Burned areas of a run by time, and its named places."""

    run: Run
    zone: str
    units: Units
    places: Sequence[Label]

    def area(self, *moments: float) -> list[float]:
        """Return burned areas, m2."""
        return info.burned(self.run, moments)

    def clock(self, time: float) -> str:
        """Format a model time, s."""
        return clocks(times.utc(self.run, time), self.zone)

    def decisions(self) -> list[float]:
        """Choose model times (s) at which shares of the area have burned."""
        first, last = float(self.run.times[0]), float(self.run.times[-1])
        moments = np.linspace(first, last, _STEPS)
        burned = np.array(self.area(*moments))
        if burned[-1] <= burned[0]:
            return []
        gained = (burned - burned[0]) / (burned[-1] - burned[0])
        chosen = [float(np.interp(share, gained, moments)) for share in _SHARES]
        step = _ROUND if last - first > _LONG else 1.0
        rounded = sorted({step * round(time / step) for time in chosen})
        return [time for time in rounded if first < time < last]

    def places_near(self, time: float) -> list[tuple[Label, float]]:
        """Return the nearest places that have not burned by a model time (s), with distances, km."""
        run, arrival = self.run, self.run.fuel_arrival_time()
        with np.errstate(invalid="ignore"):
            row, column = np.nonzero(arrival <= time)
        if not len(row):
            return []
        distances = []
        for place in self.places:
            north, east = metres_per_degree(place.latitude)
            longitude = areas.turned(run.fuel_longitude[column], place.longitude)
            away = np.hypot(
                (run.fuel_latitude[row] - place.latitude) * north, (longitude - place.longitude) * east
            )
            distances.append((place, float(away.min()) / 1e3))
        unburned = [each for each in distances if each[1] > 0.0 and not self._arrives(each[0]) <= time]
        return sorted(unburned, key=lambda each: each[1])[:_NAMED]

    def _arrives(self, place: Label) -> float:
        """Return the arrival time at a place, s; infinite if the fire does not arrive."""
        time = float(fire_arrival.sample(self.run, [place.latitude], [place.longitude]).time[0])
        return time if np.isfinite(time) else np.inf

    def question(self, number: int, time: float, until: float) -> str:
        """Write a question: the state of the fire at a model time, and the time to judge."""
        before, now = self.area(max(time - _HOUR, float(self.run.times[0])), time)
        near = self.places_near(time)
        lines = [f"Decision {number}", self.clock(time), f"Burned: {measure.area(now, self.units)}"]
        lines.append(f"Growth in the last hour: {measure.area(now - before, self.units)}")
        lines += self._wind(time)
        if near:
            lines.append("Nearest places: " + ", ".join(f"{each.name} {away:.1f} km" for each, away in near))
        asked = "How large is the fire" + (", and which of these places has it reached" if near else "")
        return "\n".join([*lines, f"{asked}, {duration(until - time)} later?"])

    def answer(self, number: int, time: float, until: float) -> str:
        """Write the answer to a question."""
        before, then = self.area(time, until)
        grown = f" ({100.0 * (then / before - 1.0):+.0f} %)" if before > 0.0 else ""
        lines = [f"Answer {number}", self.clock(until), f"Burned: {measure.area(then, self.units)}{grown}"]
        if near := self.places_near(time):
            reached = [(each, self._arrives(each)) for each, _ in near]
            names = [f"{each.name} at {self.clock(at)}" for each, at in reached if at <= until]
            lines.append(f"Reached: {', '.join(names) or 'none of these places'}")
        return "\n".join(lines)

    def _wind(self, time: float) -> Iterator[str]:
        """Describe the wind around the burned ground; nothing without wind data."""
        arrival = self.run.fuel_arrival_time()
        with np.errstate(invalid="ignore"):
            around = burning.surroundings(self.run, np.where(arrival <= time, arrival, np.nan))
        east, north = burning.wind_at(self.run, np.array([time]), around)[0]
        speed = float(np.hypot(east, north))
        if speed > 0.0:
            side = candidates.side(float(np.degrees(np.arctan2(-east, -north))))
            miles = measure.MILES_PER_HOUR
            yield f"Wind at the fire: {speed:.0f} m/s ({miles.format(speed)} {miles.name}) from the {side}"


def with_decisions(story: Storyboard, run: Run, places: Sequence[Label]) -> Storyboard:
    """Divide the growth of a storyboard at decisions, each with a question before and an answer after it."""
    fire = _Fire(run, story.zone, cast(Units, story.units), places)
    growth = next((shot for shot in story.shots if shot.name == GROWTH), None)
    if growth is None or not growth.start:
        return story
    shots, omitted = [], list(story.omitted)
    for shot in story.shots[: story.shots.index(growth)]:
        if shot.start and shot.start > growth.start:
            omitted.append(Omission(shot.name, "it shows a later time than the first decision"))
        else:
            shots.append(shot)
    shots += [*_divided(fire, growth), *story.shots[story.shots.index(growth) + 1 :]]
    return replace(story, shots=tuple(shots), omitted=tuple(omitted))


def _divided(fire: _Fire, growth: StoryShot) -> Iterator[StoryShot]:
    """Yield the parts of the growth, with questions and answers."""
    assert growth.start
    assert growth.end
    moments = fire.decisions()
    ends = [*moments, times.seconds(fire.run, growth.end)]
    whole, start = growth.end - growth.start, growth.start
    for number, end in enumerate(ends):
        stop = growth.start + timedelta(seconds=end - times.seconds(fire.run, growth.start))
        seconds = max(round(growth.seconds * ((stop - start) / whole), 1), _LEAST)
        shown = replace(growth, start=start, end=stop, seconds=seconds)
        yield replace(shown, name=f"{GROWTH}-{number + 1}", reason="shows the growth until the next decision")
        start = stop
        for kind, of, write, length in (
            (ANSWER, number, fire.answer, _READING[1]),
            (QUESTION, number + 1, fire.question, _READING[0]),
        ):
            if 1 <= of <= len(moments):
                caption = write(of, ends[of - 1], ends[of])
                reason = "asks before the film shows it" if kind == QUESTION else "answers the decision"
                yield StoryShot(f"{kind}-{of}", CARD, seconds=length, caption=caption, reason=reason)


def sheet(story: Storyboard, spans: Sequence[Span], run: Run) -> str:
    """Write the instructor's sheet as HTML: times in the film, questions and answers."""
    shown = [span for span in spans if span.shot.name.startswith((QUESTION, ANSWER))]
    rows = "".join(
        f"<tr><td>{(span.first - 1) / story.fps:.0f} s<td>"
        + "<br>".join(quote(line) for line in span.shot.caption.splitlines())
        for span in shown
    )
    title = quote(f"{run.name}: decisions")
    note = "Exercise. All numbers are computed from the run; nothing here is about real people or agencies."
    return (
        f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>\n'
        "<style>body{font:16px sans-serif;margin:2em}td{padding:.5em 1em;border-top:1px solid #888;"
        f"vertical-align:top}}</style>\n<h1>{title}</h1><p>{note}\n<table>{rows}</table></html>\n"
    )
