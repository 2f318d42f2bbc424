"""Granite of the Sierra: texture of its faces from centimetres up, and joints across outcrops.

Reflectances are display colours, chosen by eye against photographs. Detail below a pixel is filtered: octaves
of noise are cut off there, and lines fade to their mean.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..blender import nodes
from ..shot.shot import Shot

_LIGHT, _GREY = (0.205, 0.196, 0.180), (0.090, 0.087, 0.082)
_DARK = (0.026, 0.025, 0.022)  # joints, and streaks of water and black lichen
_LICHEN = (0.095, 0.098, 0.062)
_SETS = ((0.36, 13.0), (1.83, 21.0))  # joints: direction (rad) and spacing (m)


def pixel_size(shot: Shot, distance: nodes.Value) -> nodes.Value:
    """Return the pixel size (m) of the sharpest camera at a `distance` (m) from the camera."""
    near, parallel = shot.pixel
    least = min(parallel, 1.0e4)
    return distance * near if np.isfinite(near) else distance * 0.0 + least


def filtered_noise(
    tree: nodes.Tree, position: Any, size: float, octaves: float, pixel: nodes.Value, roughness: float = 0.6
) -> nodes.Value:
    """Return noise -1..1 of wavelength `size` m, band-limited to the pixel: 0 far away.

    Blender divides a sum of octaves by the sum of their weights. The result is multiplied by that sum again,
    and divided by the sum of the weights of all octaves, so the amplitudes are unfiltered.
    """
    left = tree.math("LOGARITHM", size / (pixel * 2.0), 2.0)
    detail = tree.math("MINIMUM", tree.math("MAXIMUM", left, 0.0), octaves)
    noise = tree.noise(position, size, detail, roughness)
    part = 1.0 - tree.math("POWER", roughness, detail + 1.0)
    fade = left.ramp(-1.0, 0.0, 0.0, 2.0 / (1.0 - roughness ** (octaves + 1.0)))
    return (noise - 0.5) * part * fade


def face(tree: nodes.Tree, position: Any, pixel: nodes.Value) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and height (m) of a granite face: grain, stains and lichen."""
    grain = filtered_noise(tree, position, 0.7, 5.0, pixel, 0.7)
    patches = filtered_noise(tree, position, 3.2, 3.0, pixel)
    stone = tree.mix_colour((grain * 1.1 + patches * 0.6).ramp(-0.5, 0.5), _GREY, _LIGHT)
    lichen = (patches + grain * 0.7).smoothstep(0.16, 0.30)
    stone = tree.mix_colour(lichen * 0.55, stone, _LICHEN)
    black = (grain * 0.8 - patches).smoothstep(0.22, 0.34)
    return tree.mix_colour(black * 0.6, stone, _DARK), grain * 0.10 + patches * 0.35


def joints(tree: nodes.Tree, position: Any, warp: nodes.Value, pixel: nodes.Value) -> nodes.Value:
    """Return joints 0..1: two sets of nearly parallel cracks a third of a metre wide, bent by `warp`."""
    x, y, z = tree.separate(position)
    wide = tree.math("MAXIMUM", pixel * 0.7, 0.3)
    strength = 0.3 / wide
    both = None
    for angle, apart in _SETS:
        along = x * float(np.cos(angle)) + y * float(np.sin(angle)) + z * 0.4
        off = tree.math("PINGPONG", along + warp * (1.3 * apart), 0.5 * apart)  # m, distance to a joint
        line = off.smoothstep(wide * 1.6, wide * 0.3)
        both = line if both is None else tree.math("MAXIMUM", both, line)
    return both * tree.math("POWER", strength, 0.5)
