"""The command `firetwin export`."""

from __future__ import annotations

import argparse

from ..progress import Reporter, result, say
from ..shot.source import ShotSource
from . import job


def run(arguments: argparse.Namespace, source: ShotSource) -> None:
    """Write a scene in a format, and list its files."""
    smoke = not arguments.no_smoke
    options = job.ExportOptions(arguments.to, arguments.out, arguments.frames or "", arguments.geoid, smoke)
    reporter = Reporter(arguments.to)
    try:
        made = job.run(source, options, reporter, say)
    finally:
        reporter.close()
    for path in made:
        result(path)
