"""A drone: a camera in perspective that flies from key to key."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import Where, key
from . import Rig
from ._key import CameraKey, rising


@dataclass(frozen=True)
class Drone(Rig):
    """In perspective, flying smoothly from key to key."""

    focal_length: float = key(28.0, "of the lens; film is 36 mm wide", unit="mm", at_least=1, at_most=5000)
    over_ridges: bool = key(
        True, 'rise until it sees its "head" or "fire" over the ridges between; false keeps its height'
    )
    keys: tuple[CameraKey, ...] = key((), "where it is at one moment")

    def wrong(self) -> tuple[Where, str] | None:
        """A drone is somewhere, and its moments rise."""
        if not self.keys:
            return ("keys",), "has no [[cameras.keys]]; a drone needs at least one"
        return rising(self.keys)


RIG = Drone
