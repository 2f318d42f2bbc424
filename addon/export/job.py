"""Export job: writes a shot in a format, for the command and the panel."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ..jobs.tiles import selection
from ..shot import georeference
from ..shot.georeference import Georeference
from ..staging import staging
from . import formats
from .request import ExportRequest

_HEIGHTS = ("export", 'firetwin export with terrain.height_source = "tiles"')


def run(request: ExportRequest) -> list[Path]:
    """Write a shot; returns the main files.

    Raises
    ------
    UsageError
        The list of frames is invalid.
    InputError
        The terms of tiles that give the heights of cameras do not allow exports, or a file of others is in
        the way.
    """
    source = request.source
    if source.settings().terrain.height_source == "tiles":
        selection.prepare(source, (), request.progress, request.tell, request.stop, uses=[_HEIGHTS])
    with staging(request.folder, request.overwrite) as folder:
        staged = replace(request, folder=folder)
        _ = staged.frames  # reports an invalid list before anything is written
        staged.tell(_describe(staged.georeference))
        made = [*formats.writer(request.name)(staged), staged.georeference.write(folder)]
        return [request.folder / path.relative_to(folder) for path in made]


def _describe(place: Georeference) -> str:
    """Describe the heights of an export, with a warning if the height of the geoid is unknown."""
    if place.source == georeference.UNKNOWN:
        return (
            "warning: the height of the geoid is unknown and 0 is assumed, so heights are up to 110 m wrong; "
            "give it with --geoid or tiles.geoid"
        )
    return f"height of the geoid above the ellipsoid: {place.geoid_m:.2f} m ({place.source})"
