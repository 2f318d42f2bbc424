"""Subject of a story: its run and settings, with facts for several shots."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import timedelta
from functools import cached_property
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ..auto_framing import fire_views, window
from ..run import burning, labels, sun, times, zone
from ..run.labels import Label
from ..shot.fire import smoke_scale
from ..shot.sections import Time
from ..shot.settings import Settings
from ..stations import fire_arrival
from .storyboard import Omission, StoryShot

Choice = StoryShot | Omission

_PACE = re.compile(r"; \d+ frames, [\d.,]+ times real time")
_DAYLIGHT = 8.0, 0.25  # degrees, sun above; part of the most fuel by which daylight is preferred (by eye)
_SUN_STEP = 1800.0  # s between solar elevations
NEAR_TOWN = 10.0
"""km of a town from burned ground, within which a camera in it shows the fire."""
LENGTHS = {  # s
    "title": 5.0,
    "place": 6.0,
    "satellite": 6.0,
    "growth": 20.0,
    "lapse": 30.0,
    "arrival": 6.0,
    "active": 8.0,
    "flames": 6.0,
    "night": 6.0,
    "ground": 6.0,
    "perimeters": 6.0,
    "what-if": 6.0,
    "forecast": 8.0,
    "scar": 5.0,
    "end": 6.0,
}


@dataclass(frozen=True)
class Subject:
    """Run of a story, and the settings of its scene file.

    Attributes
    ----------
    cache
        Cache folder of the story.
    lapse
        Add the time-lapse with smoke.
    """

    run: Run
    settings: Settings
    cache: Path
    lapse: bool = False

    @cached_property
    def places(self) -> list[Label]:
        """Named places."""
        return labels.find(self.run, self.settings.labels.file)

    @property
    def towns(self) -> list[Label]:
        """Places in which a camera can stand."""
        return [each for each in self.places if each.kind in ("town", "")]

    @cached_property
    def nearest_town(self) -> tuple[Label, float, float] | None:
        """Town nearest to ground that burns, by day if one is near; distance, km; and time, s."""
        towns = self.towns
        latitude, longitude = ([getattr(each, axis) for each in towns] for axis in ("latitude", "longitude"))
        for until in (self.last_daylight, self.last) if towns else ():
            fire = fire_arrival.sample(self.run, latitude, longitude, until)
            burns = fire.nearest_time >= self.first
            away = np.where(burns, np.nan_to_num(fire.nearest_km, nan=np.inf), np.inf)
            nearest = int(np.argmin(away))
            time = float(fire.nearest_time[nearest])
            if away[nearest] <= NEAR_TOWN and (until == self.last or self.is_day(time)):
                return towns[nearest], float(away[nearest]), time
        return None

    @property
    def first(self) -> float:
        """First model time, s."""
        return float(self.run.times[0])

    @property
    def last(self) -> float:
        """Last model time, s."""
        return float(self.run.times[-1])

    def has(self, time: float) -> bool:
        """Return whether the run has a model time, s."""
        return self.first <= time <= self.last

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

    def is_day(self, time: float) -> bool:
        """Return whether the sun is high enough at a model time (s) for a picture."""
        return sun.position(self.run, time)[1] > _DAYLIGHT[0]

    @cached_property
    def last_daylight(self) -> float:
        """Last model time with daylight, s; the run's first time without any."""
        sampled = np.arange(self.last, self.first, -_SUN_STEP)
        return next((float(time) for time in sampled if self.is_day(float(time))), self.first)

    @cached_property
    def bright(self) -> float:
        """Model time of the highest sun in the run's first day, s."""
        sampled = np.arange(self.first, min(self.last, self.first + 86400.0) + 1.0, _SUN_STEP)
        return float(max(sampled, key=lambda time: sun.position(self.run, float(time))[1]))

    @cached_property
    def window(self) -> tuple[float, float, str]:
        """Start of the most active part by daylight (s), its speed (times real time), and its description."""
        return self._window(*_DAYLIGHT)

    @cached_property
    def peak(self) -> tuple[float, float]:
        """Model times (s) of the most active shot in any light."""
        start, speed, _ = self._window(nearly=np.inf)
        return self._shown(start, speed, LENGTHS["night"])

    def _window(self, sun_above: float = 0.0, nearly: float = 1.0) -> tuple[float, float, str]:
        asked = Time(frames=window.FRAMES, fps=window.FPS)
        chosen, words = window.choose(self.run, asked, sun_above, nearly)
        assert chosen.start  # as something burns
        assert chosen.end
        span = (chosen.end - chosen.start).total_seconds()
        speed = span * window.FPS / (window.FRAMES - 1)
        return times.seconds(self.run, chosen.start), speed, _PACE.sub("", words)

    def _shown(self, start: float, speed: float, length: float) -> tuple[float, float]:
        """Model times (s) of a shot of a length (s) in the film, from a time (s) or as late as possible."""
        end = min(start + speed * length, self.last)
        return max(end - speed * length, self.first), end

    @cached_property
    def flames(self) -> fire_views.NearView | None:
        """Clear view of flames from nearby."""
        if not smoke_scale.resolves_plume(max(burning.fuel_cell(self.run))):
            return None
        return fire_views.find_near_view(self.run, self.cache)

    def shot(self, name: str, start: float = 0.0, end: float = 0.0, **keys: object) -> StoryShot:
        """Make a shot between two model times (s), moved into the run; without times if both are 0."""
        moments = {}
        if end > start:
            length = min(end - start, self.last - self.first)
            start = float(np.clip(start, self.first, self.last - length))
            begin = times.utc(self.run, start)
            moments = {"start": begin, "end": begin + timedelta(seconds=length)}
        return StoryShot(name, seconds=LENGTHS[name], **moments, **keys)  # type: ignore[arg-type]

    def activity(self) -> tuple[float, float]:
        """Model times (s) of the active shot."""
        start, speed, _ = self.window
        return self._shown(start, speed, LENGTHS["active"])
