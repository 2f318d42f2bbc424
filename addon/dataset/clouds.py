"""Clouds in the sky of a sample: a flat layer of noise in the world's shader, lit as a whole.

Clouds have white, thin edges and a grey inside. They cast no shadow; `air` dims the sun
under a cloudy sky. Haze hides them at the horizon.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..blender import nodes
from ..blender.owned import Stage
from ..shot.light import sky
from ..shot.shot import Shot
from .draw import Draw

_SIZE, _OCTAVES, _ROUGH = 0.9, 7.0, 0.52  # features relative to the height of the clouds (by eye)
_CLEAREST, _COVERED = 0.66, 0.38  # noise at the edge of clouds for a cover of 0 and 1 (by eye)
_SOFT = 0.05, 0.17  # noise from edge to opaque, and to the greyest (by eye)
_LOW = 0.015, 0.10  # sines of elevation between which haze gives way to clouds (by eye)
_SHARE = 0.30  # radiance relative to a white surface under sun and sky, as of smoke (`exposure_meter`)
_GREY = 0.55  # radiance of thick clouds relative to their edges (by eye)


def build(shot: Shot, stage: Stage, drawn: Draw) -> None:
    """Add clouds of the drawn cover to the sky, which `scene.light.build` has built for this sample."""
    if drawn.cloud_cover <= 0.0:
        return
    tree = nodes.Tree(stage.scene.world.node_tree)
    background = _visible_background(tree.node_tree)
    clear = nodes.Value(tree, background.inputs["Color"].links[0].from_socket)
    x, y, up = tree.separate(tree.output("ShaderNodeTexCoord", name="Generated"))
    far = 1.0 / tree.math("MAXIMUM", up, _LOW[0])
    start = np.random.default_rng(drawn.random_seed("clouds")).uniform(-500.0, 500.0, 2)
    place = tree.combine(x * far + float(start[0]), y * far + float(start[1]), 0.0)
    density = tree.noise(place, _SIZE, _OCTAVES, _ROUGH)
    edge = _CLEAREST + (_COVERED - _CLEAREST) * drawn.cloud_cover
    opaque = density.smoothstep(edge, edge + _SOFT[0]) * up.smoothstep(*_LOW)
    shade = density.smoothstep(edge, edge + _SOFT[1])
    light = sky.state(shot, drawn.time)
    white = _SHARE * (light.power * np.array(light.colour) * max(light.direction[2], 0.15) / np.pi * 2.0)
    white = white + light.sky_mean
    colour = tree.mix_colour(shade, tuple(white), tuple(_GREY * white))
    tree.connect(tree.mix_colour(opaque, clear, colour), background.inputs["Color"])


def _visible_background(tree: bpy.types.NodeTree) -> bpy.types.Node:
    """Return the background of the visible sky: the only one with a linked colour."""
    return next(
        node
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeBackground" and node.inputs["Color"].is_linked
    )
