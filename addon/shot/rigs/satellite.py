"""A satellite: a camera far above that looks straight down."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import Where, key
from . import Rig
from ._key import CameraKey, rising


@dataclass(frozen=True)
class Satellite(Rig):
    """Straight down and to scale, from above all smoke.

    It stands over the latitude and longitude of its first key, or over the middle of the run.
    """

    swath: float = key(56_000.0, "width of the picture on the ground", unit="m", above=0)
    keys: tuple[CameraKey, ...] = key((), "the first places it; without one it is over the middle of the run")

    def wrong(self) -> tuple[Where, str] | None:
        """Its moments rise."""
        return rising(self.keys)


RIG = Satellite
