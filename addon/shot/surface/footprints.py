"""Buildings of a scene: footprints of its land use and of its file of footprints, standing on its ground."""

from __future__ import annotations

from ...run import buildings
from ...run.buildings import Building, Footprints
from ..shot import Shot, cached_on_shot
from . import land_use


@cached_on_shot
def collect(shot: Shot) -> Footprints:
    """Footprints of a shot's buildings, m east and north in the scene; `number` is that in its files."""
    known = land_use.read_map(shot)
    houses = [each for each in known.features if each.kind == "building"] if known else []
    return buildings.collect((each.polygons, each.height) for each in houses)


def place_buildings(shot: Shot) -> list[Building]:
    """Place a shot's buildings on its ground; heights are z in the scene, m."""
    return buildings.place_on_ground(collect(shot).outlines, lambda place: shot.ground.up(*place.T))


def summary(shot: Shot) -> str:
    """Describe assumed heights, repaired and omitted footprints; empty without any."""
    found = collect(shot)
    return found.summary() if found.assumed or found.mended or found.refused or found.too_large else ""
