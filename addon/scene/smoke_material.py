"""Material of smoke: sharp cauliflower edges with detail below the voxel size, lit by sun and flames.

The grids are those of `firetwin_core.volume.write_smoke`. Where smoke ends is decided here: the clipped
distance field plus billow noise, through a narrow step. How thick it is comes from its mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from firetwin_core.run import Run

from .. import nodes
from ..project import Project
from . import bake, burning, clock, haze

EXTINCTION_PER_DILUTION = 0.04  # 1/m: 4 m2/g (fresh biomass smoke, Reid et al. 2005) times 10 mg/m3
ANISOTROPY = 0.33
_EDGE = (0.46, 0.55)  # of the clipped distance: 54 m from clear to full
_AMPLITUDE = 0.40  # of the noise in the distance, 1 = 600 m
_MEAN_BILLOW = 0.4
_PERIOD = 300.0  # s for which a layer of noise is carried along before it is drawn anew
_LOW, _HIGH = (0.62, 0.53, 0.44), (0.95, 0.945, 0.94)  # albedo near the ground and far up
_GLOW = (1.0, 0.30, 0.06)
_GLOW_LIGHT = 2.5  # radiance of thick smoke amid flames of 1 GW, exposure 0


@dataclass(frozen=True)
class Flow:
    """What carries the noise: wind 10 m over the ground (m/s), and the height of that ground (m)."""

    wind: tuple[float, float]
    ground: float


def flow(project: Project, run: Run) -> Flow:
    """Wind of the middle of the shot and the mean height of the ground that burns."""
    first, last = clock.window(project, run)
    cells = burning.cells(run, first - 3600.0, last)
    east, north = burning.wind_at(run, np.array([0.5 * (first + last)]))[0]
    height = float(np.mean(cells.position[:, 2])) if len(cells.arrival) else 1000.0
    return Flow((float(east), float(north)), height)


def build(project: Project, run: Run) -> bpy.types.Material:
    """Build "Firetwin Smoke"."""
    drawn = bake.resolution(project, run)
    carried = flow(project, run)
    material, tree = nodes.material("Firetwin Smoke")
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    above = tree.separate(position)[2] - carried.ground
    size = tree.attribute("size")
    billow = _billow(tree, position, above, carried, float(np.clip(4.5 * drawn.voxel, 260.0, 700.0)))
    reach = tree.math("MINIMUM", size * 0.8, _AMPLITUDE)  # small puffs must not be eaten up
    edge = (tree.attribute("density") + reach * (billow - _MEAN_BILLOW)).smoothstep(*_EDGE)
    thickness = tree.attribute("dilution") * (EXTINCTION_PER_DILUTION / drawn.extinction)
    density = edge * (1.0 - (-thickness).exp()) * drawn.extinction
    part, air = haze.fraction(tree)
    albedo = tree.mix_colour(above.smoothstep(-200.0, 3200.0), _LOW, _HIGH)
    seen = tree.mix_colour(part, albedo, (0.0, 0.0, 0.0))
    scatter = tree.output(
        "ShaderNodeVolumeScatter", {"Color": seen, "Density": density, "Anisotropy": ANISOTROPY}
    )
    absorb = tree.output("ShaderNodeVolumeAbsorption", {"Color": seen, "Density": density})
    glow = tree.emission(_GLOW, tree.attribute("glow") * density * (1.0 - part) * _GLOW_LIGHT)
    shader = tree.add_shader(tree.add_shader(scatter, absorb), glow)
    tree.volume(tree.add_shader(shader, tree.emission(air, part * density)))
    return material


def _billow(
    tree: nodes.Tree, position: nodes.Value, above: nodes.Value, carried: Flow, size: float
) -> nodes.Value:
    """Billow noise, about 0..1 with mean 0.4, that travels with the wind at its height.

    Two layers are carried along, each for _PERIOD seconds, and drawn anew while the other one shows (the
    flow maps of water surfaces): so it neither slides against the flow nor shears without end.
    """
    height = tree.math("MAXIMUM", above, 10.0)
    factor = (height / 10.0).power(1.0 / 7.0)  # the wind profile of the puffs
    velocity = tree.combine(factor * carried.wind[0], factor * carried.wind[1], 1.5)
    clock_value = nodes.model_time(tree) / _PERIOD
    layers = []
    for layer in (0, 1):
        phase = clock_value + 0.5 * layer
        turn = tree.math("FLOOR", phase)
        part = phase - turn
        age = (part - 0.5) * _PERIOD
        shift = tree.output("ShaderNodeVectorMath", {0: velocity, "Scale": age}, operation="SCALE")
        apart = tree.combine(turn * 7919.0 + 3571.0 * layer, turn * -5077.0, turn * 1543.0)
        moved = tree.vector("ADD", tree.vector("SUBTRACT", position, shift), apart)
        noise = tree.noise(moved, size, 5.0, 0.6)
        billow = tree.math("ABSOLUTE", noise * 2.0 - 1.0) * 2.0 - _MEAN_BILLOW
        weight = 1.0 - tree.math("ABSOLUTE", part * 2.0 - 1.0)
        layers.append((billow * weight, weight * weight))
    contrast = tree.math("SQRT", layers[0][1] + layers[1][1])
    return (layers[0][0] + layers[1][0]) / contrast + _MEAN_BILLOW
