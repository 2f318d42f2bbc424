"""Export requests: a shot, its frames and its place on the Earth, and the folder of the files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..progress import Progress, silent
from ..shot.shot import Shot
from ..shot.source import ShotSource
from .georeference import Georeference


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
    """

    source: ShotSource
    shot: Shot
    frames: tuple[int, ...]
    georeference: Georeference
    folder: Path
    smoke: bool = True
    progress: Progress = silent
