"""What solving a flow will take, in words, before it begins. Needs no Blender."""

from __future__ import annotations

import math

from ...progress import duration, size
from ...shot.scale import FINER
from ...shot.shot import Shot
from . import baker, boxes
from .flow import Flow, Part

_SPEED = 1.5e7  # cells a second on 2 cores (tests/benchmarks/solved_smoke.py); half or twice that elsewhere
_KEPT = 2.2  # bytes of a moment for each cell of its box, measured with smoke in most of it


def words(shot: Shot) -> str:
    """Time and room for what is still to be solved of a shot; empty where that is nothing."""
    if not baker.solved(shot):
        return ""
    solved, frames = Flow(shot), shot.frames
    parts = [part for part in solved.parts if not part.moment(frames.count).exists()]
    if not parts:
        return ""
    work = 0.0
    for part in solved.parts:
        begin, step = solved.begin, shot.scale.step
        if part is not solved.parts[0]:
            begin, step = max(begin, frames.first - shot.scale.time(boxes.LEAD)), step / FINER
        work += _cells(part) * math.ceil((frames.last - begin) / step)
    room = _KEPT * frames.count * sum(map(_cells, parts))
    return (
        f"the air over {duration(frames.last - solved.begin)} of the fire is solved once in cells of "
        f"{_widths(solved.parts)}, which takes about "
        f"{duration(work / _SPEED)} on 2 cores and {size(room)} in {solved.parts[-1].folder.parent}; "
        'smoke.method = "puffs" needs none of it'
    )


def _widths(parts: list[Part]) -> str:
    """Cells of the box, and of the nest if there is one."""
    outer, *inner = (f"{part.box.spacing:.3g} m" for part in parts)
    return outer + "".join(f", {each} where cameras look" for each in inner)


def _cells(part: Part) -> int:
    return math.prod(part.box.shape) * (len(part.box.levels) - 1)
