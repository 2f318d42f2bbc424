"""Infrared radiance of surfaces, air and smoke over a camera's band, in W m-2 sr-1.

A surface of emissivity e emits e L(T) and reflects (1 - e) of the sky's radiance. L is Planck's law
integrated over the band by Gauss-Legendre quadrature with five wavelengths: the error in the shaders' float32
is at most 0.3 mK (8 to 14 um) and 0.2 mK (3.4 to 4.1 um) between 180 and 1600 K. Pixels are means of
radiance.

Over d km of air with w g/m3 of water vapour the transmittance is exp(-0.03 w d^0.75), and the air adds its
emission. For 7 g/m3 this agrees within 0.01 with the transmission of G. J. Tattersall's Thermimage (after
FLIR Systems: 0.81 over 1 km, 0.31 over 10 km). The scale height of vapour is 2 km. The same formula is used
in the mid-wave infrared.

Smoke is nearly transparent in the infrared: its particles, 0.1 to 0.3 um in diameter (Radke et al. 1990),
absorb as 1 / wavelength and scatter almost nothing (C. F. Bohren and D. R. Huffman 1983, 5.1). A sixth of the
extinction in green light is absorption (single-scattering albedo 0.84, Reid et al. 2005). A twentieth of this
absorption remains at 11 um, a seventh at 3.75 um. Not modelled: ash, whose particles are larger, and cloud
water in smoke, which hides the fire in the infrared too.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..blender import nodes, owned
from ..blender.owned import Stage
from ..shot.fire import air_temperature as model
from ..shot.sections.thermal import BANDS
from ..shot.shot import Shot
from . import haze, temperature

SKY, STONE = model.SKY, model.STONE  # the thermal picture's palette uses them too
GREEN = 0.55  # um
SOOT = 0.16  # absorption as a fraction of smoke's extinction in green light
NEEDLES, GROUND, CHAR, LAKE = 0.98, 0.96, 0.97, 0.985  # emissivities, 8 to 14 um (assumed)
FLAME = 0.6  # 1/m: emissivity of a flame of depth D is 1 - exp(-0.6 D) (assumed)
_DIM = 0.03  # extinction of air, per g/m3, at 1 km
_BEND = 0.75
_HALF = 2000.0  # m, scale height of water vapour
_CURVED = 0.014
"""Sine of the elevation at which a path through a flat atmosphere of 2 km is 141 km long: sqrt(pi R 2 km / 2)
for R = 6371 km, the horizontal path through the atmosphere of the Earth."""
_BACKGROUND = 200.0  # K, brightness temperature of the sky without water vapour (assumed)
_GROUP, _NODES = "infrared", 5
_FIRST = 2.0 * 6.62607015e-34 * 299792458.0**2 * 1e24  # W m-2 sr-1 um4
_SECOND = 14387.768775  # um K


def surface_radiance(
    tree: nodes.Tree, shot: Shot, stage: Stage, kelvin: Any, emissivity: Any = 1.0
) -> nodes.Value:
    """Return the radiance that a surface emits and reflects."""
    inputs = {"Kelvin": kelvin, "Emissivity": emissivity}
    return tree.output("ShaderNodeGroup", inputs, "Radiance", node_tree=_group(shot, stage))


def radiance_at_camera(tree: nodes.Tree, shot: Shot, stage: Stage, radiance: Any) -> nodes.Value:
    """Return the radiance of this point at the camera: attenuated by air, plus the air's emission."""
    clear = tree.output("ShaderNodeGroup", (), "Clear", node_tree=_group(shot, stage))
    own = surface_radiance(tree, shot, stage, temperature.air_temperature_node(tree, shot, stage))
    return tree.mix(clear, own, radiance)


def select_smoke_shader(
    tree: nodes.Tree, shot: Shot, stage: Stage, visible: Any, density: nodes.Value
) -> nodes.Value:
    """Return `visible`, a smoke shader of this extinction (1/m) in green light; in data layers its emission.

    In masks smoke absorbs as in green light and emits nothing.
    """
    absorbed = density * absorption(BANDS[shot.settings.thermal.band])
    black = tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": absorbed})
    own = surface_radiance(tree, shot, stage, temperature.air_temperature_node(tree, shot, stage))
    warm = tree.add_shader(black, tree.emission((1.0, 1.0, 1.0), own * absorbed))
    shader = nodes.switch(tree, nodes.THERMAL, visible, warm)
    dims = tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": density})
    return nodes.switch(tree, nodes.MASKS, shader, dims)


