"""Conversion between UTC and model time (seconds since the run began)."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

from firetwin_core.run import Run


def seconds(run: Run, moment: datetime) -> float:
    """Convert a date and time to model time; without a time zone it is UTC."""
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    return (moment - _start(run)).total_seconds()


def utc(run: Run, time: float) -> datetime:
    """Convert a model time (s) to UTC."""
    return _start(run) + timedelta(seconds=time)


def iso(when: datetime, timespec: str = "seconds") -> str:
    """Format a time as ISO 8601 in UTC: ``2014-09-17T22:42:00Z``; `timespec` as in `datetime.isoformat`."""
    return when.astimezone(UTC).isoformat(timespec=timespec).replace("+00:00", "Z")


def text(when: datetime, zone: str, seconds: bool = False) -> str:
    """Format a time for people, in a time zone: ``17 Sep 2014 15:42 PDT``; with `seconds`, ``15:42:08``."""
    local = when.astimezone(ZoneInfo(zone))
    clock = f"{local:%H:%M:%S}" if seconds else f"{local:%H:%M}"
    return f"{local.day} {local:%b %Y} {clock} {local.tzname()}"


def age(seconds: float) -> str:
    """Format an age: ``5.5 h``, ``12 days``."""
    hours = seconds / 3600.0
    return f"{hours:.1f} h" if abs(hours) < 72.0 else f"{hours / 24.0:,.0f} days"


def _start(run: Run) -> datetime:
    start = datetime.fromisoformat(run.start)
    return start if start.tzinfo else start.replace(tzinfo=UTC)
