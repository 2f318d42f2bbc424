"""Materials of labels: uniform emission for letters, dark outline; both fade to transparent."""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...shot.light import exposure
from ...shot.shot import Shot

FADE = "fade"
RIM = "Rim"
COVER = "Firetwin Text"
"""AOV of the coverage of a pixel by labels and signs; layers of text, such as letters on a plate, add up."""
COLOURS = {"Letters": (0.95, 0.95, 0.92), RIM: (0.004, 0.004, 0.005)}
_LIGHT = 2.0  # radiance at exposure 0 that AgX shows nearly white, and that does not bloom
_SOLID = 0.999  # opacity of letters; at 1 they would count as a surface in depth
_CLEAR = 0.05  # transparency of the outline, and of plates, through which other text would be seen


def build(
    shot: Shot,
    name: str,
    colour: tuple[float, float, float],
    title: str = "Labels",
    whose: str = "INSTANCER",
) -> bpy.types.Material:
    """Build "Firetwin <title> <name>", equally bright in a picture by night and by day.

    Parameters
    ----------
    whose
        Domain of the attribute `FADE`: INSTANCER (the point of the instance) or GEOMETRY.
    """
    material, tree = nodes.material(f"Firetwin {title} {name}", colour)
    shown = tree.input("Colour", colour, "Colour in the picture", "Label")
    bright = tree.input(
        "Brightness", brightness(shot), "Radiance, compensated for the exposure of the picture", "Label"
    )
    solid = 1.0 - _CLEAR if name == RIM else _SOLID
    part = tree.attribute(FADE, whose) * solid
    write_place(tree, part)
    left = 1.0 - part  # a sum, as rays would sample one shader of a mix, which is noisy
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": tree.combine(left, left, left)})
    tree.surface(tree.add_shader(tree.emission(shown, bright * part), clear))
    material.cycles.emission_sampling = "NONE"
    return material


def brightness(shot: Shot) -> float:
    """Return the radiance of white letters: equally bright in pictures of all exposures."""
    return _LIGHT * 2.0 ** -exposure.middle(shot)


def write_place(tree: nodes.Tree, part: nodes.Value | float) -> None:
    """Write coverage and distance of text to its AOVs.

    Values of all text along a ray add up, so distances have weights by which the nearest counts most.
    """
    tree.aov(COVER, part, colour=False)
    near = 1000.0 / tree.output("ShaderNodeCameraData", name="View Distance")
    nodes.flames(tree, near.power(8.0) * part, 0.0, 0.0)
