"""Pictures of tiles as tiled images (UDIM), so that one material shows hundreds of files.

Blender numbers the parts of a tiled image 1001 + u + 10 v, up to 2000, and asks for files of one name. A
picture fills a part, and the tile's texture coordinates are moved there.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import files
from ...blender import owned

PARTS = 1000
"""Pictures in one image at most."""
_FIRST = 1001
_ROW = 10
_INSET = 1.0e-5  # of a part; keeps coordinates at the edge of a picture inside of it


@dataclass(frozen=True)
class Slot:
    """Where a picture is: the number of its image, and its part."""

    image: int
    part: int

    def moved(self, uv: NDArray[np.float32]) -> NDArray[np.float32]:
        """Texture coordinates (n, 2) of the picture, clamped to it, as coordinates of the image."""
        inside = np.clip(uv, _INSET, 1.0 - _INSET)
        return (inside + np.array([self.part % _ROW, self.part // _ROW])).astype(np.float32)


def arrange(pictures: Sequence[str]) -> dict[str, Slot]:
    """Slots of pictures' files: one image holds files of one kind, `PARTS` at most."""
    slots: dict[str, Slot] = {}
    open_images: dict[str, tuple[int, int]] = {}
    images = 0
    for name in dict.fromkeys(pictures):
        end = Path(name).suffix
        image, part = open_images.get(end, (-1, PARTS))
        if part == PARTS:
            image, part, images = images, 0, images + 1
        slots[name] = Slot(image, part)
        open_images[end] = image, part + 1
    return slots


def load(slots: dict[str, Slot], folder: Path, name: str) -> list[bpy.types.Image]:
    """The images of all slots; their files are links, in the folder `name`, to the pictures in `folder`."""
    members: dict[int, dict[int, str]] = {}
    for picture, slot in slots.items():
        members.setdefault(slot.image, {})[slot.part] = picture
    return [_load(number, members[number], folder, name) for number in sorted(members)]


def _load(number: int, parts: dict[int, str], folder: Path, name: str) -> bpy.types.Image:
    end = Path(parts[0]).suffix
    place = folder / name
    place.mkdir(exist_ok=True)
    for part, picture in parts.items():
        _link(folder / picture, place / f"{number}.{_FIRST + part}{end}")
    image = bpy.data.images.new(f"Firetwin Tiles {number + 1}", 8, 8, tiled=True)
    image.filepath = str(place / f"{number}.<UDIM>{end}")
    image.source = "TILED"
    for part in range(1, len(parts)):
        image.tiles.new(_FIRST + part)
    return owned.mark(image)


def _link(source: Path, path: Path) -> None:
    """Have the same file under another name: a link where the disk allows it, else a copy."""
    if path.exists() and path.samefile(source):
        return

    def put(part: Path) -> None:
        part.unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            os.link(source, part)
            return
        shutil.copyfile(source, part)

    files.write(path, put)
