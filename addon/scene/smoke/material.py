"""Material of a model's smoke: sharp billows with detail below the voxel size, lit by sun and flames.

The grids are written by `firetwin_core.volume.write_levels`. The outline is their `density` plus billow
noise, through a narrow step. Extinction comes from the smoke's mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.light import exposure, sky
from ...shot.shot import Shot
from ...smoke import view
from .. import haze, infrared

EXTINCTION_PER_DILUTION = 0.04  # 1/m: 4 m2/g (fresh biomass smoke, Reid et al. 2005) times 10 mg/m3
OPACITY = 5.0, 16.0  # factors for ash near the ground and for cloud water aloft; chosen by eye
_CLOUD = (700.0, 2600.0)  # m above the ground between which cloud water condenses
# single scattering has about 0.6; few bounces with a much lower value brighten thick smoke as many bounces do
ANISOTROPY = 0.1
_EDGE = (0.46, 0.55)  # clipped distance: 54 m from transparent to full extinction
_AMPLITUDE = 0.5  # amplitude of the noise in the distance, 1 = 600 m
_MEAN_BILLOW = 0.4
_ALOFT = 1.55  # wind at the height of smoke relative to 10 m: (h / 10 m)^0.1 at 800 m
_CLIMB = 1.0  # m/s
_VEIL = (0.002, 0.005)  # dilutions between which thin smoke fades; volumes end at the lower value
_PALE, _LOW = (0.84, 0.81, 0.77), (0.62, 0.53, 0.44)  # albedo near the ground: grass fire, crown fire
_HIGH = np.array([1.005, 1.0, 0.995])  # albedo aloft, relative to green light
_MIDDLE = (0.86, 0.83, 0.79)  # factor on light that reaches smoke through other smoke


Colour = tuple[float, float, float]


@dataclass(frozen=True)
class NoiseAdvection:
    """Advection of the noise: wind 10 m above the ground (m/s), and the elevation of that ground (m)."""

    wind: tuple[float, float]
    ground: float


def noise_advection(shot: Shot) -> NoiseAdvection:
    """Return the wind at mid-shot, and the mean elevation of the burning ground."""
    cells = shot.fire.cells(shot.frames.first - 3600.0, shot.frames.last)
    height = float(np.mean(cells.position[:, 2])) if len(cells.arrival) else 1000.0
    return NoiseAdvection(shot.wind, height)


def build(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Smoke"."""
    drawn, carried = view.resolution(shot), noise_advection(shot)
    material, tree = nodes.material("Firetwin Smoke")
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    made_of = shot.fire.smoke
    low = mix_colours(_PALE, _LOW, made_of.dark)
    fresh = tree.input("Fresh Colour", low, "Albedo of smoke near the ground", "Colour")
    old = tree.input("Old Colour", tuple(_HIGH * made_of.white), "Albedo of smoke far up", "Colour")
    middle = tree.input(
        "Inner Colour", _MIDDLE, "Albedo for light that arrives through other smoke", "Colour"
    )
    thick = tree.input("Density", 1.0, "Factor on how thick smoke is", "Density")
    even = tree.input("Anisotropy", ANISOTROPY, "How much light is scattered forwards", "Light", -1.0, 1.0)
    above = tree.separate(position)[2] - carried.ground
    opacity = above.ramp(*_CLOUD, *OPACITY) * (thick * (made_of.opacity / made_of.dilution))
    full = _extinction(tree.attribute("dilution"), opacity, drawn.extinction)
    albedo = tree.mix_colour(above.smoothstep(-200.0, 3200.0), fresh, old)
    noise = _billow(tree, position, carried, float(np.clip(6.0 * drawn.voxel, 260.0, 1000.0)))
    # keeps smoke of fine models from vanishing in the noise
    reach = tree.math("MINIMUM", tree.attribute("size") * 0.8, _AMPLITUDE)
    depth = tree.attribute("density")
    density = (depth + reach * (noise - _MEAN_BILLOW)).smoothstep(*_EDGE) * full
    part, air = haze.fraction(tree, stage)
    scattered = tree.mix_colour(part, albedo, (0.0, 0.0, 0.0))
    shine, bright = glow_inputs(tree, shot)
    glow = tree.attribute("glow") * (1.0 - part) * bright

    def shaded(density: nodes.Value) -> nodes.Value:
        lit = glow * scattered_flame_light(density) * density
        light = tree.add_shader(tree.emission(air, part * density), tree.emission(shine, lit))
        return tree.add_shader(smoke_shader(tree, density, scattered, even), light)

    # A mix by 0 or 1 evaluates one side only: deep inside, noise has no effect and is not evaluated.
    deep = depth > _EDGE[1] + _AMPLITUDE * _MEAN_BILLOW
    detailed = tree.mix_shader(deep, shaded(density), shaded(full))
    # Most steps are on light rays through the smoke, which need no detail: a single grid is enough.
    plain = smoke_shader(tree, _extinction(tree.attribute("shade"), opacity, drawn.extinction), middle, even)
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    tree.volume(
        infrared.select_smoke_shader(tree, shot, stage, tree.mix_shader(camera, plain, detailed), density)
    )
    material.cycles.volume_sampling = "DISTANCE"
    material.cycles.emission_sampling = "NONE"
    return material


