"""Choices for the printed sheets, and the texts of their titles."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from typing import Literal
from zoneinfo import ZoneInfo

import firetwin_core
from firetwin_core.run import Run

from ..run import times
from ..run.measure import Units
from .paper import Orientation

Grid = Literal["latlong", "usng", "none"]


@dataclass(frozen=True)
class SheetOptions:
    """Choices of the user for the printed sheets.

    Attributes
    ----------
    paper
        Name of a size of `paper.SIZES`.
    orientation
        None chooses the orientation in which the fire is larger.
    grid
        Grid of the map: degrees, the US National Grid, or none.
    units
        Units of the scale bar and of areas.
    incident, author
        Texts of the title; None for the name of the run, and the version of Firetwin.
    period
        Operational period, UTC; None for the time of the run.
    prepared, issued
        Time of preparation, UTC (None: now), and issue time of the model's forecast (None: start of the run).
    """

    paper: str = "a4"
    orientation: Orientation | None = None
    grid: Grid = "latlong"
    units: Units = "us"
    incident: str | None = None
    author: str | None = None
    period: tuple[datetime, datetime] | None = None
    prepared: datetime | None = None
    issued: datetime | None = None


def of_arguments(arguments: Namespace) -> SheetOptions:
    """Collect the choices from the command line, whose options have the names of the attributes."""
    values = {each.name: getattr(arguments, each.name) for each in fields(SheetOptions)}
    return SheetOptions(**values | {"period": tuple(arguments.period) if arguments.period else None})


@dataclass(frozen=True)
class Titles:
    """Texts of the title block, header and footer."""

    incident: str
    author: str
    period: str
    prepared: str
    issued: str
    age: str

    @classmethod
    def of(cls, run: Run, options: SheetOptions, zone: str) -> Titles:
        """Format the texts, with times in a time zone."""
        first, last = (times.utc(run, float(run.times[at])) for at in (0, -1))
        begins, ends = options.period or (first, last)
        prepared = options.prepared or datetime.now(UTC).replace(microsecond=0)
        issued = options.issued or first
        return cls(
            options.incident or run.name,
            options.author or f"not stated (drawn by Firetwin {firetwin_core.__version__})",
            f"{times.text(begins, zone)} to {times.text(ends, zone)}",
            _text(prepared, zone, (begins, ends)),
            _text(issued, zone, (begins, ends)) + ("" if options.issued else " (start of the run)"),
            times.age((prepared - issued).total_seconds()),
        )


def _text(when: datetime, zone: str, period: tuple[datetime, datetime]) -> str:
    """Format a time in the local time of a period; in UTC if clocks have changed between the two.

    So a sheet has one abbreviation of local time: PST does not appear next to PDT.
    """
    local = ZoneInfo(zone)
    changed = all(each.astimezone(local).utcoffset() != when.astimezone(local).utcoffset() for each in period)
    return times.text(when, "UTC" if changed else zone)
