"""Labels of a shot: named places and their positions in the scene."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...run import labels
from ...run.content import sha256
from ..settings import Settings
from ..shot import Shot


class Labels(NamedTuple):
    """Names, positions (n, 3) on the ground in scene coordinates, m, and kinds ("town"; empty if unknown)."""

    names: list[str]
    position: NDArray[np.float64]
    kinds: list[str]


def find(shot: Shot) -> Labels:
    """Find labels within the terrain, from the list of the user, or the built-in ones of the fire."""
    settings, ground = shot.settings.labels, shot.ground
    if not settings.enabled:
        return Labels([], np.empty((0, 3)), [])
    places = labels.read(settings.file) if settings.file else labels.known(shot.run)
    axes = ground.fields.latitude, ground.fields.longitude
    inside = [
        place
        for place in places
        if all(axis.min() <= at <= axis.max() for axis, at in zip(axes, place[1:3], strict=True))
    ]
    if not inside:
        return Labels([], np.empty((0, 3)), [])
    names, latitude, longitude, kinds = zip(*inside, strict=True)
    return Labels(list(names), ground.point(latitude, longitude), list(kinds))


def inputs(settings: Settings) -> dict[str, str]:
    """Return the hash of the user's file of labels, if there is one."""
    places = settings.labels
    return {"labels": sha256(places.file)[:16]} if places.enabled and places.file else {}
