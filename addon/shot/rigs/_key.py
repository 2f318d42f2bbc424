"""A camera at one moment, for every kind of camera that is placed by keys."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from ..bounds import AIM, HEIGHT
from ..schema import Where, key


@dataclass(frozen=True)
class CameraKey:
    """Where a camera is at one moment of the shot, and where it looks."""

    at: float = key(0.0, "when; 0: first frame, 1: last frame", at_least=0, at_most=1)
    latitude: float = key(0.0, "where the camera is", unit="degrees north", at_least=-90, at_most=90)
    longitude: float = key(
        0.0, "where the camera is; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    height: float = key(300.0, "height above the ground, or above the sea", **HEIGHT)
    target: str = key(
        "point",
        "it looks at",
        choices={"head": "of the fire", "fire": "its middle", "point": "", "ahead": ""},
    )
    target_latitude: float = key(0.0, "where the point is", unit="degrees north", at_least=-90, at_most=90)
    target_longitude: float = key(
        0.0, "where the point is; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    target_height: float = key(0.0, "height above the ground of what it looks at", **AIM)
    above: str = key("ground", "what its own height is above", choices=("ground", "sea"))
    tilt: float = key(
        15.0, 'how far under the horizon it looks "ahead"', unit="degrees", at_least=-90, at_most=90
    )


def rising(keys: tuple[CameraKey, ...]) -> tuple[Where, str] | None:
    """What is wrong with keys whose moments do not rise."""
    for i, (before, after) in enumerate(itertools.pairwise(keys), start=1):
        if after.at <= before.at:
            return ("keys", i, "at"), f"has keys at {before.at:g} and then {after.at:g}; at must rise"
    return None
