"""Time zone of a run."""

from __future__ import annotations

import zoneinfo
from pathlib import Path

import numpy as np
from firetwin_core.run import Run

from ..data import history
from ..errors import input_error


def time_zone(run: Run) -> str:
    """Find the time zone: run.toml, the depicted fire, the offset of the start, or longitude.

    Raises
    ------
    InputError
        run.toml names an unknown zone.
    """
    if run.zone and not known(run.zone):
        raise input_error(Path(run.path, "run.toml"), f'zone = "{run.zone}" {NOT_KNOWN}')
    if run.zone:
        return run.zone
    if run.event in history.events():
        return history.load(run.event).zone
    if run.offset:
        return of_offset(run.offset)
    return of_longitude(0.5 * float(run.longitude[0] + run.longitude[-1]))


NOT_KNOWN = 'is not a time zone; give one such as "Europe/Paris", or "Etc/GMT-2" for two hours east of UTC'


def known(name: str) -> bool:
    """Check whether a name is a known time zone."""
    try:
        zoneinfo.ZoneInfo(name)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        return False
    return True


def of_longitude(longitude: float) -> str:
    """Return the time zone of a longitude (degrees east), in whole hours."""
    return of_hours(int(np.round(((longitude + 180.0) % 360.0 - 180.0) / 15.0)))


def of_offset(minutes: int) -> str:
    """Return the time zone of an offset east of UTC (minutes), rounded to whole hours."""
    return of_hours(round(minutes / 60))


def of_hours(east: int) -> str:
    """Return the zone of whole hours east of UTC. Etc/GMT zones count westward: Etc/GMT+8 is UTC-8."""
    return f"Etc/GMT{-east:+d}" if east else "Etc/GMT"
