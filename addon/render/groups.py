"""Compositor node groups for artists: thermal blend, thermal camera, eye-dome lighting, overlay and regrade.

Every built scene has them (Add > Group in the compositor). They match `firetwin_core.sensor` within 1e-5;
`regrade` has its own file.
Colours are display-referred, 0..1, as in a PNG: Image nodes must read them as Non-Color, and the scene's view
transform must be Raw. Depth and radiance come from the view layers "depth" and "thermal", or from their EXR
files.

`Thermal Camera` evaluates temperature as a polynomial of the band's radiance, within 3e-6 of the inverse of
the band integral from 180 to 1800 K (`RANGE`), for the band in the scene's settings.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor

from ..blender import compat, nodes
from ..blender.nodes import Tree, Value
from ..blender.owned import Stage
from ..passes import edl, overlay, thermal
from ..shot.sections.thermal import BANDS
from ..shot.settings import Settings
from . import regrade

RANGE = 180.0, 1800.0  # K
_DEGREE = 14
_DEEPEST, _NEAREST = 1e9, 1e-3  # m, as in cpp/sensor/eye_dome.cpp
_COLOUR, _NUMBER = "NodeSocketColor", "NodeSocketFloat"
_BLACK, _WHITE = (0.0, 0.0, 0.0, 1.0), (1.0, 1.0, 1.0, 1.0)


def build(settings: Settings, stage: Stage) -> None:
    """Create the missing groups, and set the camera's band from the settings."""
    makers = {
        "Thermal Blend": thermal_blend_group,
        "Thermal Camera": thermal_camera_group,
        "Eye Dome": eye_dome_group,
        "Overlay": overlay_group,
        "Regrade": regrade.group,
    }
    for name, make in makers.items():
        if stage.root.get(f"group {name}") is None:
            stage.root[f"group {name}"] = make()
    set_band(stage.root["group Thermal Camera"], BANDS[settings.thermal.band])


def thermal_blend_group() -> bpy.types.NodeTree:
    """Create the group of `sensor.thermal_composite`: the paper's temperature gradient added to a picture."""
    tree = nodes.compositor(
        "Firetwin Thermal Blend",
        "The FIRETWIN paper's thermal view: colours of the model's temperature added to the picture",
        {"Image": _COLOUR},
    )
    image = tree.input("Image", _BLACK, "Picture in display colours, 0 to 1")
    kelvin = _temperature(tree)
    low = tree.input("Low", 300.0, "K at the black end of the gradient", "Scale")
    high = tree.input("High", 330.0, "K at the white end of the gradient", "Scale")
    strength = tree.input("Strength", 1.0, "Factor on the gradient", "Scale", least=None)
    heat = tree.colours((kelvin - low) / (high - low), sensor.palette("paper"))
    sum_ = tree.vector("ADD", _clamped(tree, image), _multiply(tree, heat, strength))
    tree.finish({"Image": _clamped(tree, sum_)})
    return tree.node_tree


def thermal_camera_group() -> bpy.types.NodeTree:
    """Create the group of `sensor.brightness_temperature` and `sensor.colour`: radiance to colours."""
    names = sensor.palettes()
    listed = ", ".join(f"{number} {name}" for number, name in enumerate(names, 1))
    tree = nodes.compositor(
        "Firetwin Thermal Camera",
        "Brightness temperature (K) of infrared radiance, and its picture by a palette",
        {"Image": _COLOUR, "Kelvin": _NUMBER},
    )
    of = "Band radiance, W m-2 sr-1: the image of the view layer thermal"
    radiance = tree.input("Radiance", 55.0, of, least=None)
    low = tree.input("Low", 290.0, "K at the cold end of the palette", "Temperatures")
    high = tree.input("High", 1000.0, "K at the hot end of the palette", "Temperatures")
    closes = "K above the cold end from which the palette is logarithmic"
    knee = tree.input("Knee", thermal.KNEE, closes, "Temperatures", 0.01)
    palette = tree.input("Palette", 1, listed, "Look", 1, len(names))
    kelvin = _inverse_temperature(tree, radiance)
    above = tree.math("MINIMUM", tree.math("MAXIMUM", kelvin, low), high) - low
    place = _log(tree, above / knee + 1.0) / _log(tree, (high - low) / knee + 1.0)
    shown: Any = _BLACK
    for number, name in enumerate(names, 1):
        chosen = tree.math("COMPARE", palette, float(number), 0.5)
        shown = tree.mix_colour(chosen, shown, tree.colours(place, sensor.palette(name)))
    tree.finish({"Image": shown, "Kelvin": kelvin})
    return tree.node_tree


