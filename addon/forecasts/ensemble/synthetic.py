"""Write the synthetic ensemble: `firetwin sample OUT --members N`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ...data import members, stored
from ...data.grid import axes
from ...errors import UsageError
from ...progress import Progress, silent
from . import write as ensembles
from .manifest import Manifest, Member

MOST = 200


def write(out: Path, count: int, progress: Progress = silent) -> None:
    """Write `count` members of the sample's fire to a folder that does not exist.

    Raises
    ------
    InputError
        The folder exists, or the disk is full.
    UsageError
        The count is out of range.
    """
    if not 2 <= count <= MOST:
        raise UsageError(f"--members: {count} is not a number of members from 2 to {MOST}")
    spread = members.Spread.of(stored.load())

    def each() -> Iterator[ensembles.Read]:
        for number in range(count):
            progress(number, count, "members")
            yield Member(f"{number:02}"), members.arrival(spread, number)
        progress(count, count, "members")

    head = Manifest(
        name="King Fire 2014 (synthetic ensemble)",
        model="minimum travel times",
        issued=stored.START,
        horizon=stored.MINUTES * 60.0,
        members=(),
        perturbed="fuel moisture, wind direction and local rates of spread (invented)",
        not_perturbed="initial perimeter, terrain, fuels, hour of the weather at each place; no suppression",
        synthetic=True,
        zone="America/Los_Angeles",
        source="firetwin sample --members",
    )
    latitude, longitude = axes(members.CELLS, members.CELL_SIZE)
    ensembles.write(out, head, latitude, longitude, each())
