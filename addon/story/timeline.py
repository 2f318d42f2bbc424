"""Timeline: the frames of a film that show each shot, and the model time of a frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from .storyboard import Storyboard, StoryShot


@dataclass(frozen=True)
class Span:
    """Frames of a shot in the film: `length` frames from number `first` (from 1).

    Attributes
    ----------
    overlap
        Frames at its end that dissolve into the next shot.
    """

    shot: StoryShot
    first: int
    length: int
    overlap: int

    @property
    def end(self) -> int:
        """Number of the frame after the shot."""
        return self.first + self.length

    @property
    def free(self) -> int:
        """Number of the first frame of the dissolve into the next shot, or of the frame after the shot."""
        return self.end - self.overlap

    def moment(self, frame: int) -> datetime | None:
        """Return the model time that a frame of the film shows, UTC; None without times."""
        if self.shot.start is None or self.shot.end is None:
            return None
        part = (frame - self.first) / max(self.length - 1, 1)
        return self.shot.start + part * (self.shot.end - self.shot.start)


def lay_out(story: Storyboard) -> list[Span]:
    """Lay out the shots one after another; a dissolve overlaps two shots by at most half of either."""
    lengths = [max(round(shot.seconds * story.fps), 1) for shot in story.shots]
    spans, first = [], 1
    for number, (shot, length) in enumerate(zip(story.shots, lengths, strict=True)):
        overlap = _overlap(story, lengths, number)
        spans.append(Span(shot, first, length, overlap))
        first += length - overlap
    return spans


def frames(spans: Sequence[Span]) -> int:
    """Count the frames of the film."""
    return spans[-1].end - 1


def _overlap(story: Storyboard, lengths: list[int], number: int) -> int:
    if number + 1 == len(lengths):
        return 0
    return min(round(story.dissolve * story.fps), lengths[number] // 2, lengths[number + 1] // 2)
