"""Passes and the files that each of them makes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath

from ..project import Camera, Project

ALL = ("rgb", "depth", "thermal")
SUFFIXES = {"rgb": ("png", "exr"), "depth": ("exr",), "thermal": ("exr", "png")}
FILMED = ("rgb", "thermal")  # depth is data: 8 bits of it would be a picture of depth


def of_camera(project: Project, camera: Camera) -> tuple[str, ...]:
    """Passes of a camera: its own, else those of the scene file's [render], in the order of `ALL`."""
    chosen = camera.passes or project.render.passes
    return tuple(name for name in ALL if name in chosen)


@dataclass(frozen=True, order=True)
class Shot:
    """One frame of one camera in one pass."""

    camera: str
    frame: int
    name: str

    def stem(self) -> str:
        """``drone_rgb_``: what Blender puts the six digits of the frame after."""
        return f"{self.camera}_{self.name}_"

    def files(self) -> tuple[str, ...]:
        """Files of the shot, relative to the output folder."""
        folder = PurePosixPath(self.camera, self.name)
        return tuple(str(folder / f"{self.stem()}{self.frame:06d}.{end}") for end in SUFFIXES[self.name])

    def file(self, suffix: str) -> str:
        """The file of the shot with this suffix."""
        return next(path for path in self.files() if path.endswith(suffix))


def film(camera: str, name: str) -> str:
    """Path of a camera's film, relative to the output folder."""
    return str(PurePosixPath(camera, f"{camera}_{name}.mp4"))
