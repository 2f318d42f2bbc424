"""Cost estimate of solving a smoke flow: time and disk space. Needs no Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from ..progress import duration, size
from ..shot.fire.smoke_scale import FINER
from .coarse import CoarseFlow, LapseFlow
from .domains import Domain
from .flow import Flow

# cells per second on 2 cores (tests/benchmarks/solved_smoke.py); other machines differ by a factor of 2
_SPEED = 1.5e7
_LAPSE_SPEED = 3.0e6  # of time lapses, in whose long steps heat sources cost more than cells
_KEPT = 2.2  # bytes of a snapshot per cell of its domain, measured with smoke in most of it


@dataclass(frozen=True)
class Cost:
    """Cost of solving a flow: s of fire time, s of computation on 2 cores, bytes, cell widths, and folder.

    `first` is the part of the computation, s, that precedes the first picture; 0 if that is solved. `coarse`
    is True for previews.
    """

    time: float
    seconds: float
    first: float
    bytes: float
    cells: str
    folder: Path
    coarse: bool = False

    def brief(self) -> str:
        """Format the cost briefly: ``about 2 min, 1.1 GB``."""
        return f"about {duration(self.seconds)}, {size(self.bytes)}"

    def describe(self) -> str:
        """Describe time, disk space and the alternative in a sentence."""
        before = f" ({duration(self.first)} before the first picture)" if self.first else ""
        text = (
            f"the air over {duration(self.time)} of the fire is solved once in cells of {self.cells}, which "
            f"takes about {duration(self.seconds)} on 2 cores{before} and {size(self.bytes)} in {self.folder}"
        )
        return text if self.coarse else f'{text}; smoke.method = "preview" takes seconds'


def estimate(flow: Flow) -> Cost | None:
    """Estimate the cost of the remaining solution of a flow; None if it is complete."""
    shot, frames = flow.shot, flow.shot.frames
    missing = [
        domain_left for domain_left in flow.domains if not domain_left.snapshot_path(frames.count).exists()
    ]
    if not missing:
        return None
    work = first = 0.0
    for domain in flow.domains:
        begin, step = flow.begin, shot.scale.step
        if domain is not flow.domains[0]:
            begin, step = max(begin, frames.first - shot.scale.time(flow.lead)), step / FINER
        film = (frames.count - 1) * max(1, math.ceil(frames.step / step))  # a step in each frame at least
        spin_up = domain.cells * math.ceil((frames.first - begin) / step)
        first += spin_up
        work += spin_up + domain.cells * film
    room = _KEPT * frames.count * sum(domain_left.cells for domain_left in missing)
    folder = flow.domains[-1].folder.parent
    speed = _LAPSE_SPEED if isinstance(flow, LapseFlow) else _SPEED
    seconds = work / speed, 0.0 if flow.has(1) else first / speed
    widths, is_coarse = _widths(flow.domains), isinstance(flow, CoarseFlow)
    return Cost(frames.last - flow.begin, *seconds, room, widths, folder, is_coarse)


def _widths(solved: list[Domain]) -> str:
    """Format the cell widths of the domain and of the nested domain if there is one."""
    outer, *inner = (f"{domain.box.spacing:.3g} m" for domain in solved)
    return outer + "".join(f", {domain} where cameras look" for domain in inner)
