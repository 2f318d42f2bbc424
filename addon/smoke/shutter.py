"""Shutter of a time lapse: sub-frames of smoke that a picture averages, as in a long exposure.

Films of hundreds of times real time show smoke at moments that have no relation to each other, which boils.
An exposure of two frame intervals overlaps the exposures of neighbouring frames: the second difference of the
pictures over the first falls from 1.72 to 1.33, measured on a plume in cells of 67 m at 370 times real time.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from firetwin_core import volume

from ..shot.shot import Shot

_LEAST, _MOST = 6, 6  # sub-frames in an exposure, at least; in a frame interval, at most


class ExposedSmoke(list[volume.Bricks]):
    """Bricks at a frame's time, with the bricks of its exposure.

    Attributes
    ----------
    moments
        Weight and bricks of each sub-frame; the weights sum to 1.
    """

    def __init__(
        self, bricks: Iterable[volume.Bricks], moments: Sequence[tuple[float, Sequence[volume.Bricks]]]
    ) -> None:
        super().__init__(bricks)
        self.moments = moments


def moments(smoke: Sequence[volume.Bricks]) -> Sequence[tuple[float, Sequence[volume.Bricks]]]:
    """Return weight and bricks of each sub-frame of a frame's exposure."""
    return smoke.moments if isinstance(smoke, ExposedSmoke) else [(1.0, smoke)]


def exposure(shot: Shot) -> float:
    """Return the exposure of a film's smoke, frame intervals; 0: none, as in stills."""
    cameras = shot.settings.cameras
    filmed = max((len(shot.frames_of(camera)) for camera in cameras), default=shot.frames.count)
    return 0.0 if filmed == 1 else shot.settings.time.shutter or 0.0


def parts(length: float) -> int:
    """Return the number of sub-frames in a frame interval for an exposure of `length` intervals."""
    return 1 if length == 0.0 else min(math.ceil(_LEAST / length), _MOST)


def sub_frames(frame: int, length: float, count: int) -> list[tuple[float, int]]:
    """List weights and numbers of the sub-frames that a frame's exposure covers; weights sum to 1.

    Sub-frame 1 is at frame 1. The exposure is centred on the frame; the film's ends cut it off.

    Parameters
    ----------
    length
        Exposure, frame intervals.
    count
        Frames of the film.
    """
    each = parts(length)
    middle, half, last = (frame - 1) * each + 1, 0.5 * length * each, (count - 1) * each + 1
    reach = math.ceil(half)
    covered = [
        (min(offset + 0.5, half) - max(offset - 0.5, -half), middle + offset)
        for offset in range(-reach, reach + 1)
        if 1 <= middle + offset <= last
    ]
    found = [(share, number) for share, number in covered if share > 1.0e-9]
    total = sum(share for share, _ in found)
    return [(share / total, number) for share, number in found] if found else [(1.0, middle)]
