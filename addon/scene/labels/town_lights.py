"""Lights of labelled towns at night: a cluster of small lamps at each, in the visible picture only.

Their number, spread and brightness are assumed: labels have a name and a place alone.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...shot.shot import Shot
from ..terrain import windows
from . import lettering
from .material import write_place

_COUNT, _SPREAD, _HEIGHT = 90, 450.0, 8.0  # lamps of a town; m, standard deviation of their places; m
SIZE = 0.35  # m, half width of a lamp with its bright surroundings (assumed)
_LIGHT = 20.0  # brightness relative to lit windows
_WARM, _COOL, _COLD = (1.0, 0.62, 0.30), (0.85, 0.92, 1.0), 0.25  # sodium and white lamps, and share of these
_CORNERS = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
_FACES = np.array([(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])


def build(
    shot: Shot, collection: bpy.types.Collection, towns: NDArray[np.float64]
) -> bpy.types.Object | None:
    """Build "Firetwin Town Lights" at places (n, 3), m; None by day or without towns."""
    if not len(towns) or not windows.shines(shot):
        return None
    random = np.random.default_rng([shot.settings.seed, 83])
    place = (towns[:, None, :2] + random.normal(0.0, _SPREAD, (len(towns), _COUNT, 2))).reshape(-1, 2)
    centre = np.column_stack([place, shot.ground.up(*place.T) + _HEIGHT])
    cool = random.uniform(size=(len(centre), 1)) < _COLD
    light = np.where(cool, _COOL, _WARM) * random.uniform(0.4, 1.6, (len(centre), 1)) * _LIGHT
    return place_lamps(shot, collection, centre, light)


def place_lamps(
    shot: Shot,
    collection: bpy.types.Collection,
    centre: NDArray[np.float64],
    light: NDArray[np.float64],
    size: NDArray[np.float64] | float = SIZE,
) -> bpy.types.Object:
    """Place lamps at centres (n, 3), m, with a colour and brightness (n, 3) relative to lit windows.

    Parameters
    ----------
    size
        Half widths (n,), m.
    """
    half = np.broadcast_to(size, len(centre))[:, None, None]
    corners = (centre[:, None] + half * _CORNERS).reshape(-1, 3)
    faces = (np.arange(len(centre))[:, None, None] * len(_CORNERS) + _FACES).reshape(-1, 3)
    data = create_mesh("Firetwin Town Lights", corners, faces, flat=True)
    colour = np.pad(np.repeat(light, len(_FACES), axis=0), [(0, 0), (0, 1)], constant_values=1.0)
    add_attribute(data, windows.LIT, "FLOAT_COLOR", colour, "FACE")
    data.materials.append(_material(shot))
    made = owned.add(collection, "Town Lights", data)
    made.lightgroup = nodes.FIRE
    lettering.camera_rays_only(made)
    return made


def _material(shot: Shot) -> bpy.types.Material:
    """Build "Firetwin Town Lights": lamps that count as no surface in depth."""
    look, tree = nodes.material("Firetwin Town Lights", (0.9, 0.7, 0.4))
    colour, bright = tree.attribute(windows.LIT, output="Color"), windows.strength(tree, shot)
    write_place(tree, 1.0)
    tree.surface(nodes.over(tree, tree.emission(colour, bright)))
    look.cycles.emission_sampling = "NONE"
    return look
