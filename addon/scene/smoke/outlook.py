"""What solving a flow will take, in words, before it begins. Needs no Blender."""

from __future__ import annotations

import math

from ...progress import count, duration, size
from ...shot.shot import Shot
from . import baker, boxes
from .flow import Flow

_SPEED = 4e6  # cells a second on 2 cores (tests/benchmarks/solved_smoke.py); half or twice that elsewhere
_KEPT = 2.2  # bytes of a moment for each cell of its box: at most, with smoke in all of it


def words(shot: Shot) -> str:
    """Time and room for what is still to be solved of a shot; empty where that is nothing."""
    if not baker.solved(shot):
        return ""
    solved, frames = Flow(shot), shot.frames
    parts = [part for part in solved.parts if not part.moment(frames.count).exists()]
    if not parts:
        return ""
    cells = {part: math.prod(part.box.shape) * (len(part.box.levels) - 1) for part in solved.parts}
    work = 0.0
    for part in solved.parts:
        lead, step = (
            (solved.begin, boxes.STEP)
            if part is solved.parts[0]
            else (max(solved.begin, frames.first - boxes.LEAD), boxes.STEP / boxes.FINER)
        )
        work += cells[part] * math.ceil((frames.last - lead) / step)
    room = _KEPT * frames.count * sum(cells[part] for part in parts)
    return (
        f"the air over {duration(frames.last - solved.begin)} of the fire is solved once, which takes about "
        f"{duration(work / _SPEED)} on 2 cores and at most {size(room)} in {solved.parts[-1].folder.parent}; "
        f'smoke.method = "puffs" shows {count(frames.count, "frame")} at once'
    )
