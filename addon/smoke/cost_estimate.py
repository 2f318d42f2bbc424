"""What solving a flow will take, in words, before it begins. Needs no Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from ..progress import duration, size
from ..shot.shot import Shot
from ..shot.smoke_scale import FINER
from . import baker, domains
from .flow import Flow, Part

_SPEED = 1.5e7  # cells a second on 2 cores (tests/benchmarks/solved_smoke.py); half or twice that elsewhere
_KEPT = 2.2  # bytes of a moment for each cell of its box, measured with smoke in most of it


@dataclass(frozen=True)
class Cost:
    """Of solving a flow: s of the fire, s it takes on 2 cores, bytes, widths of cells, where it is kept."""

    time: float
    seconds: float
    bytes: float
    cells: str
    folder: Path

    def brief(self) -> str:
        """``about 2 min, 1.1 GB``."""
        return f"about {duration(self.seconds)}, {size(self.bytes)}"


def words(shot: Shot) -> str:
    """Time and room for what is still to be solved of a shot; empty where that is nothing."""
    found = cost(shot)
    if found is None:
        return ""
    return (
        f"the air over {duration(found.time)} of the fire is solved once in cells of {found.cells}, which "
        f"takes about {duration(found.seconds)} on 2 cores and {size(found.bytes)} in {found.folder}; "
        'smoke.method = "puffs" needs none of it'
    )


def cost(shot: Shot) -> Cost | None:
    """What is still to be solved of a shot; None where that is nothing."""
    if not baker.solved(shot):
        return None
    solved, frames = Flow(shot), shot.frames
    parts = [part for part in solved.parts if not part.moment(frames.count).exists()]
    if not parts:
        return None
    work = 0.0
    for part in solved.parts:
        begin, step = solved.begin, shot.scale.step
        if part is not solved.parts[0]:
            begin, step = max(begin, frames.first - shot.scale.time(domains.LEAD)), step / FINER
        work += _cells(part) * math.ceil((frames.last - begin) / step)
    room = _KEPT * frames.count * sum(map(_cells, parts))
    return Cost(
        frames.last - solved.begin, work / _SPEED, room, _widths(solved.parts), solved.parts[-1].folder.parent
    )


def _widths(parts: list[Part]) -> str:
    """Cells of the box, and of the nest if there is one."""
    outer, *inner = (f"{part.box.spacing:.3g} m" for part in parts)
    return outer + "".join(f", {each} where cameras look" for each in inner)


def _cells(part: Part) -> int:
    return math.prod(part.box.shape) * (len(part.box.levels) - 1)
