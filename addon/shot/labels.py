"""The places of a shot that get a label, and where they are in the scene."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..run import labels
from ..run.content import sha256
from .settings.settings import Settings
from .shot import Shot


class Labels(NamedTuple):
    """Names, and the ground there: (n, 3) scene metres."""

    names: list[str]
    position: NDArray[np.float64]


def find(shot: Shot) -> Labels:
    """The user's places, or else those that are known of the fire, as far as there is ground under them."""
    settings, ground = shot.settings.labels, shot.ground
    if not settings.enabled:
        return Labels([], np.empty((0, 3)))
    found = labels.read(settings.file) if settings.file else labels.known(shot.run)
    axes = ground.fields.latitude, ground.fields.longitude
    inside = [
        place
        for place in found
        if all(axis.min() <= at <= axis.max() for axis, at in zip(axes, place[1:], strict=True))
    ]
    if not inside:
        return Labels([], np.empty((0, 3)))
    _, latitude, longitude = zip(*inside, strict=True)
    return Labels([place.name for place in inside], ground.point(latitude, longitude))


def inputs(settings: Settings) -> dict[str, str]:
    """Hash of the user's file, where labels come from it."""
    places = settings.labels
    return {"labels": sha256(places.file)[:16]} if places.enabled and places.file else {}
