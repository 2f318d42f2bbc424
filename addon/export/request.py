"""Export requests: a shot, its frames and its place on the Earth, and the folder of the files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..progress import Progress, silent
from ..shot.shot import Shot
from .georeference import Georeference


@dataclass(frozen=True)
class ExportRequest:
    """Input of a format.

    Attributes
    ----------
    frames
        Exported frames of the film, ascending, from 1.
    folder
        Folder of the new files, which exists and is empty.
    progress
        Function for the number of finished frames or files, and of all.
    """

    shot: Shot
    frames: tuple[int, ...]
    georeference: Georeference
    folder: Path
    progress: Progress = silent
