"""Slots of tiles' pictures in tiled images (UDIM), so that one material shows hundreds of files.

Blender numbers the parts of a tiled image 1001 + u + 10 v, up to 2000. A picture fills a part, and the tile's
texture coordinates are moved there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

PARTS = 1000
"""Maximum pictures in one image."""
_ROW = 10
_INSET = 1.0e-5  # of a part; keeps edge coordinates inside the picture


@dataclass(frozen=True)
class Slot:
    """Position of a picture: number of its image, and part."""

    image: int
    part: int

    def moved(self, uv: NDArray[np.float32]) -> NDArray[np.float32]:
        """Convert texture coordinates (n, 2) of the picture, clamped to it, to coordinates of the image."""
        inside = np.clip(uv, _INSET, 1.0 - _INSET)
        return (inside + np.array([self.part % _ROW, self.part // _ROW])).astype(np.float32)


def arrange(pictures: Sequence[str], former: Mapping[str, Slot] | None = None) -> dict[str, Slot]:
    """Assign slots to pictures' files: an image has files of one type, at most `PARTS`.

    Parameters
    ----------
    former
        Slots of the last build. Pictures keep their slots, so that their tiles need no rebuild; new pictures
        fill the gaps. If the first part of an image would be empty, all slots are assigned again.
    """
    wanted = dict.fromkeys(pictures)
    slots = {name: slot for name, slot in (former or {}).items() if name in wanted}
    ends: dict[int, str] = {}
    taken = set(slots.values())
    for name, slot in slots.items():
        fits = ends.setdefault(slot.image, Path(name).suffix) == Path(name).suffix
        if not fits or len(taken) < len(slots):
            return arrange(pictures)
    free = {end: _gaps(taken, [image for image in ends if ends[image] == end]) for end in ends.values()}
    images = max(ends, default=-1) + 1
    for name in wanted:
        if name in slots:
            continue
        end = Path(name).suffix
        found = next(free.get(end, iter(())), None)
        if found is None:
            free[end] = _gaps(taken, [images])
            found, images = next(free[end]), images + 1
        slots[name] = found
    return slots if _is_whole(slots.values()) else arrange(pictures)


def _gaps(taken: set[Slot], images: list[int]) -> Iterator[Slot]:
    """Iterate over the free slots of these images."""
    every = (Slot(image, part) for image in images for part in range(PARTS))
    return (slot for slot in every if slot not in taken)


def _is_whole(slots: Iterable[Slot]) -> bool:
    """Test whether images are numbered without gaps, and each has its first part."""
    given = set(slots)
    images = {slot.image for slot in given}
    return images == set(range(len(images))) and all(Slot(image, 0) in given for image in images)
