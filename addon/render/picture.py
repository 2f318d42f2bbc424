"""One picture: a frame of a camera in a pass, and the files that it is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath

from ..shot import passes


@dataclass(frozen=True, order=True)
class Picture:
    """One frame of one camera in one pass."""

    camera: str
    frame: int
    name: str  # of the pass

    def stem(self) -> str:
        """``drone_rgb_``: what Blender puts the six digits of the frame after."""
        return f"{self.camera}_{self.name}_"

    def files(self) -> tuple[str, ...]:
        """Its files, relative to the output folder."""
        ends = passes.known()[self.name].files
        return tuple(passes.file_of(self.camera, self.name, self.frame, end) for end in ends)

    def file(self, suffix: str) -> str:
        """Its file with this suffix."""
        return next(path for path in self.files() if path.endswith(suffix))


def film(camera: str, name: str) -> str:
    """Path of a camera's film, relative to the output folder."""
    return str(PurePosixPath(camera, f"{camera}_{name}.mp4"))
