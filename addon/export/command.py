"""The command `firetwin export`."""

from __future__ import annotations

import argparse

from ..errors import UsageError
from ..progress import Reporter, result, say
from ..shot.schema.frame_list import FrameList
from ..shot.source import ShotSource
from . import formats, georeference
from .request import ExportRequest
from .staging import staging


def run(arguments: argparse.Namespace, source: ShotSource) -> None:
    """Write a scene in a format.

    Raises
    ------
    UsageError
        The list of frames is invalid.
    """
    shot = source.shot()
    try:
        frames = FrameList(arguments.frames or "").frames(shot.frames.count)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    place = georeference.resolve(shot, arguments.geoid)
    _report(place)
    reporter = Reporter(arguments.to)
    try:
        with staging(arguments.out) as folder:
            request = ExportRequest(
                source, shot, tuple(frames), place, folder, not arguments.no_smoke, reporter
            )
            made = [*formats.writer(arguments.to)(request), place.write(folder)]
            names = [path.relative_to(folder) for path in made]
    finally:
        reporter.close()
    for name in names:
        result(arguments.out / name)


def _report(place: georeference.Georeference) -> None:
    """Print the heights of an export, with a warning if the height of the geoid is unknown."""
    if place.source == georeference.UNKNOWN:
        say(
            "warning: the height of the geoid is unknown and 0 is assumed, so heights are up to 110 m wrong; "
            "give it with --geoid"
        )
    else:
        say(f"height of the geoid above the ellipsoid: {place.geoid_m:.2f} m ({place.source})")
