"""Lists of frames as people write them: ``1-10``, ``3,5-9``, ``1-48:4``."""

from __future__ import annotations

import re

_PART = re.compile(r"(\d+)(?:-(\d+)(?::(\d+))?)?")


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
        found = _PART.fullmatch(part.strip())
        if not found:
            raise ValueError(
                f'"{part.strip()}" is not a list of frames; write it like 7, 1-10, 3,5-9 or 1-48:4'
            )
        first = int(found[1])
        end = int(found[2]) if found[2] else first
        step = int(found[3]) if found[3] else 1
        if first < 1 or end > last or end < first or step < 1:
            raise ValueError(f'"{part.strip()}" is outside of 1-{last}, the frames of this scene')
        frames.update(range(first, end + 1, step))
    return sorted(frames)


def write(frames: list[int]) -> str:
    """The shortest text of single frames and ranges that `parse` reads back: [1, 2, 3, 7] -> ``1-3,7``."""
    ranges: list[list[int]] = []
    for frame in frames:
        if ranges and frame == ranges[-1][1] + 1:
            ranges[-1][1] = frame
        else:
            ranges.append([frame, frame])
    return ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges)
