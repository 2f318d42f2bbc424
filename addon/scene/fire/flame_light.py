"""Light of the flames near the cameras, by day and night: emissive cards that only lighting rays see.

A pair of crossed cards is placed at each flame that burns now, and emits the light of the heat that this part
of the front releases (`flames.Points.heat`). It flickers at the puffing frequency of a flame of its size, f =
0.5 sqrt(g / D) (B. M. Cetegen and T. A. Ahmed 1993, Combustion and Flame 93, 157-184), as a function of time
and place alone. Thick flames are as bright as drawn flames with some gaps. Lamps represent the
flames farther away (see `lamps`).
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...shot.fire.flame_size import flame_length
from ...shot.light import exposure
from ...shot.shot import Shot
from .. import clock
from ..forest.stand import Stand
from . import flame_volume, flames, lamps
from .flame_volume import RADIATED

REACH = 250.0, 400.0  # m from the camera of a frame, distances between which these lights give way to lamps
FAR_LAMPS = 300.0, 2500.0  # m from a camera, distances between which the light of lamps fades in
LIGHT = 2.0e-2
"""W of the scene's light per radiated W of thin flames; by eye, as bright as drawn flames are.
It is 5e-5 for flames of 18 m with 15,000 cd/m2, half of them gaps, and a radiosity of 61 kW/m2, if a
luminance of 1 is 16,000 cd/m2; 4e-4 for flames of 2 to 5 m."""
THICK = 6.6, 5.5  # red radiance of thick flames over the luminance of drawn cores, by day and by night
"""By eye; drawn flames have 1.1 in the mean over opaque pixels."""
_DEEP = 12.0  # m, depth and length of flames from which cards would add up to more than a flame's (by eye)
COLOUR = (1.0, 0.36, 0.06)
LAYOUT = flames.Layout(((REACH[1], 4.0),), gaps=False)
"""Denser than billboards, without gaps: surfaces near the front are lit evenly along it."""
_FLICKER = 1.2  # factor on noise around its mean of 0.5: about 15 % (standard deviation; assumed)
_SIZE = 0.5, 0.3  # m, smallest diameter for the frequency, and smallest side of a card
_NAME = "Firetwin Flame Light"


def applies(shot: Shot) -> bool:
    """Return whether near flames have lights: in Cycles, unless `light.lamps` is 0."""
    settings = shot.settings
    return settings.fire.flames and settings.render.engine == "cycles" and settings.light.lamps > 0


def build(shot: Shot, grown: Stand | None, collection: bpy.types.Collection) -> bpy.types.Object | None:
    """Build "Firetwin Flame Light" in the collection of the lamps; None without flames near a camera."""
    if not applies(shot):
        return None
    points = flames.front_flames(shot, grown, LAYOUT)
    near = np.flatnonzero(shot.visibility.distance(points.position) < REACH[1])
    if len(near) == 0:
        return None
    points = points.take(near)
    data = create_mesh(_NAME, points.position)
    for name in ("arrival_time", "residence", "tilt", "seed"):
        add_attribute(data, name, "FLOAT", getattr(points, name))
    # The ground gets light from flames as tall as the front's, not from the low parts of a ragged front.
    add_attribute(data, "length", "FLOAT", np.maximum(points.length, _usual_length(shot, points)))
    add_attribute(data, "width", "FLOAT", np.maximum(points.width, LAYOUT.spacing[0][1]))
    add_attribute(data, "power", "FLOAT", RADIATED * LIGHT * points.heat)
    add_attribute(data, "layers", "FLOAT", layers(shot, points))
    obj = owned.add(collection, "Flame Light", data)
    modifier = obj.modifiers.new(_NAME, "NODES")
    modifier.node_group = _node_group(shot, _card())
    _show_to_lighting_only(obj)
    obj.hide_viewport = True
    return obj


def layers(shot: Shot, points: flames.Points) -> NDArray[np.float64]:
    """Return the number (n,) of cards that add up along a line of sight through deep flames, at least 1."""
    speed = shot.ground.spread(*shot.ground.under(points.position))
    deep = np.minimum(speed * points.residence, _usual_length(shot, points)) / _DEEP
    return np.maximum(deep, 1.0)


def _usual_length(shot: Shot, points: flames.Points) -> NDArray[np.float64]:
    """Return the length (n,) of the front's flames without their unevenness, m."""
    return flame_length(points.intensity, shot.settings.fire.flame_length)


