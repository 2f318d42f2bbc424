"""Terrain builder: one continuous mesh with view-dependent level of detail, and its fields as images."""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import terrain
from numpy.typing import NDArray

from ...blender import owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot import picture_credits
from ...shot.shot import Shot
from ...shot.surface import mesh_tolerance
from ...shot.tiles import tile_cut
from .. import credits
from ..forest.stand import Stand
from . import buildings, fields, globe, material, solid_view

_SEAM = 2.0  # points of the tiles' heights, width of the ground retained under their border
_UNDER = 0.25  # m by which this ground is lowered, so that it does not show through

Shape = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]


def build(shot: Shot, stage: Stage, grown: Stand | None, shaped: Shape | None = None) -> bpy.types.Object:
    """Build "Firetwin Ground", from its `shape` if already computed.

    Its mesh has point attributes: `elevation` (m); `grid`, the texture coordinates in the images of the
    terrain's fields (see `fields`); and `solid_view`, its colours in Blender's solid view.
    """
    collection, ground = stage.part("Terrain"), shot.ground
    credits.store(collection, picture_credits.of_settings(shot.settings))
    row, column, triangles = cut_out_tiles(shot, *(shaped or make_shape(shot)))
    latitude, longitude = ground.places(row, column)
    coarse = ground.frame.forward(latitude, longitude, ground.height(row, column))
    height = ground.height(row, column, ground.detail(*coarse.T))
    if (tiles := tile_cut.heights(shot)) is not None:
        height = height - _UNDER * np.isfinite(tiles.up(*coarse[:, :2].T))
    data = create_mesh("Firetwin Ground", ground.frame.forward(latitude, longitude, height), triangles)
    add_attribute(data, "elevation", "FLOAT", height)
    place = fields.texture_coordinates(ground.shape, row, column, ground.fields.margin)
    add_attribute(data, fields.GRID, "FLOAT_VECTOR", place)
    solid_view.paint(shot, data, row, column)
    picture = globe.load_picture(shot) if shot.beyond else None
    if shot.beyond:
        add_attribute(data, material.GLOBE, "FLOAT", globe.border_share(ground, row, column))
    images = fields.create_images(shot, grown)
    data.materials.append(
        material.build(
            shot, stage, images, fields.orthophoto_images(shot), fields.land_use_images(shot), globe=picture
        )
    )
    buildings.build(shot, stage, images)
    if shot.beyond:
        globe.build(shot, stage, collection, picture)
    return owned.add(collection, "Ground", data)


def make_shape(shot: Shot) -> Shape:
    """Return vertices by fractional row and column (n,), and triangles (m, 3), as fine as cameras resolve."""
    ground, wanted = shot.ground, mesh_tolerance.wanted(shot)
    return terrain.mesh(
        wanted.place,
        wanted.tolerance,
        wanted.fine,
        ground.surface,
        ground.eyes,
        ground.near_radius,
        ground.fields.margin,
    )


def cut_out_tiles(
    shot: Shot, row: NDArray[np.float64], column: NDArray[np.float64], triangles: NDArray[np.int32]
) -> Shape:
    """Return a shape without the triangles under 3D Tiles, except a seam along the tiles' border."""
    cut, tiles = tile_cut.of_shot(shot), tile_cut.heights(shot)
    if cut is None or tiles is None:
        return row, column, triangles
    place = shot.ground.frame.forward(*shot.ground.places(row, column), shot.ground.height(row, column))[
        :, :2
    ]
    seam = _SEAM * tiles.resolution
    around = [np.array(way) * seam for way in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))]
    covered = np.logical_and.reduce([np.isfinite(tiles.up(*(place + way).T)) for way in around])
    inside = covered[triangles].all(axis=1)
    inside &= np.isfinite(tiles.up(*place[triangles].mean(axis=1).T))
    left, kept = np.unique(triangles[~inside], return_inverse=True)
    return row[left], column[left], kept.reshape(-1, 3).astype(np.int32)
