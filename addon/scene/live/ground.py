"""Live ground: one mesh that is finer near the viewers, with a picture of its colours and one of the fire.

The picture of the fire holds arrival times: the shader compares them with the scene's time, so a frame change
uploads nothing.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import terrain
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.surface import mesh_tolerance
from .. import haze
from ..terrain import fields, ground_picture
from . import burning, viewers
from .shade import Shade

_FINEST, _COARSEST = 0.25, 60.0  # m, vertical errors of the mesh
_FIRST, _MORE = 0.001, 1.5  # error over distance that is tried first; factor until the budget is met
_NEVER = 1.0e7  # s
_TONES = ((3.0, 0.75), (23.0, 0.5), (190.0, 0.35))  # m, sizes of variation in colour, and strengths (by eye)
_FADE = 120.0  # sizes of variation at the distance where it ends


def build(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, budget: int, shade: Shade | None
) -> bpy.types.Object:
    """Build "Firetwin Live Ground", of at most `budget` triangles."""
    ground = shot.ground
    row, column, triangles = shape(shot, budget)
    latitude, longitude = ground.places(row, column)
    coarse = ground.frame.forward(latitude, longitude, ground.height(row, column))
    height = ground.height(row, column, ground.detail(*coarse.T))
    data = create_mesh("Firetwin Live Ground", ground.frame.forward(latitude, longitude, height), triangles)
    place = fields.texture_coordinates(ground.shape, row, column, ground.fields.margin)
    add_attribute(data, fields.GRID, "FLOAT_VECTOR", place)
    data.materials.append(_material(shot, stage, shade))
    obj = owned.add(collection, "Live Ground", data)
    obj.visible_shadow = False
    return obj


def shape(shot: Shot, budget: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Return vertices by fractional row and column (n,), and triangles (m, 3), at most `budget`."""
    ground, wanted = shot.ground, mesh_tolerance.wanted(shot)
    away, part = viewers.distance(shot, wanted.place), _FIRST
    while True:
        tolerance = np.clip(part * away, _FINEST, _COARSEST * part / _FIRST).astype(np.float32)
        mesh = terrain.mesh(
            wanted.place,
            tolerance,
            wanted.fine,
            ground.surface,
            ground.eyes,
            ground.near_radius,
            ground.fields.margin,
        )
        if len(mesh[2]) <= budget or part > 1.0:
            return mesh
        part *= max(_MORE, np.sqrt(len(mesh[2]) / budget))


def _material(shot: Shot, stage: Stage, shade: Shade | None) -> bpy.types.Material:
    """Build "Firetwin Live Ground": colours, scar, flaming front, embers, and light of flames."""
    material, tree = nodes.material("Firetwin Live Ground", (0.30, 0.26, 0.17))
    at = tree.attribute(fields.GRID, output="Vector")
    picture = tree.output("ShaderNodeTexImage", {"Vector": at}, image=_colours(shot), extension="EXTEND")
    arrival, burned, speed = tree.separate(
        tree.output("ShaderNodeTexImage", {"Vector": at}, image=_fire(shot), extension="EXTEND")
    )
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    tones = [tree.noise(position, size, 2.0, 0.6) for size, _ in _TONES]
    tone: nodes.Value | float = 1.0
    for noise, (size, strength) in zip(tones, _TONES, strict=True):
        shown = distance.ramp(0.3 * _FADE * size, _FADE * size, 2.0 * strength, 0.0)
        tone = tone + (noise - 0.5) * shown
    age = nodes.model_time(tree) - arrival + (tones[1] - 0.5) * burning.RAGGED
    there = (age > 0.0) * ((burned + (tones[1] - 0.5) * 0.6) > 0.5)
    scar = burning.scar_colour(tree, tones[0], tones[1], age)
    colour = tree.mix_colour(there, picture, scar)
    colour = tree.vector("SCALE", colour, tree.math("MAXIMUM", tone, 0.2))
    if shade is not None:
        colour = shade.apply(tree, colour, position)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    light = burning.front_light(tree, shot, tones[0], age, speed, distance)
    lit = tree.vector("MULTIPLY", colour, burning.light_of_flames(tree, shot, age, speed))
    shining = tree.vector("SCALE", tree.vector("ADD", light, lit), burned)
    tree.surface(haze.apply(tree, tree.add_shader(matt, tree.emission(shining)), stage))
    return material


def _colours(shot: Shot) -> bpy.types.Image:
    """Create the picture of the unburned ground, in 8 bits, packed into the .blend file."""
    (picture,) = ground_picture.paint(shot, np.array([-np.inf]))
    pixels = np.ones((*picture.shape[:2], 4), np.float32)
    pixels[..., :3] = picture[::-1] / np.float32(255.0)
    return fields.byte_image("Firetwin Live Ground Colours", pixels)


def _fire(shot: Shot) -> bpy.types.Image:
    """Create the picture of the fire: arrival time (s), 1 where it burned, and rate of spread (m/s)."""
    ground = shot.ground
    known = np.minimum(ground.burn_time, _NEVER), ground.burned, shot.front.speed
    size = fields.block_size(ground.shape)
    thin = [fields.downsample(np.asarray(each, np.float64), size) for each in known]
    return fields.float_image("Firetwin Live Fire", thin)
