"""`firetwin stations`: station files, made and listed."""

from __future__ import annotations

import argparse

from ..command import SCENES, Command
from ..stations import arguments as options
from ._fire import open_fire


def _run(arguments: argparse.Namespace) -> None:
    """Make or list a station file."""
    from ..stations import verbs

    verbs.run_stations(arguments, open_fire)


COMMAND = Command(
    "stations",
    "make or list a station file",
    options.STATIONS,
    SCENES,
    _run,
    options.add_stations,
    former=("places",),
)