def mix_colours(pale: Colour, dark: Colour, part: float) -> Colour:
    """Interpolate two colours linearly."""
    return tuple((1.0 - part) * np.array(pale) + part * np.array(dark))


def glow_light(shot: Shot) -> float:
    """Return the light of the flames on smoke at mid-shot."""
    return sky.glow(float(exposure.darkness(shot, shot.frames.middle)))


def _extinction(dilution: nodes.Value, opacity: nodes.Value, most: float) -> nodes.Value:
    """Return the extinction (1/m) of smoke, saturating at `most`, where thick smoke is already opaque."""
    thickness = dilution * dilution.smoothstep(*_VEIL) * opacity * (EXTINCTION_PER_DILUTION / most)
    return (1.0 - (-thickness).exp()) * most


def glow_inputs(tree: nodes.Tree, shot: Shot) -> tuple[nodes.Value, nodes.Value]:
    """Add inputs for colour and strength of the flames' light on smoke."""
    colour = tree.input("Glow Colour", tuple(sky.GLOW), "Colour of the flames' light on smoke", "Light")
    return colour, tree.input("Glow", glow_light(shot), "Brightness of the flames' light on smoke", "Light")


def scattered_flame_light(density: nodes.Value) -> nodes.Value:
    """Return the fraction of flame light that smoke of this extinction (1/m) scatters (also for metering)."""
    return density.ramp(*sky.THICK, sky.THIN, 1.0)


def smoke_shader(
    tree: nodes.Tree, density: nodes.Value, albedo: nodes.Value, anisotropy: nodes.Value
) -> nodes.Value:
    """Set scattering and absorption coefficients that give the extinction `density` (1/m) and `albedo`."""
    inputs = {"Color": albedo, "Density": density}
    scatter = tree.output("ShaderNodeVolumeScatter", inputs | {"Anisotropy": anisotropy})
    return tree.add_shader(scatter, tree.output("ShaderNodeVolumeAbsorption", inputs))


def _billow(tree: nodes.Tree, position: nodes.Value, carried: NoiseAdvection, size: float) -> nodes.Value:
    """Return billow noise, about 0..1 with mean 0.4, that is advected with the smoke.

    It moves with the wind some hundred metres above the ground. Between there and the top of the smoke the
    wind changes by an eighth.
    """
    shift = [speed * _ALOFT for speed in carried.wind]
    time = nodes.model_time(tree)
    moved = tree.vector("SUBTRACT", position, tree.combine(time * shift[0], time * shift[1], time * _CLIMB))
    noise = tree.noise(moved, size, 5.0, 0.6)
    return tree.math("ABSOLUTE", noise * 2.0 - 1.0) * 2.0
