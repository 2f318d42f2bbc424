"""Granite outcrops: slabs with joints, blocks of talus below them, sand and brush in the hollows."""

from __future__ import annotations

from ...blender import nodes
from .. import granite
from .shading_inputs import GroundInputs


def look(tree: nodes.Tree, place: GroundInputs) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and height (m)."""
    noise = place.grain.noise
    stone, height = granite.face(tree, place.position, place.pixel)
    broad = noise(64.0, 6.0, 0.68)
    stone = tree.mix_colour(
        1.0,
        stone,
        tree.mix_colour(broad.smoothstep(0.3, 0.7), (0.60, 0.60, 0.62), (1.12, 1.08, 1.0)),
        "MULTIPLY",
    )
    upright = place.grain.at(tree.vector("MULTIPLY", place.position, (1.0, 1.0, 0.25)))
    stain = upright.noise(90.0, 3.0)
    stone = tree.mix_colour(stain.smoothstep(0.5, 0.75) * 0.6, stone, (0.060, 0.050, 0.040))
    joints = granite.joints(tree, place.position, broad - 0.5, place.pixel)
    stone = tree.mix_colour(joints * 0.75, stone, (0.024, 0.022, 0.018))
    block = tree.cells(place.position, 2.4, "Color")
    bright = place.pixel.ramp(0.6, 2.4, tree.separate(block)[0], 0.5)
    debris = tree.mix_colour(bright, (0.055, 0.053, 0.050), (0.205, 0.195, 0.180))
    afar = place.pixel.ramp(0.05, 0.40)  # blocks and brush close by are instanced
    talus = place.slope.smoothstep(0.03, 0.10) * broad.smoothstep(0.49, 0.56) * afar
    stone = tree.mix_colour(talus, stone, debris)
    hollow = noise(26.0, 5.0, 0.68)
    sand = tree.mix_colour(broad, (0.105, 0.086, 0.060), (0.165, 0.140, 0.104))
    stone = tree.mix_colour((hollow - broad * 0.25).smoothstep(0.40, 0.47) * 0.85, stone, sand)
    brush = (hollow + joints * 0.07).smoothstep(0.555, 0.60) * (0.2 + afar * 0.8)
    stone = tree.mix_colour(brush * 0.88, stone, (0.030, 0.038, 0.018))
    stone = tree.mix_colour(place.burned * 0.45, stone, (0.045, 0.042, 0.040))
    return stone, height + noise(9.0, 4.0, 0.6) * 3.0
