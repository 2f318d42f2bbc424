"""Placement of buildings on the ground: walls from below the lowest ground up to a level roof."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from . import rings
from .footprints import Footprint
from .rings import Array

SKIRT = 2.0
"""m that walls reach into the ground, so that a coarse mesh of the ground leaves no gap."""
_LEAST = 1.0  # m, minimum height of a roof above the highest ground below it
_SAMPLE = 3.0  # m between samples of the ground


@dataclass(frozen=True)
class Building:
    """A building placed on the ground.

    Attributes
    ----------
    footprint
        Outline.
    base, roof
        Heights of the lower edge of the walls and of the roof, m, above the datum of the ground.
    middle
        (2,) east and north of a point inside, in units of the outline.
    """

    footprint: Footprint
    base: float
    roof: float
    middle: tuple[float, float]


def place_on_ground(
    outlines: Sequence[Footprint],
    ground: Callable[[Array], Array],
    metres: tuple[float, float] = (1.0, 1.0),
) -> list[Building]:
    """Place buildings on the ground.

    Walls begin below the lowest ground under the footprint. The level roof is at the height of the building
    above the ground at its middle, and above all ground below it.

    Parameters
    ----------
    ground
        Function that returns heights (n,), m, at points (n, 2), east and north in units of the outlines.
    metres
        Metres per unit east and north.
    """
    if not outlines:
        return []
    steps = [_SAMPLE / each for each in metres]
    places, middles = [], []
    for each in outlines:
        within = rings.spread(each.rings, steps)
        middles.append(rings.middle(each.rings, within))
        places.append(np.vstack([middles[-1], *each.rings, within]))
    ends = np.cumsum([len(each) for each in places])
    heights = np.split(np.asarray(ground(np.concatenate(places)), np.float64), ends[:-1])
    return [
        Building(
            each,
            float(here.min()) - SKIRT,
            max(float(here[0]) + each.height, float(here.max()) + _LEAST),
            (float(middle[0]), float(middle[1])),
        )
        for each, here, middle in zip(outlines, heights, middles, strict=True)
    ]