def eye_dome_group() -> bpy.types.NodeTree:
    """Create the group of `sensor.eye_dome`: darkens pixels behind their neighbours."""
    tree = nodes.compositor(
        "Firetwin Eye Dome",
        "Eye-dome lighting: darkens pixels behind their neighbours, which emphasises shapes",
        {"Image": _COLOUR, "Shade": _NUMBER},
    )
    image = tree.input("Image", _WHITE, "Picture in display colours, 0 to 1")
    along = "Depth along the camera's axis, m: the image of the view layer depth"
    depth = tree.input("Depth", 1000.0, along, least=None)
    strength = tree.input("Strength", edl.STRENGTH, "How dark", "Shade")
    radius = tree.input("Radius", edl.RADIUS, "Distance to the eight neighbours, pixels", "Shade", 1)
    depth = tree.math("MINIMUM", tree.math("MAXIMUM", depth, _NEAREST), _DEEPEST)
    # Nearness: outside the picture Translate returns 0, the greatest depth, which has no effect.
    near = tree.math("LOGARITHM", _DEEPEST / depth, 2.0)
    total: Any = 0.0
    for down, across in ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)):
        moved = {"Image": near, "X": radius * float(across), "Y": radius * float(down)}
        there = tree.pick(compat.whole_pixels(tree.node("CompositorNodeTranslate", moved)))
        total = total + tree.math(
            "MINIMUM", near - there, 0.0
        )  # the first input determines the picture's offset
    shade = (total * strength * 0.125).exp()
    tree.finish({"Image": _multiply(tree, image, shade), "Shade": shade})
    return tree.node_tree


def overlay_group() -> bpy.types.NodeTree:
    """Create the group of `sensor.overlay`: hot spots of one picture over another."""
    tree = nodes.compositor(
        "Firetwin Overlay", "Hot spots of a thermal picture over the visible one", {"Image": _COLOUR}
    )
    image = tree.input("Image", _BLACK, "Picture below, in display colours, 0 to 1")
    spots = tree.input("Thermal", _WHITE, "Picture of the hot spots, registered to the image")
    kelvin = _temperature(tree)
    start = tree.input("From", overlay.START, "K above which the overlay fades in", "Where")
    full = tree.input("To", overlay.FULL, "K from which the overlay has full opacity", "Where")
    opacity = tree.input("Opacity", overlay.OPACITY, "Full opacity of the overlay", "Where", most=1.0)
    part = ((kelvin - start) / (full - start)).clamp() * opacity
    change = tree.vector("SUBTRACT", spots, image)
    tree.finish({"Image": tree.vector("ADD", image, _multiply(tree, change, part))})
    return tree.node_tree


def set_band(group: bpy.types.NodeTree, band: tuple[float, float]) -> None:
    """Set the band of a Thermal Camera group, um."""
    kelvin = np.geomspace(*RANGE, 2000)
    logs = np.log(sensor.radiance(kelvin, band))
    low, high = float(logs[0]), float(logs[-1])
    x = (2.0 * logs - (low + high)) / (high - low)
    fitted = np.polynomial.chebyshev.chebfit(x, 1.0 / kelvin, _DEGREE)
    values = {f"Power {n}": each for n, each in enumerate(np.polynomial.chebyshev.cheb2poly(fitted))}
    values |= {"Least": np.exp(low), "Most": np.exp(high)}
    values |= {"Scale": 2.0 / (high - low), "Shift": -(low + high) / (high - low)}
    for name, value in values.items():
        group.nodes[name].outputs[0].default_value = float(value)


def _inverse_temperature(tree: Tree, radiance: Value) -> Value:
    """Evaluate 1 / temperature by Horner's rule in log radiance; `set_band` sets the coefficients."""
    held = tree.math("MAXIMUM", radiance, _coefficient(tree, "Least"))
    held = tree.math("MINIMUM", held, _coefficient(tree, "Most"))
    x = _log(tree, held) * _coefficient(tree, "Scale") + _coefficient(tree, "Shift")
    inverse = _coefficient(tree, f"Power {_DEGREE}")
    for power in reversed(range(_DEGREE)):
        inverse = inverse * x + _coefficient(tree, f"Power {power}")
    return 1.0 / inverse


def _temperature(tree: Tree) -> Value:
    return tree.input("Kelvin", 300.0, "Temperature of each pixel, K", least=None)


def _coefficient(tree: Tree, name: str) -> Value:
    node = tree.node("ShaderNodeValue")
    node.name = node.label = name
    return tree.pick(node)


def _log(tree: Tree, value: Any) -> Value:
    return tree.math("LOGARITHM", value, np.e)


def _multiply(tree: Tree, colour: Any, number: Any) -> Value:
    """Multiply a colour by a number."""
    return tree.output("ShaderNodeVectorMath", {"Vector": colour, "Scale": number}, operation="SCALE")


def _clamped(tree: Tree, colour: Any) -> Value:
    """Clamp a colour to 0 to 1."""
    above = tree.vector("MAXIMUM", colour, (0.0, 0.0, 0.0))
    return tree.vector("MINIMUM", above, (1.0, 1.0, 1.0))
