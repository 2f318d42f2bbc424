"""Frame lists: ``1-10``, ``3,5-9``, ``1-48:4``; an empty one stands for all frames."""

from __future__ import annotations

import re
from collections.abc import Iterable

_PART = re.compile(r"(\d{1,9})(?:-(\d{1,9})(?::(\d{1,9}))?)?", re.ASCII)


class FrameList(str):
    """Frame list, with the text by which a scene file or a command line gives it."""

    @classmethod
    def of(cls, frames: Iterable[int]) -> FrameList:
        """Make the shortest list of ascending frames: [1, 2, 3, 7] -> ``1-3,7``."""
        ranges: list[list[int]] = []
        for frame in frames:
            if ranges and frame == ranges[-1][1] + 1:
                ranges[-1][1] = frame
            else:
                ranges.append([frame, frame])
        return cls(",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges))

    def has_all(self) -> bool:
        """Return whether the list stands for all frames."""
        return not self.strip()

    def frames(self, last: int) -> list[int]:
        """List the frames, which are within 1..`last`, ascending and without repetition.

        Raises
        ------
        ValueError
            The message names the part of the text that is invalid or out of range.
        """
        if self.has_all():
            return list(range(1, last + 1))
        return sorted({frame for part in self.split(",") for frame in _range(part.strip(), last)})


def _range(part: str, last: int) -> range:
    match = _PART.fullmatch(part)
    if not match:
        raise ValueError(f'"{part}" is not a frame list; write it like 7, 1-10, 3,5-9 or 1-48:4')
    first = int(match[1])
    end = int(match[2]) if match[2] else first
    step = int(match[3]) if match[3] else None
    if end < first:
        ascending = f"{end}-{first}" + (f":{step}" if step is not None else "")
        raise ValueError(f'"{part}" is descending; list frames in ascending order: {ascending}')
    if step == 0:
        raise ValueError(f'"{part}" has a step of 0; write {first}-{end}:1 or {first}-{end} for every frame')
    if first < 1 or end > last:
        raise ValueError(f'"{part}" is outside of 1-{last}, the frames of this scene')
    return range(first, end + 1, step or 1)
