"""Lists of frames as people write them: ``1-10``, ``3,5-9``, ``1-48:4``."""

from __future__ import annotations

import re
from collections.abc import Iterable

_PART = re.compile(r"(\d{1,9})(?:-(\d{1,9})(?::(\d{1,9}))?)?", re.ASCII)


def parse(text: str, last: int) -> list[int]:
    """Frames named by `text`, ascending, each once, out of 1..`last`; all of them for an empty text.

    Raises
    ------
    ValueError
        Says which part of the text is not understood or lies outside.
    """
    if not text.strip():
        return list(range(1, last + 1))
    frames: set[int] = set()
    for part in text.split(","):
        frames.update(_frames(part.strip(), last))
    return sorted(frames)


def _frames(part: str, last: int) -> range:
    found = _PART.fullmatch(part)
    if not found:
        raise ValueError(f'"{part}" is not a list of frames; write it like 7, 1-10, 3,5-9 or 1-48:4')
    first = int(found[1])
    end = int(found[2]) if found[2] else first
    step = int(found[3]) if found[3] else None
    if end < first:
        turned = f"{end}-{first}" + (f":{step}" if step is not None else "")
        raise ValueError(f'"{part}" runs backwards; frames are listed from low to high: {turned}')
    if step == 0:
        raise ValueError(f'"{part}" has a step of 0; {first}-{end}:1, or {first}-{end}, is every frame')
    if first < 1 or end > last:
        raise ValueError(f'"{part}" is outside of 1-{last}, the frames of this scene')
    return range(first, end + 1, step or 1)


def write(frames: Iterable[int]) -> str:
    """The shortest text of single frames and ranges that `parse` reads back: [1, 2, 3, 7] -> ``1-3,7``."""
    ranges: list[list[int]] = []
    for frame in frames:
        if ranges and frame == ranges[-1][1] + 1:
            ranges[-1][1] = frame
        else:
            ranges.append([frame, frame])
    return ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges)
