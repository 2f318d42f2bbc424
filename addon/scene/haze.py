"""Aerial perspective (haze) in the shaders, without a world volume: it costs almost no render time.

Radiance from distance d is mixed with the airlight by 1 - exp(-tau) (Koschmieder; uniform light along the
ray). Extinction falls with height as exp(-z / H), so a ray from z0 to z1 has the optical depth tau = k d
exp(-z0 / H) (1 - exp(-u)) / u with u = (z1 - z0) / H. Haze affects camera rays only and does not scatter
light onto other surfaces.

In the boundary layer, air holds more dust, moisture and smoke (`shot.light.smoke_haze`). The radiance of
thick haze is the radiance of the sky at the horizon, so that distant land merges with the sky. Scenes with
the globe have neither.

Near the ground haze is grey. A camera above the atmosphere also sees the molecules' blue: the difference of
the Rayleigh optical depths of green and blue from red (`space_sky`) is added, in proportion to the same path.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..blender import nodes, owned
from ..blender.owned import Stage
from ..ellipsoid import MEAN_RADIUS
from ..shot.light import sky, smoke_haze
from . import curved_air, space_sky

_GROUP = "haze"
_LOW = ("Low Extinction", "Low Height")
_WHITE = (1.0, 1.0, 1.0, 1.0)
COLOUR, HORIZON = (f'nodes["{name}"].outputs[0].default_value' for name in ("Colour", "Horizon"))
"""Data paths of the airlight's radiance in the node group: near the camera, and where haze is thick."""


def _group(stage: Stage) -> bpy.types.NodeTree:
    """Create the node group once per scene; `set_amount` changes its constants.

    Its inputs are factors on these constants, so that a single material can differ from the scene.
    """
    if stage.root.get(_GROUP) is not None:
        return stage.root[_GROUP]
    group = owned.mark(bpy.data.node_groups.new("Firetwin Haze", "ShaderNodeTree"))
    stage.root[_GROUP] = group
    group.interface.new_socket("Fraction", in_out="OUTPUT", socket_type="NodeSocketFloat")
    group.interface.new_socket("Colour", in_out="OUTPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Airlight", in_out="OUTPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Horizon", in_out="OUTPUT", socket_type="NodeSocketColor")
    tree = nodes.Tree(group)
    extinction = tree.node("ShaderNodeValue")
    extinction.name = "Extinction"
    extinction.outputs[0].default_value = sky.HAZE
    colour = tree.node("ShaderNodeRGB")
    colour.name = "Colour"
    horizon = tree.node("ShaderNodeRGB")
    horizon.name = "Horizon"
    density = tree.input("Density", 1.0, "Factor on the haze of the scene; 0: none", "Haze")
    tint = tree.input("Tint", _WHITE, "Factor on the colour of the scene's haze", "Haze")
    low, height = (tree.node("ShaderNodeValue") for _ in range(2))
    low.name, height.name = _LOW
    low.outputs[0].default_value, height.outputs[0].default_value = sky.HAZE * sky.LOW_HAZE, sky.LOW_HEIGHT
    path = weighted_path_length(tree, stage, sky.HAZE_HEIGHT)
    depth = path * extinction
    earth = curved_air.earth(stage)
    if earth is None:
        depth = depth + weighted_path_length(tree, stage, tree.pick(height)) * tree.pick(low)
    depth = depth * density
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    fraction = (1.0 - (-depth).exp()) * camera
    distant = colour if earth else tree.mix_colour(depth.smoothstep(*sky.THICK_HAZE), colour, horizon)
    light = tree.vector("MULTIPLY", distant, tint)
    shown = light
    if earth is not None:
        shares = _rayleigh_shares(tree, earth, depth, path * density)
        fraction = shares[1] * camera
        ratios = [tree.math("DIVIDE", each, tree.math("MAXIMUM", shares[1], 1e-6)) for each in shares]
        shown = tree.vector("MULTIPLY", light, tree.combine(*ratios))
    tree.finish({"Fraction": fraction, "Colour": shown, "Airlight": colour, "Horizon": horizon})
    return group


def _rayleigh_shares(
    tree: nodes.Tree, earth: curved_air.Earth, depth: nodes.Value, path: nodes.Value
) -> list[nodes.Value]:
    """Return the fractions of airlight in red, green and blue; all equal for a camera near the ground.

    Parameters
    ----------
    depth
        Optical depth of grey haze.
    path
        Path length (m) weighted by the density of haze.
    """
    away = tree.vector("LENGTH", earth.scaled(tree, curved_air.camera_position(tree)), name="Value")
    high = ((away - 1.0) * MEAN_RADIUS).smoothstep(space_sky.LOW, space_sky.HIGH)
    zeniths = path * high * (1.0 / sky.HAZE_HEIGHT)
    red = space_sky.DEPTH[0]
    return [1.0 - (zeniths * (red - each) - depth).exp() for each in space_sky.DEPTH]


