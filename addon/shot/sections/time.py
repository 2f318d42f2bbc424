"""Section [time]: model times that the frames show."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

import zoneinfo
from collections.abc import Collection
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from fractions import Fraction

from ... import timecode
from ...did_you_mean import suggestion
from ..schema import Where, key


def invalid_zone(value: str) -> str | None:
    """Check the name of a time zone: error message, or None if valid; empty is valid."""
    if not value:
        return None
    try:
        zoneinfo.ZoneInfo(value)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        if not zoneinfo.available_timezones():  # Windows has no time zone database
            return "cannot be looked up: install the Python package tzdata"
        return f'"{value}" is not a time zone' + suggestion(value, sorted(zoneinfo.available_timezones()))
    return None


@dataclass(frozen=True)
class Time:
    """Model times that the frames show. Frames are spread evenly from `start` to `end`."""

    start: datetime | None = key(
        None, "model time of the first frame, with its zone; default: the first time of the run"
    )
    end: datetime | None = key(
        None, "model time of the last frame; default: by speed, or the last time of the run"
    )
    frames: int = key(48, "number of frames, spread evenly from start to end", at_least=1, at_most=100_000)
    speed: float | None = key(
        None,
        "speed of the films, times real time; up to 15 smoke flows; default: by start and end",
        at_least=0.001,
        at_most=1_000_000,
        affects=(),
    )
    fps: float = key(
        24,
        "frames per second of the films; whole, or 23.976, 29.97 or 59.94",
        at_least=1,
        at_most=240,
        check=timecode.invalid_rate,
        affects=("film",),
    )
    shutter: float | None = key(
        None,
        "exposure of smoke, frame intervals; 0: none, default: 2 in films of over 30 times real time",
        at_least=0,
        at_most=4,
        affects=("grain",),
    )
    zone: str = key(
        "",
        "time zone of the clock in the films; empty: the run's zone",
        check=invalid_zone,
        affects=("film",),
    )

    @property
    def rate(self) -> Fraction:
        """Exact frames per second."""
        return timecode.exact_rate(self.fps)

    def validate(self) -> tuple[Where, str] | None:
        """Check that the end is after the start, and that the speed agrees with them."""
        if self.start and self.end and self.end <= self.start:
            return ("end",), "time.end must be later than time.start"
        if self.speed is None:
            return None
        if not self.start and not self.end:
            return ("speed",), "time.speed needs time.start or time.end; set one of them"
        if self.start and self.end and self.frames != (needed := self._frames_between()):
            seconds = (self.end - self.start).total_seconds()
            speed = seconds * float(self.rate) / max(self.frames - 1, 1)
            return ("speed",), (
                f"time.speed contradicts time.start, time.end and time.frames: {self.frames} frames show "
                f"{seconds:,.7g} s at {speed:,.4g} times real time; "
                f"leave one of the four out, or set time.frames = {needed}"
            )
        try:
            self.resolved()
        except OverflowError:
            return ("speed",), "time.speed leads beyond the years 1 to 9999; use a smaller one"
        return None

    def with_frames(self, given: Collection[str]) -> Time:
        """Set the number of frames by start, end and speed, if a file gives these and not the frames."""
        if "frames" in given or self.speed is None or not (self.start and self.end) or self.speed <= 0.0:
            return self
        return replace(self, frames=self._frames_between())

    def resolved(self) -> Time:
        """Replace the speed by the start or end that it determines."""
        if self.speed is None:
            return self
        span = timedelta(seconds=self.speed * (self.frames - 1) / float(self.rate))
        start, end = self.start, self.end
        if start and not end and self.frames > 1:
            end = start + span
        elif end and not start:
            start = end - span
        return replace(self, start=start, end=end, speed=None)

    def _frames_between(self) -> int:
        """Return the number of frames from start to end at the speed."""
        assert self.start
        assert self.end
        assert self.speed
        return 1 + round((self.end - self.start).total_seconds() * float(self.rate) / self.speed)