def absorption(band: tuple[float, float]) -> float:
    """Return the absorption of smoke in a band (um), as a ratio to its extinction in green light."""
    return SOOT * 2.0 * GREEN / sum(band)


def build(shot: Shot, stage: Stage) -> None:
    """Set the band and the air of this shot, for existing and later materials."""
    _set_constants(_group(shot, stage), shot)


def sky_radiance(shot: Shot) -> float:
    """Return the mean radiance of the sky, which surfaces reflect, W m-2 sr-1."""
    return float(sensor.radiance(SKY, BANDS[shot.settings.thermal.band]))


def clear_sky(
    shot: Shot, air: temperature.TemperatureField, place: NDArray[np.float64], sine: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the radiance of the clear sky, W m-2 sr-1, by the sine of the elevation.

    The sky is air of decreasing density in front of a cold background. Towards the zenith the emitting air is
    higher and colder. At the horizon it is opaque and as warm as the air around the camera.

    Parameters
    ----------
    place
        (3,) scene coordinates of the camera, m.
    """
    way = 1.0e-3 * _HALF / (np.maximum(sine, 0.0) + _CURVED)
    clear = np.exp(-air_depth(shot, float(place[2])) * way**_BEND)
    band = BANDS[shot.settings.thermal.band]
    kelvin = air.at(place) - model.LAPSE * _HALF * np.maximum(sine, 0.0)
    own = sensor.radiance(np.maximum(kelvin, _BACKGROUND), band)  # above 45 km the lapse leads below 0 K
    return clear * sensor.radiance(_BACKGROUND, band) + (1.0 - clear) * own


def air_depth(shot: Shot, height: float) -> float:
    """Return the optical depth of 1 km of air at a scene height (m)."""
    return float(_DIM * shot.settings.thermal.vapour * np.exp(-height / _HALF) ** _BEND)


def _group(shot: Shot, stage: Stage) -> bpy.types.NodeTree:
    """Create the node group once per scene: kelvin and emissivity -> radiance; and air transmittance."""
    if stage.root.get(_GROUP) is not None:
        return stage.root[_GROUP]
    group = owned.mark(bpy.data.node_groups.new("Firetwin Infrared", "ShaderNodeTree"))
    stage.root[_GROUP] = group
    for name, direction in (("Kelvin", "INPUT"), ("Emissivity", "INPUT"), ("Radiance", "OUTPUT")):
        group.interface.new_socket(name, in_out=direction, socket_type="NodeSocketFloat")
    group.interface.new_socket("Clear", in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree = nodes.Tree(group)
    entry = tree.node("NodeGroupInput")
    inverse = 1.0 / tree.math("MAXIMUM", tree.pick(entry, "Kelvin"), 100.0)
    own: Any = 0.0
    for index in range(_NODES):
        weight, exponent = (_value_node(tree, f"{name} {index}") for name in ("Weight", "Exponent"))
        own = own + weight / ((inverse * exponent).exp() - 1.0)
    radiance = tree.mix(tree.pick(entry, "Emissivity"), _value_node(tree, "Sky"), own)
    tree.finish({"Radiance": radiance, "Clear": _air_transmittance(tree, stage)})
    _set_constants(group, shot)
    return group


def _air_transmittance(tree: nodes.Tree, stage: Stage) -> nodes.Value:
    """Return the transmittance of air between this point and the camera."""
    path = haze.weighted_path_length(tree, stage, _HALF) * 1.0e-3
    return (-(path.power(_BEND) * _value_node(tree, "Dim"))).exp()


def _value_node(tree: nodes.Tree, name: str) -> nodes.Value:
    node = tree.node("ShaderNodeValue")
    node.name = name
    return tree.pick(node)


def _set_constants(group: bpy.types.NodeTree, shot: Shot) -> None:
    """Set the values that depend on the band and the air."""
    low, high = BANDS[shot.settings.thermal.band]
    places, weights = np.polynomial.legendre.leggauss(_NODES)
    waves = 0.5 * (low + high) + 0.5 * (high - low) * places
    values = {"Sky": sky_radiance(shot), "Dim": _DIM * shot.settings.thermal.vapour}
    for index, (wave, weight) in enumerate(zip(waves, weights, strict=True)):
        values[f"Weight {index}"] = 0.5 * (high - low) * weight * _FIRST / wave**5
        values[f"Exponent {index}"] = _SECOND / wave
    for name, value in values.items():
        group.nodes[name].outputs[0].default_value = float(value)
