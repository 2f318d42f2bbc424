"""Clouds in the sky of a sample: heaps at several distances, and a layer overhead, in the world's shader.

Heaps are noise on upright cylinders around the camera. They have flat bases at one height, round tops, a
side in the light and one in the shade, and thin edges that shine against the light. They cast no shadow;
`air` dims the sun under a cloudy sky.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..blender import nodes
from ..blender.nodes import Tree, Value
from ..blender.owned import Stage
from ..shot.light import sky
from ..shot.shot import Shot
from .draw import Draw

# Lengths are relative to the height of the bases; all numbers are by eye unless a line says more.
_DISTANCES = 2.5, 6.0, 14.0  # of the cylinders
_BASE = 1500.0  # m
_SIZE, _OCTAVES, _ROUGH = (0.6, 1.3), 5.0, 0.55  # of heaps; noise
_CLEAREST, _COVERED = 0.64, 0.36  # noise at the edge of clouds for a cover of 0 and 1
_HEIGHT, _ROUND = 1.1, 0.24  # of the highest heaps; rise of the edge up to there
_SOFT, _THICK = 0.06, 0.22  # noise from edge to opaque, and to the greyest
_FLAT = 0.05  # height over which a base begins
_ASIDE = 0.22  # distance towards the light at which noise is compared
_RELIEF = 4.5  # contrast of light and shade
_OVERHEAD = 0.28, 0.45  # sines of elevation between which the layer overhead replaces heaps
# optical depth to a heap relative to distance / visibility: less than 3.912, as air is clear above
_HAZE = 1.5
_SHARE = 0.30  # radiance relative to a white surface under sun and sky, as of smoke (`exposure_meter`)
_SHADE = 0.25  # radiance of the shade relative to the light
_DARKER = 0.35  # share of light that a closed cover takes
_BRIM = 0.7  # radiance of edges against the light, relative to the light


def build(shot: Shot, stage: Stage, drawn: Draw) -> None:
    """Add clouds of the drawn cover to the sky, which `scene.light.build` has built for this sample."""
    if drawn.cloud_cover <= 0.0:
        return
    tree = nodes.Tree(stage.scene.world.node_tree)
    background = _visible_background(tree.node_tree)
    colour = nodes.Value(tree, background.inputs["Color"].links[0].from_socket)
    for density, opacity in _Clouds(tree, shot, drawn).parts():
        colour = tree.mix_colour(opacity, colour, density)
    tree.connect(colour, background.inputs["Color"])


class _Clouds:
    """Noise, light and shade of a sample's clouds."""

    def __init__(self, tree: Tree, shot: Shot, drawn: Draw) -> None:
        self.tree, self.visibility = tree, drawn.visibility
        self.x, self.y, self.up = tree.separate(tree.output("ShaderNodeTexCoord", name="Generated"))
        random = np.random.default_rng(drawn.random_seed("clouds"))
        self.start = random.uniform(-500.0, 500.0, 3)
        self.size = float(np.exp(random.uniform(*np.log(_SIZE))))
        self.edge = _CLEAREST + (_COVERED - _CLEAREST) * drawn.cloud_cover
        light = sky.state(shot, drawn.time)
        self.toward = light.direction
        sun = light.power * np.array(light.colour) * max(light.direction[2], 0.15) / np.pi * 2.0
        self.white = (_SHARE * sun + light.sky_mean) * (1.0 - _DARKER * drawn.cloud_cover)

    def parts(self) -> list[tuple[Value, Value]]:
        """Return colour and opacity of all layers, the farthest first."""
        level = self.tree.math("SQRT", self.x * self.x + self.y * self.y) + 1.0e-4
        heaps = 1.0 - self.up.smoothstep(*_OVERHEAD)
        found = [self._heaps(far, level, heaps) for far in reversed(_DISTANCES)]
        return [*found, self._overhead(1.0 - heaps)]

    def _heaps(self, far: float, level: Value, shown: Value) -> tuple[Value, Value]:
        height = self.up / level * far
        wave = self.tree.noise(self.tree.combine(self.x, self.y, far), 0.35, 0.0)
        above = height - (0.75 + 0.5 * wave)
        share = (above / _HEIGHT).clamp()
        edge = self.edge + _ROUND * share.power(1.4)
        place = self.tree.combine(self.x / level * far, self.y / level * far, height)
        opaque = (
            above.smoothstep(0.0, _FLAT)
            * shown
            * float(np.exp(-_HAZE * far * _BASE / 1000.0 / self.visibility))
        )
        return self._lit(place, edge, opaque, share.ramp(0.0, 0.5, 0.25, 1.0))

    def _overhead(self, shown: Value) -> tuple[Value, Value]:
        far = 1.0 / self.tree.math("MAXIMUM", self.up, 0.1)
        place = self.tree.combine(self.x * far, self.y * far, 0.0)
        return self._lit(place, self.edge, shown, 0.5)

    def _lit(
        self, place: Value, edge: Value | float, shown: Value, bright: Value | float
    ) -> tuple[Value, Value]:
        """Return colour and opacity of noise above an edge; `bright` is the light of its place, 0 to 1."""
        density = self._noise(place, np.zeros(3), _OCTAVES)
        aside = self._noise(place, _ASIDE * self.size * self.toward, 2.0)
        opaque = density.smoothstep(edge, edge + _SOFT)
        thick = density.smoothstep(edge, edge + _THICK)
        relief = ((density - aside) * _RELIEF + 0.5).clamp()
        light = (relief * bright * 1.4 + _BRIM * (1.0 - thick) * 0.5).clamp()
        colour = self.tree.mix_colour(light, tuple(_SHADE * self.white), tuple(self.white))
        return colour, opaque * shown

    def _noise(self, place: Value, aside: np.ndarray, octaves: float) -> Value:
        moved = self.tree.vector("ADD", place, tuple((self.start + aside).tolist()))
        return self.tree.noise(moved, self.size, octaves, _ROUGH)


def _visible_background(tree: bpy.types.NodeTree) -> bpy.types.Node:
    """Return the background of the visible sky: the only one with a linked colour."""
    return next(
        node
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeBackground" and node.inputs["Color"].is_linked
    )
