"""`firetwin resources`: resources of a station file that match a query."""

from __future__ import annotations

import argparse

from ..command import SCENES, Command
from ..stations import arguments as options
from ._fire import open_fire


def _run(arguments: argparse.Namespace) -> int:
    """List resources that match a query."""
    from ..stations import verbs

    return verbs.find_resources(arguments, open_fire)


COMMAND = Command(
    "resources",
    "list resources that match a query",
    options.RESOURCES,
    SCENES,
    _run,
    options.add_resources,
)
