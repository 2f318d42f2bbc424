"""Quality of a story: size and samples of its pictures, and how many of the film's frames are rendered."""

from __future__ import annotations

from dataclasses import dataclass

from ..shot.frames import TIME_LAPSE
from .storyboard import FLIGHT, GLOBE, MAP
from .timeline import Span


@dataclass(frozen=True)
class Quality:
    """Quality of the pictures.

    Attributes
    ----------
    rate
        Rendered pictures per second of the film.
    moving_rate
        The same of cameras that fly, and of time-lapses.
    map_rate
        The same of maps.
    smoke_method
        `smoke.method` of the scene files.
    at_once
        Shots that are rendered at a time; each takes memory.
    """

    resolution: tuple[int, int]
    samples: int
    rate: float
    moving_rate: float
    map_rate: float
    smoke_method: str
    at_once: int = 1

    def pictures(self, span: Span, fps: int) -> int:
        """Count the pictures of a shot."""
        shot = span.shot
        if shot.step and shot.start and shot.end:
            return 1 + round((shot.end - shot.start).total_seconds() / shot.step)
        rate = self.rate
        if shot.picture == MAP:
            rate = self.map_rate
        elif shot.camera in (GLOBE, FLIGHT) or shot.speed > TIME_LAPSE[0]:
            rate = self.moving_rate
        return max(min(round(rate * span.length / fps), span.length), 1)


def picture_of(span: Span, pictures: int, frame: int) -> int:
    """Return the number of the picture that a frame of the film shows, both from 1."""
    return 1 + round((frame - span.first) * (pictures - 1) / max(span.length - 1, 1))


QUALITIES = {
    "draft": Quality((640, 360), 3, 0.5, 1.5, 12.0, "preview", at_once=2),
    "review": Quality((1280, 720), 6, 12.0, 12.0, 24.0, "flow"),
    "final": Quality((1920, 1080), 16, 60.0, 60.0, 60.0, "flow"),
}
