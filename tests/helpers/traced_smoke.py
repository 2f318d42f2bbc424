"""Reference material of a flow's smoke: Cycles traces the light, in as many bounces as the scene allows."""

from firetwin.blender import nodes
from firetwin.scene import haze
from firetwin.scene.smoke import flow_material
from firetwin.scene.smoke.material import smoke_shader

MIDDLE = (0.86, 0.83, 0.79)
"""Albedo for light that arrives through other smoke."""
HIDDEN = 30.0


def build(shot, stage):
    """Build "Traced Smoke", with the colours of the product's material."""
    solved = next(node for node in flow_material.build(shot, stage).node_tree.nodes if node.type == "GROUP")
    fresh, old = (tuple(solved.inputs[f"{age} Colour"].default_value[:3]) for age in ("Fresh", "Old"))
    look, tree = nodes.material("Traced Smoke")
    density = tree.attribute("density")
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    seen = density * (1.0 + tree.attribute("hidden") * camera * HIDDEN)
    part, air = haze.fraction(tree, stage)
    albedo = tree.mix_colour(part, tree.mix_colour(tree.attribute("fresh"), old, fresh), (0.0, 0.0, 0.0))
    even = flow_material.FORWARD
    detailed = tree.add_shader(smoke_shader(tree, seen, albedo, even), tree.emission(air, part * seen))
    tree.volume(tree.mix_shader(camera, smoke_shader(tree, density, MIDDLE, even), detailed))
    look.cycles.volume_sampling = "DISTANCE"
    return look
