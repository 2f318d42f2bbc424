"""Temperatures (K) of all surfaces in the thermal view, as outputs of shader nodes.

The air has the run's temperature at the point, with a lapse rate of 6.5 K per kilometre above the model's
terrain. Unburned ground is warmer than the air by (a S - loss) / h: absorbed direct sun S (`run.sun.direct`)
on the inclined surface, less 70 W/m2 of net long-wave radiation into a clear sky. h is 30 W m-2 K-1 for bare
ground and 80 for crowns, which stay within some kelvin of the air (both assumed). Shadows of ridges and trees
do not cool the ground.

Burned ground cools by `air_temperature.cooling`. It is 97 K warmer than unburned ground after ten
minutes, 38 K after an hour and 19 K after four hours where timber burned for two minutes; 12 K warmer after
ten minutes where grass burned for a quarter of a minute. Flames are 1000-1500 K (Frankman et al. 2008). A
pixel of the front mixes flames with gaps, so flames are drawn at 1000-1200 K.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ..blender import compat, nodes, owned
from ..blender.owned import Stage
from ..run import sun
from ..shot.fire import air_temperature
from ..shot.shot import Shot

FLAME_LOW, FLAME_HIGH = 1000.0, 1200.0  # K
EMBER = 850.0  # K, ground covered by glowing embers (assumed)
WATER = 292.0  # K, a lake in September (assumed)
_NEEDLES = 80.0  # W m-2 K-1
_GROUP, _IMAGE = "temperature", "Firetwin Air Temperature"
_SIDE = 128  # pixels along a side of the field at each time
_MOMENTS = 25  # maximum number of times


def unburned_temperature(
    tree: nodes.Tree, shot: Shot, stage: Stage, elevation: Any, normal: Any, bare: Any
) -> nodes.Value:
    """Return the temperature of unburned ground (`bare` 1) or crowns (0) at this elevation (m) and normal."""
    node = tree.node("ShaderNodeGroup", {"Elevation": elevation}, node_tree=_group(shot, stage))
    lit = tree.math("MAXIMUM", tree.vector("DOT_PRODUCT", normal, tree.pick(node, "Sun"), name="Value"), 0.0)
    gain = lit * air_temperature.ABSORBED - air_temperature.LOSS
    return tree.pick(node, "Kelvin") + gain * tree.mix(bare, 1.0 / _NEEDLES, 1.0 / air_temperature.BARE)


def air_temperature_node(tree: nodes.Tree, shot: Shot, stage: Stage) -> nodes.Value:
    """Return the temperature of the air at this point."""
    height = tree.separate(tree.output("ShaderNodeNewGeometry", name="Position"))[2]
    return tree.output("ShaderNodeGroup", {"Elevation": height}, "Kelvin", node_tree=_group(shot, stage))


def burned_temperature(
    tree: nodes.Tree, background: Any, age: nodes.Value, burned: Any, pulse: Any = air_temperature.PULSE
) -> nodes.Value:
    """Return the temperature of burned ground heated for `pulse` (s), without its flames and embers.

    It is at most `FLAME_HIGH`: nothing under flames is hotter than they are.
    """
    age = tree.math("MAXIMUM", age, 0.0)
    before = tree.math("MAXIMUM", age - pulse, 0.0)
    above = (tree.math("SQRT", age) - tree.math("SQRT", before)) * burned
    return tree.math("MINIMUM", background + above * air_temperature.COOLING, FLAME_HIGH)


def build(shot: Shot, stage: Stage) -> None:
    """Set the air temperature and the sun of this shot, for existing and later materials."""
    _write_air(_group(shot, stage, fill=False), shot)


def _group(shot: Shot, stage: Stage, fill: bool = True) -> bpy.types.NodeTree:
    """Create the node group once per scene: elevation (m) -> air temperature (K), and W/m2 to the sun."""
    if stage.root.get(_GROUP) is not None:
        return stage.root[_GROUP]
    group = owned.mark(bpy.data.node_groups.new("Firetwin Temperature", "ShaderNodeTree"))
    stage.root[_GROUP] = group
    group.interface.new_socket("Elevation", in_out="INPUT", socket_type="NodeSocketFloat")
    group.interface.new_socket("Kelvin", in_out="OUTPUT", socket_type="NodeSocketFloat")
    group.interface.new_socket("Sun", in_out="OUTPUT", socket_type="NodeSocketVector")
    tree = nodes.Tree(group)
    elevation = tree.pick(tree.node("NodeGroupInput"), "Elevation")
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    corner, scale = (_named_node(tree, "ShaderNodeCombineXYZ", name) for name in ("Corner", "Scale"))
    across, up, _ = tree.separate(tree.vector("MULTIPLY", tree.vector("SUBTRACT", position, corner), scale))
    edge = 0.5 / _SIDE
    across, up = (tree.math("MINIMUM", tree.math("MAXIMUM", v, edge), 1.0 - edge) for v in (across, up))
    start, pace, last = (_named_node(tree, "ShaderNodeValue", name) for name in ("Start", "Pace", "Last"))
    moment = tree.math("MAXIMUM", (nodes.model_time(tree) - start) * pace, 0.0)
    moment = tree.math("MINIMUM", moment, last)
    whole = tree.math("FLOOR", moment)
    count = last + 1.0

    def field(number: Any) -> nodes.Value:
        place = tree.combine(across, (number + up) / count, 0.0)
        image = tree.node("ShaderNodeTexImage", {"Vector": place}, extension="EXTEND")
        image.name = f"Field {number.socket.node.name}"
        return tree.pick(image)

    following = tree.math("MINIMUM", whole + 1.0, last)
    both = tree.mix_colour(moment - whole, field(whole), field(following))
    kelvin, model, _ = tree.separate(both)
    sunward = _named_node(tree, "ShaderNodeCombineXYZ", "Sun")
    kelvin = kelvin - (elevation - model) * air_temperature.LAPSE
    kelvin = tree.math("MAXIMUM", kelvin, air_temperature.TROPOPAUSE)
    tree.finish({"Kelvin": kelvin, "Sun": sunward})
    if fill:
        _write_air(group, shot)
    return group


def _named_node(tree: nodes.Tree, kind: str, name: str) -> nodes.Value:
    node = tree.node(kind)
    node.name = name
    return tree.pick(node)


def _write_air(group: bpy.types.NodeTree, shot: Shot) -> None:
    """Write the run's temperatures on a square grid of the scene, with its times stacked in one image."""
    frames = shot.frames
    moving = frames.last > frames.first
    count = min(_MOMENTS, max(frames.count, 2)) if moving else 1
    times = np.linspace(frames.first, frames.last, count)
    fields = [field(shot, float(time)) for time in times]
    pixels = np.ones((count, _SIDE * _SIDE, 4), np.float32)
    for index, each in enumerate(fields):
        pixels[index, :, 0], pixels[index, :, 1] = each.kelvin.ravel(), each.elevation.ravel()
    old = next((node.image for node in group.nodes if node.type == "TEX_IMAGE" and node.image), None)
    image = owned.mark(
        bpy.data.images.new(_IMAGE, _SIDE, _SIDE * count, alpha=False, float_buffer=True, is_data=True)
    )
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    for node in group.nodes:
        if node.type == "TEX_IMAGE":
            node.image = image
    if old is not None and old.users == 0:
        bpy.data.images.remove(old)
    low, high = _grid_corners(shot)
    _set_value(group, "Corner", (*low, 0.0))
    _set_value(group, "Scale", (*(1.0 / (high - low)), 0.0))
    group.nodes["Start"].outputs[0].default_value = frames.first
    group.nodes["Pace"].outputs[0].default_value = (
        (count - 1) / (frames.last - frames.first) if moving else 0.0
    )
    group.nodes["Last"].outputs[0].default_value = count - 1
    _animate_sun(group, shot, count)


