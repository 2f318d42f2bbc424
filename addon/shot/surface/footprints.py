"""Buildings of a scene: footprints of its land use and of its file of footprints, standing on its ground."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from ...run import buildings
from ...run.buildings import Building, Footprints
from . import land_use

if TYPE_CHECKING:
    from ..shot import Shot

_KNOWN: WeakKeyDictionary[Shot, Footprints] = WeakKeyDictionary()


def collect(shot: Shot) -> Footprints:
    """Footprints of a shot's buildings, m east and north in the scene; `number` is that in its files."""
    if shot not in _KNOWN:
        known = land_use.read_map(shot)
        houses = [each for each in known.features if each.kind == "building"] if known else []
        _KNOWN[shot] = buildings.collect((each.polygons, each.height) for each in houses)
    return _KNOWN[shot]


def standing(shot: Shot) -> list[Building]:
    """A shot's buildings on its ground; heights are z in the scene, m."""
    return buildings.stand(collect(shot).outlines, lambda place: shot.ground.up(*place.T))


def said(shot: Shot) -> str:
    """What was assumed, mended or left out of the footprints, in words; empty if nothing was."""
    found = collect(shot)
    return found.said() if found.assumed or found.mended or found.refused else ""
