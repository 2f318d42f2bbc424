"""Sun, moon, sky, haze and exposure for the shot's place, date and time.

The values of light are a picture's: a sun of 9 W/m2 at 38 degrees goes with exposure 0.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core.run import Run
from mathutils import Vector
from numpy.typing import NDArray

from .. import compat, nodes
from ..project import Project
from . import clock, collections, haze, noise, sun

_KEYS = 25  # the sky changes at this many moments of the shot
_SKY = 0.12  # strength of the sky texture; more drowns the sunlit side of smoke
_DUST = 0.3  # of the sky texture; 1 makes it pale and greenish
_NIGHT_SKY = np.array([0.010, 0.016, 0.035]) * 0.15
THERMAL_SKY = 250.0  # K, a clear sky in the long-wave infrared


def build(project: Project, run: Run, scene: bpy.types.Scene) -> bpy.types.Object:
    """Build the lamp "Firetwin Sun" and the world "Firetwin Sky", both animated over the shot."""
    first, last = clock.window(project, run)
    moving = project.time.frames > 1 and last > first
    frames = np.linspace(1.0, project.time.frames, _KEYS if moving else 1)
    states = [State(project, *sun.at(run, clock.model_time(project, run, frame))) for frame in frames]
    collection = collections.fresh("Light", scene=scene)
    lamp = bpy.data.lights.new("Firetwin Sun", "SUN")
    lamp.angle = np.radians(0.53)
    thing = collections.add(collection, "Sun", lamp)
    thing.rotation_mode = "QUATERNION"
    sky = _world(scene)
    _key(thing, "rotation_quaternion", frames, np.array([s.rotation for s in states]))
    _key(lamp, "energy", frames, np.array([s.power for s in states]))
    _key(lamp, "color", frames, np.array([s.colour for s in states]))
    tree = scene.world.node_tree
    place = f'nodes["{sky.name}"]'
    compat.set_sky(sky, states[0].sky[0], states[0].sky[1], _DUST)
    _key(tree, f"{place}.sun_elevation", frames, np.array([s.sky[0] for s in states]))
    _key(tree, f"{place}.sun_rotation", frames, np.unwrap([s.sky[1] for s in states]))
    middle = State(project, *sun.at(run, 0.5 * (first + last)))
    haze.settings(project.light.haze, middle.haze)
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.look = "AgX - Medium High Contrast"
    _key(scene, "view_settings.exposure", frames, np.array([s.exposure for s in states]))
    return thing


def _facing(direction: NDArray[np.float64]) -> tuple[float, ...]:
    """Quaternion of a lamp whose light comes from `direction`."""
    return tuple(Vector((-direction).tolist()).to_track_quat("-Z", "Y"))


def _world(scene: bpy.types.Scene) -> bpy.types.ShaderNodeTexSky:
    """Make the world: sky texture and a little night sky; constant and cold in thermal view layers."""
    old = bpy.data.worlds.get("Firetwin Sky")
    if old is not None:
        collections.discard(old)
    world = scene.world = bpy.data.worlds.new("Firetwin Sky")
    tree = nodes.Tree(compat.node_tree(world))
    sky = tree.node("ShaderNodeTexSky")
    sky.name = "Sky"
    light = tree.vector("SCALE", sky, name=0)
    compat.find_socket(light.socket.node.inputs, "Scale").default_value = _SKY
    light = tree.vector("ADD", light, tuple(_NIGHT_SKY))
    seen = tree.output("ShaderNodeBackground", {"Color": light, "Strength": 1.0})
    cold = tree.output("ShaderNodeBackground", {"Color": (1.0, 1.0, 1.0), "Strength": THERMAL_SKY})
    tree.surface(tree.mix_shader(tree.attribute(nodes.THERMAL, "VIEW_LAYER"), seen, cold))
    return sky


def _key(thing: bpy.types.ID, data_path: str, frames: NDArray[np.float64], values: NDArray) -> None:
    """Animate a property (or set it, where there is one moment): values (n,) or (n, channels)."""
    columns = values.reshape(len(frames), -1)
    owner, _, name = data_path.rpartition(".")
    target = thing.path_resolve(owner) if owner else thing
    setattr(target, name, columns[0] if values.ndim > 1 else float(columns[0, 0]))
    if len(frames) == 1:
        return
    for index in range(columns.shape[1]):
        curve = compat.new_fcurve(thing, data_path, index)
        curve.keyframe_points.add(len(frames))
        for point, frame, value in zip(curve.keyframe_points, frames, columns[:, index], strict=True):
            point.co = (frame, value)
            point.interpolation = "LINEAR"
        curve.update()