class TemperatureField(NamedTuple):
    """Air at one time on a square grid of the scene, rows ordered northwards.

    Attributes
    ----------
    kelvin, elevation
        (n, n) K at the model's ground, and the elevation of that ground, m.
    corner, spacing
        (2,) x and y of the first value, and the grid spacing, m.
    """

    kelvin: NDArray[np.float64]
    elevation: NDArray[np.float64]
    corner: NDArray[np.float64]
    spacing: NDArray[np.float64]

    def at(self, place: NDArray[np.float64]) -> float:
        """Return the air temperature (K) in the cell of a point (3,) of the scene, m; clamped to the grid."""
        rows, columns = self.kelvin.shape
        east, north = np.round((place[:2] - self.corner) / self.spacing).astype(int)
        cell = int(np.clip(north, 0, rows - 1)), int(np.clip(east, 0, columns - 1))
        return float(self.kelvin[cell] - (place[2] - self.elevation[cell]) * air_temperature.LAPSE)


def field(shot: Shot, time: float) -> TemperatureField:
    """Return the run's air at a model time (s)."""
    low, high = _grid_corners(shot)
    spacing = (high - low) / _SIDE
    corner = low + 0.5 * spacing
    east, north = np.meshgrid(*(corner[k] + spacing[k] * np.arange(_SIDE) for k in (0, 1)))
    place = air_temperature.indices(shot.run, *shot.ground.geodetic(east.ravel(), north.ravel()))
    model = np.nan_to_num(shot.run.elevation.astype(np.float64))
    kelvin, elevation = (bilinear(values, *place) for values in (air_temperature.at(shot.run, time), model))
    return TemperatureField(kelvin.reshape(east.shape), elevation.reshape(east.shape), corner, spacing)


def _grid_corners(shot: Shot) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return scene x and y (m) of the corners of the run's model grid."""
    run = shot.run
    latitude, longitude = (
        np.array([axis.min(), axis.max()], np.float64) for axis in (run.latitude, run.longitude)
    )
    height = np.full(4, float(np.nanmean(run.elevation)))
    corners = shot.local_frame.forward(np.repeat(latitude, 2), np.tile(longitude, 2), height)[:, :2]
    low, high = corners.min(axis=0), corners.max(axis=0)
    return low, np.maximum(high, low + 1.0)


def _animate_sun(group: bpy.types.NodeTree, shot: Shot, count: int) -> None:
    """Keyframe the vector towards the sun, whose length is the direct irradiance."""
    frames = np.linspace(1.0, shot.frames.count, count)
    vectors = []
    for frame in frames:
        bearing, height = sun.position(shot.run, float(shot.frames.time(frame)))
        vectors.append(sun.direction(bearing, height) * sun.direct(height))
    _set_value(group, "Sun", vectors[0])
    for axis in range(3):
        if count > 1:
            path = f'nodes["Sun"].inputs[{axis}].default_value'
            compat.animate(group, path, 0, frames, [vector[axis] for vector in vectors])


def _set_value(group: bpy.types.NodeTree, name: str, values: Any) -> None:
    for socket, value in zip(group.nodes[name].inputs, values, strict=True):
        socket.default_value = float(value)
