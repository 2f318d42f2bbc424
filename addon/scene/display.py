"""Colours of the scene in Blender's solid view, where no shader is evaluated; renders ignore them."""

from __future__ import annotations

import bpy

_COLOURS = {  # red, green, blue in the view
    "Firetwin Ground": (0.30, 0.26, 0.17),
    "Firetwin Foliage": (0.16, 0.32, 0.10),
    "Firetwin Bark": (0.12, 0.08, 0.05),
    "Firetwin Snag": (0.05, 0.05, 0.05),
    "Firetwin Grass": (0.42, 0.38, 0.16),
    "Firetwin Flame": (1.00, 0.25, 0.02),
}


def build() -> None:
    """Give every material of the scene its colour."""
    for name, colour in _COLOURS.items():
        material = bpy.data.materials.get(name)
        if material is not None:
            material.diffuse_color = (*colour, 1.0)
            material.roughness = 1.0
