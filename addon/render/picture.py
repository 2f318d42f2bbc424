"""Picture: a frame of a camera in a pass, with the paths of its files."""

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
        """Return the file stem, such as ``drone_rgb_``; Blender appends the six digits of the frame."""
        return f"{passes.file_stem(self.camera)}_{self.name}_"

    def files(self) -> tuple[str, ...]:
        """Return the paths of its files, relative to the output folder."""
        ends = passes.known()[self.name].files
        return tuple(passes.file_of(self.camera, self.name, self.frame, end) for end in ends)

    def file(self, suffix: str) -> str:
        """Return the path of its file with this suffix."""
        return next(path for path in self.files() if path.endswith(suffix))


FILM_SUFFIXES = (".mp4", ".mov")


def film(camera: str, name: str, kind: str = "review", codec: str = "h264") -> str:
    """Return the path of a camera's film of a kind, relative to the output folder."""
    stem = passes.file_stem(camera)
    file = f"{stem}_{name}" if kind == "review" else f"{stem}_{name}_{kind}"
    return str(PurePosixPath(stem, file + (".mov" if codec == "prores" else ".mp4")))
