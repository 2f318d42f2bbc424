"""Colours of the ground in Blender's solid viewport shading, from a colour attribute.

They do not depend on time, so that a frame change costs nothing: ground that burns during the shot has a
separate colour. Renders do not use them.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...blender.mesh import add_attribute
from ...shot.shot import Shot
from ..forest import biomes

NAME = "solid_view"
BARE, GRASS, FOREST, WATER = (0.30, 0.28, 0.25), (0.22, 0.17, 0.08), (0.035, 0.070, 0.022), (0.02, 0.09, 0.20)
# burned before the first frame, and burned by the last frame
BURNED, BURNS = (0.020, 0.017, 0.016), (0.120, 0.036, 0.014)
_DENSE = 1.2  # kg/m2 of canopy fuel that hides grass


def paint(shot: Shot, data: bpy.types.Mesh, row: NDArray[np.float64], column: NDArray[np.float64]) -> None:
    """Set the mesh's active colour attribute, for points at fractional rows and columns (n,)."""
    rgb = vertex_colours(shot, row, column)
    add_attribute(data, NAME, "BYTE_COLOR", np.pad(rgb, [(0, 0), (0, 1)], constant_values=1.0))
    data.color_attributes.active_color = data.color_attributes[NAME]


def vertex_colours(shot: Shot, row: NDArray[np.float64], column: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return scene-linear red, green and blue (n, 3): vegetation, lakes and burned area."""
    ground = shot.ground

    def at(field: NDArray) -> NDArray[np.float64]:
        return bilinear(np.asarray(field, np.float64), row, column)[:, None]

    dense = np.clip(at(ground.fields.canopy_fuel) / _DENSE, 0, 1)
    grass = GRASS if (land := biomes.choose(shot).biome.open_land) is None else land.straw
    shade = np.array(grass) + (np.array(FOREST) - grass) * dense
    shade = shade + (np.array(BARE) - shade) * np.clip(at(ground.bare), 0, 1)
    arrival = ground.arrival_at(row, column)[:, None]
    shade = np.where(arrival <= shot.frames.last, BURNS, shade)
    shade = np.where(arrival <= shot.frames.first, BURNED, shade)
    return np.where(at(ground.water) > 0.5, WATER, shade).astype(np.float32)
