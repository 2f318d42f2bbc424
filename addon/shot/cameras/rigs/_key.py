"""Camera key: position and view at one time, for all kinds of camera with keys."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from ...schema import Where, key
from ...schema.bounds import AIM, HEIGHT


@dataclass(frozen=True)
class CameraKey:
    """Position and view of a camera at one time of the shot."""

    at: float = key(0.0, "time of the key; 0: first frame, 1: last frame", at_least=0, at_most=1)
    latitude: float = key(0.0, "camera latitude", unit="degrees north", at_least=-90, at_most=90)
    longitude: float = key(
        0.0, "camera longitude; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    height: float = key(300.0, "camera height above terrain or sea", **HEIGHT)
    target: str = key(
        "point",
        "look-at target",
        choices={
            "head": "of the fire",
            "fire": "its centre",
            "point": "",
            "ahead": "",
        },
    )
    target_latitude: float = key(0.0, "target latitude", unit="degrees north", at_least=-90, at_most=90)
    target_longitude: float = key(
        0.0, "target longitude; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    target_height: float = key(0.0, "target height above the terrain", **AIM)
    above: str = key("ground", "reference of the camera height", choices=("ground", "sea"))
    tilt: float = key(15.0, 'depression angle of the view "ahead"', unit="degrees", at_least=-90, at_most=90)


class _Timed(Protocol):
    @property
    def at(self) -> float: ...


def rising(keys: Sequence[_Timed]) -> tuple[Where, str] | None:
    """Check that the times of keys ascend."""
    for i, (before, after) in enumerate(itertools.pairwise(keys), start=1):
        if after.at <= before.at:
            return ("keys", i, "at"), f"has keys at {before.at:g} and then {after.at:g}; at must rise"
    return None
