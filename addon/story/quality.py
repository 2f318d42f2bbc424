"""Quality of a story: size and samples of its pictures, and how many of the film's frames are rendered."""

from __future__ import annotations

from dataclasses import dataclass

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
        The same of cameras that fly.
    map_rate
        The same of maps.
    smoke_method
        `smoke.method` of the scene files.
    """

    resolution: tuple[int, int]
    samples: int
    rate: float
    moving_rate: float
    map_rate: float
    smoke_method: str

    def pictures(self, span: Span, fps: int) -> int:
        """Count the pictures of a shot."""
        shot = span.shot
        rate = self.map_rate if shot.picture == MAP else self.rate
        if shot.camera in (GLOBE, FLIGHT):
            rate = self.moving_rate
        return max(min(round(rate * span.length / fps), span.length), 1)


def picture_of(span: Span, pictures: int, frame: int) -> int:
    """Return the number of the picture that a frame of the film shows, both from 1."""
    return 1 + round((frame - span.first) * (pictures - 1) / max(span.length - 1, 1))


QUALITIES = {
    "draft": Quality((640, 360), 3, 0.5, 2.0, 12.0, "preview"),
    "review": Quality((1280, 720), 6, 12.0, 12.0, 24.0, "flow"),
    "final": Quality((1920, 1080), 16, 60.0, 60.0, 60.0, "flow"),
}
