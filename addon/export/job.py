"""Export job: writes a shot in a format, for the command and the panel."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..errors import UsageError
from ..jobs.tiles import selection
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot import georeference
from ..shot.georeference import Georeference
from ..shot.schema.frame_list import FrameList
from ..shot.source import ShotSource
from ..staging import staging
from . import formats
from .request import ExportRequest

_HEIGHTS = ("export", 'firetwin export with terrain.height_source = "tiles"')


@dataclass(frozen=True)
class ExportOptions:
    """Options of an export.

    Attributes
    ----------
    name
        Name of the format (see `formats.known`).
    out
        Folder to write.
    frames
        List of frames, such as ``1-48:4``; empty: all.
    geoid_m
        Height of the geoid above the ellipsoid, m; None: see `georeference.resolve`.
    smoke
        True if formats with volumes write the smoke.
    """

    name: str
    out: Path
    frames: str = ""
    geoid_m: float | None = None
    smoke: bool = True


def run(
    source: ShotSource,
    options: ExportOptions,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: Stop | None = None,
) -> list[Path]:
    """Write a shot; returns the main files.

    Raises
    ------
    UsageError
        The list of frames is invalid.
    InputError
        The terms of tiles that give the heights of cameras do not allow exports.
    """
    if source.settings().terrain.height_source == "tiles":
        selection.prepare(source, (), progress, tell, stop, uses=[_HEIGHTS])
    shot = source.shot()
    try:
        frames = FrameList(options.frames).frames(shot.frames.count)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    place = georeference.resolve(shot, options.geoid_m)
    tell(_describe(place))
    with staging(options.out) as folder:
        request = ExportRequest(
            source, shot, tuple(frames), place, folder, options.smoke, progress, tell, stop
        )
        made = [*formats.writer(options.name)(request), place.write(folder)]
        return [options.out / path.relative_to(folder) for path in made]


def _describe(place: Georeference) -> str:
    """Describe the heights of an export, with a warning if the height of the geoid is unknown."""
    if place.source == georeference.UNKNOWN:
        return (
            "warning: the height of the geoid is unknown and 0 is assumed, so heights are up to 110 m wrong; "
            "give it with --geoid or tiles.geoid"
        )
    return f"height of the geoid above the ellipsoid: {place.geoid_m:.2f} m ({place.source})"
