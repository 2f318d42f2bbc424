"""Export requests: a shot, its frames and its place on the Earth, and the folder of the files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..jobs.worker import Stop
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot.georeference import Georeference
from ..shot.shot import Shot
from ..shot.source import ShotSource


@dataclass(frozen=True)
class ExportRequest:
    """Input of a format.

    Attributes
    ----------
    source
        Source of the shot, from which other processes resolve it again.
    frames
        Exported frames of the film, ascending, from 1.
    folder
        Folder of the new files, which exists and is empty.
    smoke
        True if formats with volumes write the smoke.
    progress
        Function for the number of finished frames or files, and of all.
    tell
        Function for messages.
    stop
        Token that ends worker processes.
    """

    source: ShotSource
    shot: Shot
    frames: tuple[int, ...]
    georeference: Georeference
    folder: Path
    smoke: bool = True
    progress: Progress = silent
    tell: MessageCallback = no_message
    stop: Stop | None = None
