"""Light builder: sun, moon, sky, haze and exposure for the shot's location, date and time."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...blender import compat, nodes, owned
from ...blender.owned import Stage
from ...passes import masks
from ...shot.light import exposure, smoke_haze
from ...shot.light.sky import DAY_SKY, State, state
from ...shot.shot import Shot
from .. import curved_air, haze, infrared, space_sky
from . import night_sky
from .keyframes import add_keyframes

_KEYS = 25  # number of keyframes of the sky
_SKY = 0.12  # strength of the sky texture; more hides the sunlit side of smoke
_DUST = 0.3  # parameter of the sky texture; 1 makes it pale and greenish
# Factor on the sky's mean radiance for ambient light in open places; leaves in shade are then 3 stops darker
# than in sunlight; by eye
_FILL = 1.2
_NEAR = 6.0  # m, distance of ambient occlusion
_NIGHT_FILL = 0.018  # minimum of that mean radiance; by eye
_TRANSFORM, _LOOK = "AgX", "AgX - Medium High Contrast"
_INSTEAD = ("Filmic", "Standard")  # fallback view transforms if AgX is missing, best first


def build(shot: Shot, stage: Stage) -> list[str]:
    """Build the lamp "Firetwin Sun" and haze; in Firetwin's scene also world, colour management and exposure.

    All have keyframes over the shot. A user's world is not replaced.

    Returns
    -------
    list of str
        Warnings for the user.
    """
    frames, states = light_keyframes(shot)
    if stage.is_own and stage.scene.world is not None and owned.is_ours(stage.scene.world):
        stage.scene.world = None  # so that it is removed with Firetwin's other objects
    _build_sun(stage.part("Light"), frames, states)
    low = smoke_haze.near_ground(shot.settings.light, smoke_haze.ground_height(shot.run))
    group = haze.set_amount(stage, shot.settings.light.haze, low)
    for path, name in ((haze.COLOUR, "haze"), (haze.HORIZON, "horizon")):
        colours = np.array([(*getattr(each, name), 1.0) for each in states])
        add_keyframes(group, path, frames, colours)
    if not stage.is_own:
        return []
    if stage.scene.world is None:
        _build_world(shot, stage, frames, states)
    _set_thermal_sky(stage.scene.world, infrared.sky_radiance(shot))
    _animate_exposure(stage.scene, frames, exposure.at(shot, frames))
    return _set_view_transform(stage.scene.view_settings)


def light_keyframes(shot: Shot) -> tuple[NDArray[np.float64], list[State]]:
    """Return keyframes of light: frames, and the state of the light at each."""
    moving = shot.frames.count > 1 and shot.frames.last > shot.frames.first
    frames = np.linspace(1.0, shot.frames.count, _KEYS if moving else 1)
    return frames, [state(shot, shot.frames.time(frame)) for frame in frames]


def _build_sun(collection: bpy.types.Collection, frames: NDArray[np.float64], states: list[State]) -> None:
    lamp = bpy.data.lights.new("Firetwin Sun", "SUN")
    obj = owned.add(collection, "Sun", lamp)
    obj.lightgroup = nodes.SUN
    obj.rotation_mode = "QUATERNION"
    add_keyframes(obj, "rotation_quaternion", frames, np.array([_lamp_rotation(s.direction) for s in states]))
    add_keyframes(lamp, "energy", frames, np.array([s.power for s in states]))
    add_keyframes(lamp, "angle", frames, np.radians([s.width for s in states]))
    add_keyframes(lamp, "color", frames, np.array([s.colour for s in states]))


def _lamp_rotation(direction: NDArray[np.float64]) -> tuple[float, ...]:
    """Return the quaternion of a lamp whose light comes from `direction`."""
    return tuple(Vector((-direction).tolist()).to_track_quat("-Z", "Y"))


def animate_sun(tree: bpy.types.NodeTree, frames: NDArray[np.float64], states: list[State]) -> None:
    """Keyframe the direction to the sun in a tree whose node `space_sky.SUN` stores it."""
    height, bearing = np.array([each.sky for each in states]).T
    level = np.cos(height)
    toward = np.sin(bearing) * level, np.cos(bearing) * level, np.sin(height)
    for axis, values in enumerate(toward):
        add_keyframes(tree, f'nodes["{space_sky.SUN}"].inputs[{axis}].default_value', frames, values)


def _build_world(shot: Shot, stage: Stage, frames: NDArray[np.float64], states: list[State]) -> None:
    """Build the world: sky texture and night sky; a uniform cold sky in thermal view layers."""
    world = stage.scene.world = owned.mark(bpy.data.worlds.new("Firetwin Sky"))
    tree = nodes.Tree(compat.node_tree(world))
    sky = tree.node("ShaderNodeTexSky")
    sky.name = "Sky"
    light = tree.vector("SCALE", sky, name=0)
    compat.find_socket(light.socket.node.inputs, "Scale").default_value = _SKY
    up = tree.separate(tree.output("ShaderNodeTexCoord", name="Generated"))[2]
    night = any(state.sky[0] < 0.0 for state in states)
    dark, stars = night_sky.radiance(tree, shot, frames, states) if night else (tuple(DAY_SKY), None)
    light = tree.vector("ADD", light, dark)
    light = haze.before_sky(tree, stage, light, up, smoke_haze.smoke_depth(shot.settings.light))
    earth = curved_air.earth(stage)
    if earth is not None:
        light = space_sky.attenuate_sky(tree, earth, light, haze.airlight(tree, stage), stars)
    background = tree.output("ShaderNodeBackground", {"Color": light, "Strength": 1.0})
    cold = tree.output("ShaderNodeBackground", {"Color": (1.0, 1.0, 1.0), "Strength": 0.0})
    cold.socket.node.name = "Thermal Sky"
    shader = nodes.switch(tree, nodes.THERMAL, background, cold)
    none = tree.output("ShaderNodeBackground", {"Color": (0.0, 1.0, float(masks.SKY)), "Strength": 1.0})
    tree.surface(nodes.switch(tree, nodes.MASKS, shader, none))
    _animate_ambient_light(world, frames, states)
    compat.set_sky(sky, states[0].sky[0], states[0].sky[1], _DUST)
    if earth is not None:
        animate_sun(world.node_tree, frames, states)
    place = f'nodes["{sky.name}"]'
    add_keyframes(world.node_tree, f"{place}.sun_elevation", frames, np.array([s.sky[0] for s in states]))
    add_keyframes(world.node_tree, f"{place}.sun_rotation", frames, np.unwrap([s.sky[1] for s in states]))


def _animate_ambient_light(world: bpy.types.World, frames: NDArray[np.float64], states: list[State]) -> None:
    """Keyframe ambient light between trees, which stands for light that crowns and ground reflect.

    Cycles adds it as ambient occlusion ("Fast GI"), in proportion to the sky's radiance, with a minimum at
    night.
    """
    world.light_settings.distance = _NEAR
    add_keyframes(
        world,
        "light_settings.ao_factor",
        frames,
        _FILL * np.array([max(s.sky_mean, _NIGHT_FILL) for s in states]),
    )


def _set_thermal_sky(world: bpy.types.World, radiance: float) -> None:
    """Set the sky's infrared emission in thermal view layers; a user's world is not changed."""
    node = world.node_tree.nodes.get("Thermal Sky") if world.node_tree and owned.is_ours(world) else None
    if node is not None:
        compat.find_socket(node.inputs, "Strength").default_value = radiance


def _animate_exposure(
    scene: bpy.types.Scene, frames: NDArray[np.float64], exposures: NDArray[np.float64]
) -> None:
    """Keyframe the exposure; in a scene that the artist animates, set it to the value at mid-shot."""
    action = scene.animation_data.action if scene.animation_data else None
    if action is not None and not owned.is_ours(action):
        frames, exposures = frames[:1], exposures[len(exposures) // 2 :][:1]
    add_keyframes(scene, "view_settings.exposure", frames, exposures)


def _set_view_transform(view: bpy.types.ColorManagedViewSettings) -> list[str]:
    """Set the view transform; return a warning if this Blender does not have it."""
    chosen = next(
        (name for name in (_TRANSFORM, *_INSTEAD) if _set_choice(view, "view_transform", name)), None
    )
    if chosen == _TRANSFORM and _set_choice(view, "look", _LOOK):
        return []
    _set_choice(view, "look", "None")
    instead = view.view_transform if chosen is None else chosen
    missing = _LOOK if chosen == _TRANSFORM else _TRANSFORM
    return [f'this Blender has no "{missing}": pictures use "{instead}" and look different']


def _set_choice(obj: bpy.types.bpy_struct, name: str, choice: str) -> bool:
    """Set a property to one of its choices; return False if that choice is missing."""
    try:
        setattr(obj, name, choice)
    except TypeError:
        return False
    return True
