"""Clock of flames: the time that the pattern of flames shows, which is slower than a quick film.

Flames of 20 m change their shape within a second or two. In a film of 15 times real time each frame would
have other tongues, which flicker like noise. Their pattern therefore moves by at most `_STEP` s in a frame.
Place, height and power of flames follow the model's time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..frames import Frames

_STEP = 0.25  # s (by eye: three times real time at 12 frames per second)


def pace(frames: Frames) -> float:
    """Return the speed of the pattern relative to the fire, 0 to 1."""
    return 1.0 if frames.step <= _STEP else _STEP / frames.step


def time(frames: Frames, moment: float) -> float:
    """Return the time that the pattern shows at a model time, s."""
    return frames.first + (moment - frames.first) * pace(frames)
