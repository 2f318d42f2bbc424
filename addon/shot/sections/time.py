"""Section [time]: model times that the frames show."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

import zoneinfo
from dataclasses import dataclass
from datetime import datetime

from ..schema import Where, key
from ..schema.did_you_mean import suggestion


def _zone(value: str) -> str | None:
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
    end: datetime | None = key(None, "model time of the last frame; default: the last time of the run")
    frames: int = key(48, "number of frames, spread evenly from start to end", at_least=1, at_most=100_000)
    fps: int = key(24, "frames per second of the films", at_least=1, at_most=240, affects=("film",))
    zone: str = key(
        "", "time zone of the clock in the films; empty: the run's zone", check=_zone, affects=("film",)
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that the end is after the start."""
        if self.start and self.end and self.end <= self.start:
            return ("end",), "time.end must be later than time.start"
        return None
