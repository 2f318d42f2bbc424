"""What the ground's material knows about a point: its place, its fields, and what the fire did there."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...blender import nodes
from ...shot.fire import emissions
from ...shot.shot import Shot
from .. import granite
from ..band_limited_noise import Grain
from . import fields

_OWN = 1.25  # times the distance to which trees are drawn: from there on the canopy is the ground's
_HILLS = 0.5  # of the deviation of the run's heights, are hills finer than the apron's mesh (by eye)
_JITTER = 130.0  # s, at most; breaks the straight edges of the mesh's triangles
_STRAY = 0.7  # cells of the fuel grid that the front strays from their arrival times, at most
_RAGGED = 74.0  # m, cells whose edges noise of its full size breaks
_SOME = 0.02  # of the smoke, from which grass and shrubs are drawn in ways of their own
_TIMBER = 120.0  # s that flames stand over a spot of timber


@dataclass
class Place:
    """A point of the ground; what is noise in it is as fine as `grain`."""

    grain: Grain
    position: nodes.Value
    slope: nodes.Value  # 0 flat, 1 vertical
    canopy: nodes.Value  # kg/m2
    bare: nodes.Value  # 0..1, part of the ground nearby without fuel
    elevation: nodes.Value  # m
    distance: nodes.Value  # m from the camera
    near: nodes.Value  # 1 where trees are drawn one by one
    age: nodes.Value  # s since the fire came, negative before
    burned: nodes.Value  # 0 or 1
    pixel: nodes.Value  # m
    speed: nodes.Value  # m/s, of the front
    residence: nodes.Value  # s that flames stood there
    woody: nodes.Value  # 0 grass .. 1 timber
    ash: nodes.Value  # 0..1, how pale what is left is
    scale: float  # of the front's and the scar's patterns, 1 in a crown fire
    mixed: bool  # whether grass or shrubs burn, and not timber alone
    beyond: nodes.Value  # 0 within the run, 1 where the cells of the apron are large
    relief: float  # m, of hills that the apron's mesh is too coarse for
    shrub: nodes.Value  # 0..1, part of open land under bushes; 0 in the Sierra, where all of it is noise
    hollow: nodes.Value  # -1 crests to 1 hollows; as well
    free: nodes.Value  # 1 where no map says what there is, so that fields and tracks may be invented
    duff: nodes.Value  # -1..1, grain of the soil, of needles and of ash; 0 where pixels are larger

    def coarser(self, least: float) -> Place:
        """The same with noise of at least so many pixels, for other branches of the shader.

        Cycles works out what branches share before it knows which of them it needs. Noise whose octaves
        differ is not shared.
        """
        return replace(self, grain=self.grain.coarser(least))


def gather(tree: nodes.Tree, known: fields.Fields, shot: Shot, *, whole: bool) -> Place:
    """A point, with noise in all of its octaves (`whole`) or in those that a picture can show.

    Both in one material cost no more than one of them, as long as they are in different branches of it.
    """
    radius = shot.settings.forest.draw_distance
    geometry = tree.node("ShaderNodeNewGeometry")
    position = tree.pick(geometry, "Position")
    slope = 1.0 - tree.separate(tree.pick(geometry, "True Normal"))[2]
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    pixel = granite.pixel(tree, shot, distance)
    grain = Grain(tree, position, None if whole else pixel)
    cell = max(shot.bare_ground.cell)
    fine = min(1.0, cell / _RAGGED)
    wander = grain.noise(170.0 * fine, 2.0) + grain.noise(1100.0 * fine, 1.0) - 1.0
    speed, residence = known["speed"], known["residence"]
    stray = tree.math("MINIMUM", _STRAY * cell / tree.math("MAXIMUM", speed, 0.01), _JITTER)
    age = nodes.model_time(tree) - known["burn_time"] + wander * (2.0 * stray)
    edge = known["burned"] + (grain.noise(120.0 * fine, 3.0 - round(math.log2(fine))) - 0.5) * 0.8
    woody = residence.ramp(15.0, _TIMBER, 0.0, 1.0)
    mixed = shot.fire.smoke.shares[[emissions.GRASS, emissions.SHRUB]].sum() > _SOME
    if mixed:
        edge = edge - _left_out(grain, speed, woody, shot.front_scale)
    return Place(
        grain,
        position,
        slope,
        known["canopy_fuel"],
        known["bare"],
        tree.attribute("elevation"),
        distance,
        known["stand"] * distance.ramp(max(radius, 1.0), _OWN * max(radius, 1.0), 1.0, 0.0),
        age,
        (age > 0.0) * (edge > 0.5),
        pixel,
        speed,
        residence,
        woody,
        known["ash"],
        shot.front_scale,
        mixed,
        known.beyond,
        _HILLS * float(np.std(shot.run.elevation[np.isfinite(shot.run.elevation)])),
        known["shrub"],
        known["hollow"],
        1.0 - known["mapped"],
        granite.fine(tree, position, 0.6, 5.0, pixel, 0.72),
    )


def _left_out(grain: Grain, speed: nodes.Value, woody: nodes.Value, scale: float) -> nodes.Value:
    """More than 0 in tufts and strips of grass and shrubs that a front leaves out, most where it is slow."""
    tufts = grain.noise(45.0 * scale, 5.0, 0.66)
    weak = speed.ramp(0.03, 0.5, 0.08, 0.0)
    return (tufts + weak).smoothstep(0.66, 0.74) * (1.0 - woody).smoothstep(0.0, 0.4)


def rock(tree: nodes.Tree, place: Place, outcrops: float = 1.0) -> nodes.Value:
    """Bare rock 0..1: where nothing grows, on cliffs, and in outcrops that grow commoner with height."""
    ragged = place.grain.noise(260.0, 6.0, 0.66)
    bare = (place.bare + (ragged - 0.5) * 1.7).smoothstep(0.42, 0.58) * (place.bare > 0.02)
    cliff = (place.slope + (ragged - 0.5) * 0.35).smoothstep(0.27, 0.36)
    high = (ragged + place.elevation.ramp(1300.0, 2700.0, -0.12, 0.12)).smoothstep(0.66, 0.74)
    return tree.math("MAXIMUM", bare, tree.math("MAXIMUM", cliff, high * (0.9 * outcrops)))