def weighted_path_length(tree: nodes.Tree, stage: Stage, height: float | nodes.Value) -> nodes.Value:
    """Return the path length (m) to the camera, weighted by exp(-z / `height`), flat or curved."""
    if (earth := curved_air.earth(stage)) is not None:
        assert isinstance(height, float)
        return curved_air.weighted_path_length(tree, earth, height)
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    geometry = tree.node("ShaderNodeNewGeometry")
    low = tree.separate(tree.pick(geometry, "Position"))[2] / height
    rise = tree.separate(tree.pick(geometry, "Incoming"))[2] * distance / height
    rise = rise + 2.0e-3 * (
        tree.math("ABSOLUTE", rise) < 1.0e-3
    )  # avoids division by 0, where the mean below is 1
    return distance * (-low).exp() * ((1.0 - (-rise).exp()) / rise)


def set_amount(stage: Stage, amount: float, low: smoke_haze.Layer | None = None) -> bpy.types.NodeTree:
    """Set the amount of haze, and return the node group.

    Parameters
    ----------
    amount
        1: a dry September day.
    low
        Layer near the ground; None: of such a day, times `amount`.
    """
    group = _group(stage)
    group.nodes["Extinction"].outputs[0].default_value = sky.HAZE * amount
    for name, value in zip(_LOW, low or (sky.HAZE * amount * sky.LOW_HAZE, sky.LOW_HEIGHT), strict=True):
        group.nodes[name].outputs[0].default_value = value
    return group


def colours(stage: Stage) -> list[bpy.types.NodeSocket]:
    """Return the sockets with the airlight's radiance: near the camera, and where haze is thick."""
    return [_group(stage).nodes[name].outputs[0] for name in ("Colour", "Horizon")]


def illumination(
    stage: Stage, density: float = 1.0, tint: Sequence[float] = _WHITE[:3]
) -> dict[str, Sequence[float]]:
    """Return the haze of the scene's current frame, as `firetwin_core.volume.Illumination` takes it.

    Parameters
    ----------
    density, tint
        Factors on the haze and on its colour.
    """
    group = stage.evaluated(_group(stage))
    air, horizon = (
        [part * by for part, by in zip(group.nodes[name].outputs[0].default_value[:3], tint, strict=True)]
        for name in ("Colour", "Horizon")
    )
    extinction, low, height = (
        float(group.nodes[name].outputs[0].default_value) for name in ("Extinction", *_LOW)
    )
    plain = curved_air.earth(stage) is not None
    return {
        "air": air,
        "horizon": air if plain else horizon,
        "thick_haze": sky.THICK_HAZE,
        "haze": (density * extinction, 0.0 if plain else density * low),
        "haze_height": (sky.HAZE_HEIGHT, height),
    }


def fraction(tree: nodes.Tree, stage: Stage) -> tuple[nodes.Value, nodes.Value]:
    """Return the fraction of airlight in a pixel (0..1, zero except for camera rays), and its colour.

    Inputs for both are added to the group of `tree`.
    """
    density = tree.input("Haze", 1.0, "Factor on the haze between this and the camera; 0: none", "Air")
    tint = tree.input("Haze Tint", _WHITE, "Factor on the colour of that haze", "Air")
    node = tree.node("ShaderNodeGroup", {"Density": density, "Tint": tint}, node_tree=_group(stage))
    return tree.pick(node, "Fraction"), tree.pick(node, "Colour")


def airlight(tree: nodes.Tree, stage: Stage) -> nodes.Value:
    """Return the radiance of the airlight."""
    return tree.pick(tree.node("ShaderNodeGroup", node_tree=_group(stage)), "Airlight")


def before_sky(
    tree: nodes.Tree, stage: Stage, light: nodes.Value, up: nodes.Value, smoke: float = 0.0
) -> nodes.Value:
    """Attenuate the sky for rays of slope sine `up`; the sky texture already includes a dry day's haze.

    Parameters
    ----------
    smoke
        Optical depth of smoke above the ground.
    """
    group = _group(stage)
    more = (group.nodes["Extinction"].outputs[0].default_value - sky.HAZE) * sky.HAZE_HEIGHT + smoke
    if more <= 1.0e-3:
        return light
    depth = tree.math("DIVIDE", more, tree.math("MAXIMUM", up, 0.005))
    colour = airlight(tree, stage)
    if curved_air.earth(stage) is None:  # merges with distant land, as in `_group`
        horizon = tree.pick(tree.node("ShaderNodeGroup", node_tree=group), "Horizon")
        colour = tree.mix_colour(depth.smoothstep(*sky.THICK_HAZE), colour, horizon)
    return tree.mix_colour(1.0 - (-depth).exp(), light, colour)


def apply(tree: nodes.Tree, shader: Any, stage: Stage, glow: nodes.Value | None = None) -> nodes.Value:
    """Apply the haze between surface and camera to `shader`; `glow` is the part that it emits, for an AOV."""
    part, colour = fraction(tree, stage)
    if glow is not None:
        clear = 1.0 - part
        tree.aov(nodes.GLOW, tree.vector("MULTIPLY", glow, tree.combine(clear, clear, clear)))
    return tree.mix_shader(part, shader, tree.emission(colour, 1.0))
