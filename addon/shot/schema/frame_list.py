"""Frame lists in text form: ``1-10``, ``3,5-9``, ``1-48:4``."""

from __future__ import annotations

import re
from collections.abc import Iterable

_PART = re.compile(r"(\d{1,9})(?:-(\d{1,9})(?::(\d{1,9}))?)?", re.ASCII)


def parse(text: str, last: int) -> list[int]:
    """Parse a frame list: frames of 1..`last`, ascending and unique; all frames for an empty text.

    Raises
    ------
    ValueError
        The message names the part of the text that is invalid or out of range.
    """
    if not text.strip():
        return list(range(1, last + 1))
    frames: set[int] = set()
    for part in text.split(","):
        frames.update(_frames(part.strip(), last))
    return sorted(frames)


def _frames(part: str, last: int) -> range:
    match = _PART.fullmatch(part)
    if not match:
        raise ValueError(f'"{part}" is not a list of frames; write it like 7, 1-10, 3,5-9 or 1-48:4')
    first = int(match[1])
    end = int(match[2]) if match[2] else first
    step = int(match[3]) if match[3] else None
    if end < first:
        turned = f"{end}-{first}" + (f":{step}" if step is not None else "")
        raise ValueError(f'"{part}" runs backwards; frames are listed from low to high: {turned}')
    if step == 0:
        raise ValueError(f'"{part}" has a step of 0; {first}-{end}:1, or {first}-{end}, is every frame')
    if first < 1 or end > last:
        raise ValueError(f'"{part}" is outside of 1-{last}, the frames of this scene')
    return range(first, end + 1, step or 1)


def write(frames: Iterable[int]) -> str:
    """Shortest frame list that `parse` reads back: [1, 2, 3, 7] -> ``1-3,7``."""
    ranges: list[list[int]] = []
    for frame in frames:
        if ranges and frame == ranges[-1][1] + 1:
            ranges[-1][1] = frame
        else:
            ranges.append([frame, frame])
    return ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges)