def thick_radiance(stops: float, dark: float) -> float:
    """Return the red radiance of thick flames at an exposure (stops) and a darkness (0 to 1)."""
    return flame_volume.core_luminance(stops) * (THICK[0] + (THICK[1] - THICK[0]) * dark)


def _show_to_lighting_only(obj: bpy.types.Object) -> None:
    obj.lightgroup = nodes.FIRELIGHT
    obj.visible_camera = obj.visible_glossy = obj.visible_shadow = obj.visible_volume_scatter = False


def _card() -> bpy.types.Object:
    """Create two crossed cards one metre high and wide on z = 0, linked to no scene."""
    corners = [(-0.5, 0.0), (0.5, 0.0), (0.0, -0.5), (0.0, 0.5)]
    vertices = [(x, y, z) for z in (0.0, 1.0) for x, y in corners]
    faces = [(0, 1, 5, 4), (2, 3, 7, 6)]
    data = create_mesh(f"{_NAME} Card", vertices, faces, flat=True)
    data.materials.append(_material())
    obj = owned.mark(bpy.data.objects.new(f"{_NAME} Card", owned.mark(data)))
    _show_to_lighting_only(obj)
    return obj


def _material() -> bpy.types.Material:
    material, tree = nodes.material(_NAME)
    colour = tree.input("Colour", COLOUR, "Colour of the light of flames", "Light")
    factor = tree.input("Brightness", 1.0, "Factor on the light of flames", "Light")
    tree.surface(tree.emission(colour, tree.attribute("radiance", "INSTANCER") * factor))
    material.cycles.emission_sampling = "FRONT_BACK"
    return material


def _node_group(shot: Shot, card: bpy.types.Object) -> bpy.types.NodeTree:
    """Build geometry nodes: burning points -> cards with a `radiance`, as large as the flames."""
    tree, entry = nodes.geometry(_NAME)

    def named(name: str) -> nodes.Value:
        return tree.output("GeometryNodeInputNamedAttribute", {"Name": name}, data_type="FLOAT")

    part = (clock.geometry_time(tree, shot) - named("arrival_time")) / named("residence")
    outside = tree.math("ADD", part < 0.0, 1.0 - (part < 1.0), clamp=True)
    size = part.ramp(0.0, 0.2, 0.25, 1.0) * part.ramp(0.6, 1.0, 1.0, 0.2)
    # Relative to the first frame: seconds since the start of the run would exceed float precision.
    since = (tree.output("GeometryNodeInputSceneTime", name="Frame") - 1.0) * shot.frames.step
    frequency = 0.5 * tree.math("SQRT", constants.GRAVITY / tree.math("MAXIMUM", named("length"), _SIZE[0]))
    phase = since * frequency * 2.0 + named("seed") * 4096.0
    wave = tree.output("ShaderNodeTexNoise", {"W": phase, "Scale": 1.0, "Detail": 1.0}, noise_dimensions="1D")
    flicker = 1.0 + (wave - 0.5) * _FLICKER
    width, height = (
        tree.math("MAXIMUM", value * size, _SIZE[1]) for value in (named("width"), named("length"))
    )
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.output("GeometryNodeObjectInfo", {"Object": camera}, "Location", transform_space="ORIGINAL")
    distance = tree.vector("DISTANCE", eye, tree.output("GeometryNodeInputPosition"), name="Value")
    power = named("power") * size * flicker * distance.smoothstep(REACH[1], REACH[0])
    dark = float(lamps.darkness(shot, np.array([shot.frames.middle]))[0])
    thick = thick_radiance(exposure.middle(shot), dark) / named("layers")
    radiance = power / (width * height * (4.0 * np.pi))
    radiance = thick * (1.0 - (-radiance / thick).exp())
    east, north = shot.wind
    axis = (-north, east, 0.0) if np.hypot(east, north) > 0.0 else (1.0, 0.0, 0.0)
    lean = tree.output("FunctionNodeAxisAngleToRotation", {"Axis": axis, "Angle": named("tilt")})
    placed = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": entry,
            "Selection": tree.math("ADD", outside, distance > REACH[1]) < 0.5,
            "Instance": tree.output("GeometryNodeObjectInfo", {"Object": card}, "Geometry"),
            "Rotation": lean,
            "Scale": tree.combine(width, width, height),
        },
    )
    stored = {"Geometry": placed, "Name": "radiance", "Value": radiance}
    kept = tree.output("GeometryNodeStoreNamedAttribute", stored, data_type="FLOAT", domain="INSTANCE")
    tree.geometry(kept)
    return tree.node_tree
