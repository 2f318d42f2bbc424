"""Materials of trees: needles and leaves that live, torch, scorch and char, bark, and grass.

What differs from tree to tree comes from its point: `arrival_time` (s), `tint`, `dead` (0..1), `elevation`.
"""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import haze, temperature
from ..glow import FLAME

TORCHING = 350.0  # s that a crown is in flames
_FLAME_LIGHT = 2.5  # radiance at exposure 0; crowns near by fill pixels
_DEAD = 0.07  # part of the trees that stood dead and brown before


def foliage(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Foliage"."""
    material, tree = nodes.material("Firetwin Foliage", (0.16, 0.32, 0.10))
    tint = tree.attribute("tint", "INSTANCER")
    green = tree.mix_colour(tint, (0.022, 0.040, 0.015), (0.068, 0.090, 0.032))
    brown = tree.mix_colour(tint, (0.085, 0.048, 0.022), (0.125, 0.080, 0.042))
    living = tree.mix_colour(tree.attribute("dead", "INSTANCER") < _DEAD, green, brown)
    _leaves(tree, shot, stage, living, _rounded(tree))
    material.cycles.emission_sampling = "NONE"
    return material


def bark(shot: Shot, stage: Stage, *, charred: bool) -> bpy.types.Material:
    """Build "Firetwin Bark", or the char of snags."""
    name, shown = ("Snag", (0.05, 0.05, 0.05)) if charred else ("Bark", (0.12, 0.08, 0.05))
    material, tree = nodes.material(f"Firetwin {name}", shown)
    material.cycles.emission_sampling = "NONE"
    tint = tree.attribute("tint", "INSTANCER")
    brown = tree.mix_colour(tint, (0.070, 0.046, 0.030), (0.115, 0.075, 0.048))
    black = tree.mix_colour(tint, (0.010, 0.009, 0.009), (0.045, 0.040, 0.036))
    age = _age(tree)
    colour = black if charred else tree.mix_colour(age > 60.0, brown, black)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    ambient = temperature.ambient(tree, shot, tree.attribute("elevation", "INSTANCER"), 1.0)
    kelvin = temperature.cooling(tree, ambient, age, age > 0.0)
    tree.surface(nodes.thermal_switch(tree, haze.apply(tree, matt, stage), kelvin))
    return material


def grass(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Grass": dry in September, burned to the ground by the fire."""
    material, tree = nodes.material("Firetwin Grass", (0.42, 0.38, 0.16))
    tint = tree.attribute("tint", "INSTANCER")
    dry = tree.mix_colour(tint, (0.150, 0.115, 0.055), (0.060, 0.065, 0.028))
    normal = tree.output("ShaderNodeNewGeometry", name="Normal")
    _leaves(tree, shot, stage, dry, normal)
    material.cycles.emission_sampling = "NONE"
    return material


def _age(tree: nodes.Tree) -> nodes.Value:
    return nodes.model_time(tree) - tree.attribute("arrival_time", "INSTANCER")


def _rounded(tree: nodes.Tree) -> nodes.Value:
    """Normals that point outwards from the trunk, so that a crown has a sunlit and a shaded side."""
    geometry = tree.node("ShaderNodeNewGeometry")
    local = tree.output(
        "ShaderNodeVectorTransform",
        [tree.pick(geometry, "Position")],
        vector_type="POINT",
        convert_from="WORLD",
        convert_to="OBJECT",
    )
    x, y, z = tree.separate(local)
    radial = tree.output(
        "ShaderNodeVectorTransform",
        [tree.vector("NORMALIZE", tree.combine(x, y, 0.05 + z * 0.04))],
        vector_type="VECTOR",
        convert_from="OBJECT",
        convert_to="WORLD",
    )
    facing = tree.vector("NORMALIZE", radial)
    own = tree.vector("MULTIPLY", tree.pick(geometry, "Normal"), (0.55, 0.55, 0.55))
    return tree.vector("NORMALIZE", tree.vector("ADD", facing, own))


def _leaves(tree: nodes.Tree, shot: Shot, stage: Stage, living: nodes.Value, normal: nodes.Value) -> None:
    """Finish a leaf material whose colour before the fire is `living`."""
    age = _age(tree)
    scorched = tree.mix_colour(
        tree.attribute("dead", "INSTANCER"), (0.018, 0.013, 0.010), (0.070, 0.042, 0.022)
    )
    colour = tree.mix_colour(age.smoothstep(20.0, 200.0), living, scorched)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Normal": normal})
    through = tree.output("ShaderNodeBsdfTranslucent", {"Color": colour, "Normal": normal})
    leaf = tree.mix_shader(0.22, matt, through)
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    flicker = tree.noise(tree.vector("ADD", position, tree.combine(0.0, 0.0, age * -6.0)), 4.0, 2.0)
    flaming = (
        age.smoothstep(0.0, 40.0) * age.smoothstep(TORCHING, 0.4 * TORCHING) * flicker.smoothstep(0.4, 0.6)
    )
    burning = tree.add_shader(leaf, tree.emission(FLAME, flaming * _FLAME_LIGHT))
    ambient = temperature.ambient(tree, shot, tree.attribute("elevation", "INSTANCER"), 1.0)
    kelvin = temperature.burning(tree, ambient, age, age > 0.0, flaming, 0.0)
    tree.surface(nodes.thermal_switch(tree, haze.apply(tree, burning, stage), kelvin))
