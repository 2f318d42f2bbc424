"""Export requests: source of the shot, format and options. Each process resolves the shot once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..errors import UsageError
from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot import georeference
from ..shot.georeference import Georeference
from ..shot.schema.frame_list import FrameList
from ..shot.shot import Shot
from ..shot.source import ShotSource


@dataclass(frozen=True)
class ExportRequest:
    """Input of a format.

    Attributes
    ----------
    source
        Source of the shot.
    name
        Name of the format (see `formats.known`).
    folder
        Folder to write. A format gets a folder that exists and is empty.
    frame_list
        Exported frames of the film, such as ``1-48:4``; empty: all.
    geoid_m
        Height of the geoid above the ellipsoid, m; None: see `georeference.resolve`.
    smoke
        True if formats with volumes write the smoke.
    progress
        Function for the number of finished frames or files, and of all.
    tell
        Function for messages.
    stop
        Token that ends worker processes.
    overwrite
        True if files of others are replaced (see `output`).
    """

    source: ShotSource
    name: str
    folder: Path
    frame_list: str = ""
    geoid_m: float | None = None
    smoke: bool = True
    progress: Progress = silent
    tell: MessageCallback = no_message
    stop: Stop | None = None
    overwrite: bool = False

    @cached_property
    def shot(self) -> Shot:
        """Resolved shot."""
        return self.source.shot()

    @cached_property
    def frames(self) -> tuple[int, ...]:
        """Exported frames, ascending, from 1.

        Raises
        ------
        UsageError
            The list of frames is invalid.
        """
        try:
            return tuple(FrameList(self.frame_list).frames(self.shot.frames.count))
        except ValueError as error:
            raise UsageError(f"--frames: {error}") from None

    @cached_property
    def georeference(self) -> Georeference:
        """Place of the scene on the Earth."""
        return georeference.resolve(self.shot, self.geoid_m)
