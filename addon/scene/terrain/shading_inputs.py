"""Shading inputs of the ground's material at a point: position, fields, and fire effects."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...blender import nodes
from ...shot.fire import emissions
from ...shot.shot import Shot
from .. import granite
from ..band_limited_noise import Grain
from ..forest.visibility import TREES_END
from . import fields

_HILLS = 0.5  # factor on the deviation of the run's terrain: hills finer than the apron's mesh (by eye)
_JITTER = 130.0  # s, maximum; breaks up the straight edges of the mesh's triangles
_STRAY = 0.7  # cells of the fuel grid, maximum displacement of the front by noise
_RAGGED = 74.0  # m, cell size at which noise displaces the front in full
_SOME = 0.02  # seed offsets, so that grass and shrubs have separate patterns
_PATCHY = (
    60.0,
    900.0,
)  # kW/m, intensities below which half of a wood and above which none stays unburned (by eye)
_TIMBER = 120.0  # s, residence time of flames over a spot of timber


@dataclass
class GroundInputs:
    """A point of the ground; its noise is band-limited by `grain`."""

    grain: Grain
    position: nodes.Value
    slope: nodes.Value  # 0 flat, 1 vertical
    canopy: nodes.Value  # kg/m2
    bare: nodes.Value  # 0..1, fraction of the ground nearby without fuel
    elevation: nodes.Value  # m
    distance: nodes.Value  # m from the camera
    near: nodes.Value  # 1 where trees are instanced
    age: nodes.Value  # s since arrival, negative before
    burned: nodes.Value  # 0 or 1
    pixel: nodes.Value  # m
    speed: nodes.Value  # m/s, of the front
    residence: nodes.Value  # s, residence time of flames
    woody: nodes.Value  # 0 grass .. 1 timber
    ash: nodes.Value  # 0..1, brightness of the residue
    heat: nodes.Value  # ln(kW/m), fireline intensity
    load: nodes.Value  # kg/m2, surface fuel
    scale: float  # of the front's and the scar's patterns, 1 in a crown fire
    mixed: bool  # True if grass or shrubs burn, and not only timber
    beyond: nodes.Value  # 0 within the run, 1 where the apron's cells have their full size
    relief: float  # m, height of hills below the resolution of the apron's mesh
    shrub: nodes.Value  # 0..1, shrub cover of open land; 0 in the Sierra, which uses noise
    hollow: nodes.Value  # -1 crests to 1 hollows; 0 in the Sierra
    free: nodes.Value  # 1 if no map has data there, so fields and tracks may be procedural
    duff: nodes.Value  # -1..1, texture of soil, needles and ash; 0 where pixels are larger

    def coarser(self, least: float) -> GroundInputs:
        """Return the same point with noise of at least `least` pixels, for other branches of the shader.

        Cycles evaluates nodes that branches share before it knows which branch it needs. Noise with different
        octaves is not shared.
        """
        return replace(self, grain=self.grain.coarser(least))


def gather(tree: nodes.Tree, ground_fields: fields.Fields, shot: Shot, *, whole: bool) -> GroundInputs:
    """Gather shading inputs at a point, with noise in all octaves (`whole`) or band-limited to the picture.

    Both in the same material cost no more than one of them, if they are in different branches.
    """
    radius = shot.settings.forest.draw_distance
    geometry = tree.node("ShaderNodeNewGeometry")
    position = tree.pick(geometry, "Position")
    slope = 1.0 - tree.separate(tree.pick(geometry, "True Normal"))[2]
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    pixel = granite.pixel_size(shot, distance)
    grain = Grain(tree, position, None if whole else pixel)
    cell = max(shot.bare_ground.cell)
    fine = min(1.0, cell / _RAGGED)
    wander = grain.noise(170.0 * fine, 2.0) + grain.noise(1100.0 * fine, 1.0) - 1.0
    speed, residence = ground_fields["speed"], ground_fields["residence"]
    stray = tree.math("MINIMUM", _STRAY * cell / tree.math("MAXIMUM", speed, 0.01), _JITTER)
    age = nodes.model_time(tree) - ground_fields["burn_time"] + wander * (2.0 * stray)
    edge = ground_fields["burned"] + (grain.noise(120.0 * fine, 3.0 - round(math.log2(fine))) - 0.5) * 0.8
    woody = residence.ramp(15.0, _TIMBER, 0.0, 1.0)
    mixed = shot.fire.smoke.shares[[emissions.GRASS, emissions.SHRUB]].sum() > _SOME
    edge = edge - _unburned_patches(grain, ground_fields["heat"], woody)
    if mixed:
        edge = edge - _unburned_islands(grain, speed, woody, shot.front_scale)
    return GroundInputs(
        grain,
        position,
        slope,
        ground_fields["canopy_fuel"],
        ground_fields["bare"],
        tree.attribute("elevation"),
        distance,
        ground_fields["stand"] * distance.ramp(max(radius, 1.0), TREES_END * max(radius, 1.0), 1.0, 0.0),
        age,
        (age > 0.0) * (edge > 0.5),
        pixel,
        speed,
        residence,
        woody,
        ground_fields["ash"],
        ground_fields["heat"],
        ground_fields["load"],
        shot.front_scale,
        mixed,
        ground_fields.beyond,
        _HILLS * float(np.std(shot.run.elevation[np.isfinite(shot.run.elevation)])),
        ground_fields["shrub"],
        ground_fields["hollow"],
        1.0 - ground_fields["mapped"],
        granite.filtered_noise(tree, position, 0.6, 5.0, pixel, 0.72),
    )


def _unburned_patches(grain: Grain, heat: nodes.Value, woody: nodes.Value) -> nodes.Value:
    """Return unburned fingers and islands of woods: above 0 where the intensity is low, most at the edges."""
    low, high = np.log(_PATCHY)
    weak = heat.ramp(low, high, 1.0, 0.0) * woody.smoothstep(0.5, 1.0)
    return (grain.noise(260.0, 5.0, 0.64) + weak * 0.16).smoothstep(0.64, 0.71) * weak


def _unburned_islands(grain: Grain, speed: nodes.Value, woody: nodes.Value, scale: float) -> nodes.Value:
    """Return unburned islands: above 0 in tufts and strips of grass and shrubs, most for a slow front."""
    tufts = grain.noise(45.0 * scale, 5.0, 0.66)
    weak = speed.ramp(0.03, 0.5, 0.08, 0.0)
    return (tufts + weak).smoothstep(0.66, 0.74) * (1.0 - woody).smoothstep(0.0, 0.4)


def bare_rock(tree: nodes.Tree, place: GroundInputs, outcrops: float = 1.0) -> nodes.Value:
    """Return bare rock 0..1: no vegetation, cliffs, and outcrops, more frequent at high elevation."""
    ragged = place.grain.noise(260.0, 6.0, 0.66)
    bare = (place.bare + (ragged - 0.5) * 1.7).smoothstep(0.42, 0.58) * (place.bare > 0.02)
    cliff = (place.slope + (ragged - 0.5) * 0.35).smoothstep(0.27, 0.36)
    high = (ragged + place.elevation.ramp(1300.0, 2700.0, -0.12, 0.12)).smoothstep(0.66, 0.74)
    return tree.math("MAXIMUM", bare, tree.math("MAXIMUM", cliff, high * (0.9 * outcrops)))
